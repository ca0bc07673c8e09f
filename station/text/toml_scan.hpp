#pragma once
#include <string>

namespace turnpoint::text {

/// The source as toml++ 3.3 can safely read it. Its test for white space beyond ASCII has undefined behaviour
/// for most letters (U+00A1 to U+0499, U+2E5E to U+3257, ...), and is asked in two kinds of places. Outside
/// of strings and comments TOML 1.0 has no use for such a character: throws BadInput with its place. After a
/// line-ending backslash of a multi-line string it may stand: it is written as \UXXXXXXXX there, which moves
/// columns to its right. Throws BadInput at a key of more than 16 parts too.
std::string safe_for_parser(const std::string& source, const std::string& path);

}  // namespace turnpoint::text

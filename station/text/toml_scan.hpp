#pragma once
#include <string>

namespace turnpoint::text {

/// Returns the source in a form that toml++ 3.3 can safely read. Its test for non-ASCII white space has
/// undefined behaviour for most letters (U+00A1 to U+0499, U+2E5E to U+3257, ...). It is used in two kinds of
/// places. Outside strings and comments TOML 1.0 does not allow such a character: throws BadInput with its
/// place. After a line-ending backslash in a multi-line string it is allowed: it is replaced by \UXXXXXXXX,
/// which moves columns to its right. Also throws BadInput at a key of more than 16 parts.
std::string safe_for_parser(const std::string& source, const std::string& path);

}  // namespace turnpoint::text

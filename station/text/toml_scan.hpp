#pragma once
#include <string>

namespace turnpoint::text {

/// Returns the source in a form that toml++ 3.3 can safely read. toml++ tests characters for non-ASCII white
/// space, and this test has undefined behaviour for most letters (U+00A1 to U+0499, U+2E5E to U+3257, ...).
/// The test runs in two kinds of places:
/// - Outside strings and comments. TOML 1.0 does not allow non-ASCII characters there, so this function
/// throws BadInput with their place.
/// - After a backslash at the end of a line in a multi-line string. Non-ASCII characters are allowed there,
/// so this function replaces them by \UXXXXXXXX, which shifts the columns of the text after them.
/// Also throws BadInput at a key of more than 16 parts.
std::string safe_for_parser(const std::string& source, const std::string& path);

}  // namespace turnpoint::text

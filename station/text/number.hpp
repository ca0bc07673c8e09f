#pragma once
#include <string>

namespace turnpoint::text {

/// The one place where numbers become text for people: at most `digits` significant digits, no trailing
/// zeros, no exponent between 1e-4 and 1e9; "none" for what is not finite.
std::string number(double value, int digits = 6);

/// The shortest decimal text that reads back as the same double ("n/a" for what is not finite): for files.
std::string exact(double value);

/// Lower-case hexadecimal SHA-256 (FIPS 180-4) of the bytes.
std::string sha256(const std::string& bytes);

}  // namespace turnpoint::text

#pragma once
#include <string>

namespace turnpoint::text {

/// The one place where numbers become text for people: at most `digits` significant digits, no trailing
/// zeros, no exponent between 1e-4 and 1e9; "none" for what is not finite.
std::string number(double value, int digits = 6);

/// An estimate to two digits of its uncertainty (a standard error or deviation, see uncertainty()), so that
/// no digit is printed that it does not have: 3e-16 with an uncertainty of 0.9 is "0.00". To three
/// significant digits where the uncertainty is not above 0 and finite.
std::string estimated(double value, double uncertainty);

/// What an interval around an estimate leaves of it: half the distance to its nearer end, which is about a
/// standard error of a 95 % interval; a quarter of the interval where the estimate stands on an end.
double uncertainty(double value, double low, double high);

/// The shortest decimal text that reads back as the same double ("n/a" for what is not finite): for files.
std::string exact(double value);

/// Lower-case hexadecimal SHA-256 (FIPS 180-4) of the bytes.
std::string sha256(const std::string& bytes);

}  // namespace turnpoint::text

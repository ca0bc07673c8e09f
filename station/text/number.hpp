#pragma once
#include <string>

namespace turnpoint::text {

/// The only place where numbers are formatted for people: at most `digits` significant digits, no trailing
/// zeros, no exponent between 1e-4 and 1e9; "none" if not finite.
std::string number(double value, int digits = 6);

/// Formats an estimate to two digits of its uncertainty (a standard error or deviation, see uncertainty()),
/// so that no meaningless digits are printed: 3e-16 with an uncertainty of 0.9 is "0.00". If the uncertainty
/// is not positive and finite, uses three significant digits.
std::string estimated(double value, double uncertainty);

/// The uncertainty of an estimate according to its interval: half the distance to the nearer end, which is
/// about one standard error for a 95 % interval. If the estimate lies on an end, a quarter of the interval.
double uncertainty(double value, double low, double high);

/// For files: the shortest decimal text that reads back as the same double ("n/a" if not finite).
std::string exact(double value);

/// Lower-case hexadecimal SHA-256 (FIPS 180-4) of the bytes.
std::string sha256(const std::string& bytes);

}  // namespace turnpoint::text

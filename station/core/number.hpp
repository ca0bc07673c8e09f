#pragma once
#include <optional>
#include <string>

namespace turnpoint::core {

/// Formats a number for people. All code uses this function for that. Prints at most `digits` significant
/// digits, no trailing zeros, and no exponent between 1e-4 and 1e9. Returns "none" for infinity and NaN.
std::string number(double value, int digits = 6);

/// Rounds an estimate to two digits of its uncertainty (a standard error or deviation, see uncertainty()) and
/// formats it. For example, 3e-16 with an uncertainty of 0.9 is "0.00". Uses three significant digits if the
/// uncertainty is not a positive finite number.
std::string estimated(double value, double uncertainty);

/// Returns the uncertainty of an estimate from its confidence interval: the distance to the nearer end,
/// halved, which is about one standard error for a 95 % interval. If the estimate lies on an end, returns a
/// quarter of the interval's width.
double uncertainty(double value, double low, double high);

/// Formats a number for files: the shortest decimal text that reads back as the same double; "n/a" for
/// infinity and NaN.
std::string exact(double value);

/// Reads a whole text that exact() wrote; empty if it is not a number.
std::optional<double> read_number(const std::string& text);

/// Returns the SHA-256 (FIPS 180-4) of the bytes in lower-case hexadecimal.
std::string sha256(const std::string& bytes);

}  // namespace turnpoint::core

#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace turnpoint::view {

/// Decides how long a keypad refuses codes after wrong ones. After the first and the second wrong code,
/// another one is accepted at once. The third wrong code starts a wait of 5 s, and each further one doubles
/// the wait, up to 5 min. The right code ends the wait. Trying all ten thousand codes of four digits
/// therefore takes over a month. Pure: the caller passes the time (s, monotonic).
class CodeBackOff {
 public:
  static constexpr int free_tries = 2;
  static constexpr double first_s = 5, longest_s = 300;

  void wrong(double now_s) {
    ++wrong_;
    if (wrong_ <= free_tries) return;
    const double wait_s = std::ldexp(first_s, std::min(wrong_ - free_tries - 1, 10));
    until_s_ = now_s + std::min(wait_s, longest_s);
  }
  void right() { *this = {}; }
  /// Seconds until the next code is accepted; 0 if one is accepted now.
  double wait_s(double now_s) const { return std::max(0.0, until_s_ - now_s); }
  int wrong_tries() const { return wrong_; }

 private:
  int wrong_ = 0;
  double until_s_ = -std::numeric_limits<double>::infinity();
};

/// The code of digits that opens the operator's pages on the participant's screen. A stored code is kept as a
/// salted hash only (yescrypt, by libxcrypt).
class OperatorCode {
 public:
  /// The code of a station on which nobody has stored a code. It is printed in the manual, so it is not
  /// secret.
  static constexpr const char* built_in = "2468";
  static constexpr std::size_t shortest = 4, longest = 12;

  /// Makes the built-in code.
  OperatorCode() = default;
  /// Hashes a new code, which takes some tens of milliseconds. Throws core::UsageError for the built-in
  /// code, and for a code that does not have 4 to 12 digits.
  static OperatorCode of_digits(const std::string& digits);
  /// Takes the hash of a stored code. Throws core::UsageError for a text that cannot be a hash.
  static OperatorCode of_hash(const std::string& hash);

  bool is_built_in() const { return hash_.empty(); }
  const std::string& hash() const { return hash_; }  ///< hash of a stored code; "" for the built-in code
  /// True for the right code. The check takes equally long for every text. Thread-safe.
  bool opens(const std::string& typed) const;

 private:
  std::string hash_;
};

/// Returns the files that may contain a code; the first one that exists is used. They are in the user's
/// configuration folder ($XDG_CONFIG_HOME or ~/.config; not for root) and in /etc/turnpoint. A new code is
/// stored in the first file of the list.
std::vector<std::string> operator_code_files();

/// Returns the current code: from the first of these files that exists, otherwise the built-in code. Throws
/// core::BadInput for a file that contains no code, or that everybody may read. Throws std::system_error for
/// a file that cannot be read.
OperatorCode operator_code(const std::vector<std::string>& files = operator_code_files());

/// Stores a code so that only the file's owner can read it. In /etc/turnpoint, the group of the station's
/// user can read it too. Throws std::system_error.
void store_operator_code(const OperatorCode& code, const std::string& file);

}  // namespace turnpoint::view

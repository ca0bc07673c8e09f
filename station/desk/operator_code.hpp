#pragma once
#include <string>
#include <vector>

namespace turnpoint::desk {

/// The digits that unlock the operator's pages on the participant's screen. Only a salted hash of a stored
/// code is kept (yescrypt, by libxcrypt).
class OperatorCode {
 public:
  /// The code of a station on which nobody has stored another one. It is public, because it is in the manual.
  static constexpr const char* built_in = "2468";
  static constexpr std::size_t shortest = 4, longest = 12;

  /// The built-in code.
  OperatorCode() = default;
  /// Hashes a new code; takes some tens of milliseconds. Throws terms::UsageError for the built-in code, and
  /// for one that does not have 4 to 12 digits.
  static OperatorCode of_digits(const std::string& digits);
  /// A stored code. Throws terms::UsageError for a text that cannot be a hash.
  static OperatorCode of_hash(const std::string& hash);

  bool is_built_in() const { return hash_.empty(); }
  const std::string& hash() const { return hash_; }  ///< "" for the built-in code
  /// True for the right code. Takes equally long for every text. Thread-safe.
  bool opens(const std::string& typed) const;

 private:
  std::string hash_;
};

/// The files that may contain a code, in order of precedence: in the user's configuration folder
/// ($XDG_CONFIG_HOME, else ~/.config, none for root) and in /etc/turnpoint. A new code is stored in the first
/// one.
std::vector<std::string> operator_code_files();

/// The current code: that of the first of these files that exists, or the built-in one. Throws text::BadInput
/// for a file that contains no code or that everybody may read, and std::system_error for one that cannot be
/// read.
OperatorCode operator_code(const std::vector<std::string>& files = operator_code_files());

/// Stores a code so that only its owner can read it; in /etc/turnpoint also the group of the station's user.
/// Throws std::system_error.
void store_operator_code(const OperatorCode& code, const std::string& file);

}  // namespace turnpoint::desk

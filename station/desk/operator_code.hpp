#pragma once
#include <string>
#include <vector>

namespace turnpoint::desk {

/// The digits that open the operator's pages on the participant's screen. Only a salted hash of a stored code
/// is kept (yescrypt, by libxcrypt).
class OperatorCode {
 public:
  /// Of a station where nobody has stored another. Anybody can read it in the manual.
  static constexpr const char* built_in = "2468";
  static constexpr std::size_t shortest = 4, longest = 12;

  /// The built-in code.
  OperatorCode() = default;
  /// Hashes a new code; takes some tens of milliseconds. Throws terms::UsageError for one that is not of
  /// 4 to 12 digits, or the built-in one.
  static OperatorCode of_digits(const std::string& digits);
  /// A code that was stored. Throws terms::UsageError for a text that no hash can be.
  static OperatorCode of_hash(const std::string& hash);

  bool is_built_in() const { return hash_.empty(); }
  const std::string& hash() const { return hash_; }  ///< "" of the built-in code
  /// True for the code itself; takes as long for every text. Thread-safe.
  bool opens(const std::string& typed) const;

 private:
  std::string hash_;
};

/// Where a code is stored, the first to be looked at first: in the user's configuration folder
/// ($XDG_CONFIG_HOME, else ~/.config, none for root) and in /etc/turnpoint. A new one goes to the first.
std::vector<std::string> operator_code_files();

/// The code in force: of the first of these files that is there, the built-in one where none is. Throws
/// text::BadInput for a file that holds no code or that everybody may read, std::system_error for one that
/// cannot be read.
OperatorCode operator_code(const std::vector<std::string>& files = operator_code_files());

/// Stores a code, readable by its owner alone, in /etc/turnpoint also by the group of the station's user.
/// Throws std::system_error.
void store_operator_code(const OperatorCode& code, const std::string& file);

}  // namespace turnpoint::desk

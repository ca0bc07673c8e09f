#include "station/view/operator_code.hpp"

#include <crypt.h>
#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <system_error>

#include "station/core/problem.hpp"
#include "station/core/usage_error.hpp"
#include "station/system/write_file.hpp"

namespace turnpoint::view {

namespace fs = std::filesystem;

namespace {

constexpr const char* kStationFolder = "/etc/turnpoint";
/// The user and the group as which the station's service runs.
constexpr const char* kStationGroup = "turnpoint";

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

/// Compares two texts. The time that this takes does not reveal where they differ.
bool equal(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned different = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    different |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return different == 0;
}

std::string crypted(const std::string& text, const std::string& setting) {
  const auto data = std::make_unique<crypt_data>();
  const char* hash = ::crypt_r(text.c_str(), setting.c_str(), data.get());
  if (hash == nullptr || hash[0] == '*') fail("hashing the operator's code");
  return hash;
}

/// True for a complete hash. False for a text that contains only the method and the salt.
bool is_hash(const std::string& text) {
  const auto data = std::make_unique<crypt_data>();
  const char* again = ::crypt_r("", text.c_str(), data.get());
  return again != nullptr && again[0] != '*' && std::string(again).size() == text.size();
}

core::BadInput bad_file(const std::string& file, const std::string& what) {
  return core::BadInput(
      {{{file, 1, 1}, core::plain(what), core::plain("store a code with `turnpoint operator-code`")}});
}

}  // namespace

OperatorCode OperatorCode::of_digits(const std::string& digits) {
  const bool only_digits = digits.find_first_not_of("0123456789") == std::string::npos;
  if (!only_digits || digits.size() < shortest || digits.size() > longest)
    throw core::UsageError("an operator's code must have " + std::to_string(shortest) + " to " +
                           std::to_string(longest) + " digits, because the keypad has only digits");
  if (digits == built_in) throw core::UsageError("2468 is the built-in code; choose another code");
  char setting[CRYPT_GENSALT_OUTPUT_SIZE];
  if (::crypt_gensalt_rn("$y$", 0, nullptr, 0, setting, sizeof setting) == nullptr)
    fail("salt for the operator's code");
  OperatorCode code;
  code.hash_ = crypted(digits, setting);
  return code;
}

OperatorCode OperatorCode::of_hash(const std::string& hash) {
  if (!is_hash(hash)) throw core::UsageError("this file does not contain an operator's code");
  OperatorCode code;
  code.hash_ = hash;
  return code;
}

bool OperatorCode::opens(const std::string& typed) const {
  return is_built_in() ? equal(typed, built_in) : equal(crypted(typed, hash_), hash_);
}

std::vector<std::string> operator_code_files() {
  std::vector<std::string> files;
  const char* config = std::getenv("XDG_CONFIG_HOME");
  const char* home = std::getenv("HOME");
  if (config != nullptr && *config != '\0')
    files.push_back(fs::path(config) / "turnpoint/operator-code");
  else if (::geteuid() != 0 && home != nullptr)
    files.push_back(fs::path(home) / ".config/turnpoint/operator-code");
  files.push_back(fs::path(kStationFolder) / "operator-code");
  return files;
}

OperatorCode operator_code(const std::vector<std::string>& files) {
  for (const auto& file : files) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) {
      if (errno == ENOENT || errno == ENOTDIR) continue;
      fail("operator's code in " + file);
    }
    if ((status.st_mode & 0007) != 0)
      throw bad_file(file, "every user of this computer may read this operator's code");
    std::ifstream in(file);
    std::string hash;
    if (!in || !std::getline(in, hash))
      throw std::system_error(in.is_open() ? EIO : EACCES, std::generic_category(),
                              "operator's code in " + file);
    try {
      return OperatorCode::of_hash(hash);
    } catch (const core::UsageError& error) {
      throw bad_file(file, error.what());
    }
  }
  return {};
}

void store_operator_code(const OperatorCode& code, const std::string& file) {
  system::make_folder(fs::path(file).parent_path().string());
  system::write_file(file, code.hash() + "\n", 0600);
  if (fs::path(file).parent_path() != kStationFolder) return;
  const auto* group = ::getgrnam(kStationGroup);
  if (group == nullptr) return;
  if (::chown(file.c_str(), 0, group->gr_gid) != 0 || ::chmod(file.c_str(), 0640) != 0)
    fail("permissions of " + file);
}

}  // namespace turnpoint::view

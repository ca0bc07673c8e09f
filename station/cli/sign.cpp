#include "station/cli/sign.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "station/store/export_files.hpp"
#include "station/store/files.hpp"

namespace turnpoint::cli {

namespace {

/// Runs a program without a shell on this terminal. Returns its exit status.
int run_program(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t process = -1;
  if (const int error = ::posix_spawnp(&process, arguments[0], nullptr, nullptr, arguments.data(), environ))
    throw std::system_error(error, std::generic_category(),
                            "cannot start " + words[0] + " (Debian package openssh-client)");
  int status = 0;
  while (::waitpid(process, &status, 0) < 0)
    if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "waiting for " + words[0]);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

std::vector<std::string> sign_files(const std::string& folder, const std::vector<std::string>& files,
                                    const std::string& key) {
  std::string sums;
  for (const auto& file : files)
    sums += store::sha256_of_file(file) + "  " + std::filesystem::relative(file, folder).string() + "\n";
  const auto list = (std::filesystem::path(folder) / "SHA256SUMS").string();
  const auto signature = list + ".sig";
  store::write_file(list, sums);
  // Remove an existing signature, because ssh-keygen would ask whether to overwrite it.
  std::filesystem::remove(signature);
  if (const int status = run_program({"ssh-keygen", "-q", "-Y", "sign", "-n", "turnpoint", "-f", key, list}))
    throw std::runtime_error(
        fmt::format("export: ssh-keygen did not sign {} with {} (exit status {}); the exported files are "
                    "complete, but unsigned",
                    list, key, status));
  return {list, signature};
}

}  // namespace turnpoint::cli

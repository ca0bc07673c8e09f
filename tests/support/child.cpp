#include "tests/support/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <system_error>
#include <utility>

namespace {

[[noreturn]] void fail(const std::string& what, int error) {
  throw std::system_error(error, std::generic_category(), what);
}

int ms_since(std::chrono::steady_clock::time_point start) {
  return static_cast<int>(
      std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - start)
          .count());
}

bool ready(int descriptor, int patience_ms) {
  pollfd wanted{descriptor, POLLIN, 0};
  return ::poll(&wanted, 1, patience_ms) > 0;
}

std::vector<char*> pointers(const std::vector<std::string>& texts) {
  std::vector<char*> list;
  for (const auto& text : texts) list.push_back(const_cast<char*>(text.c_str()));
  list.push_back(nullptr);
  return list;
}

}  // namespace

Child::Child(const std::vector<std::string>& command, const std::vector<std::string>& environment) {
  auto variables = environment;
  for (char** variable = environ; *variable != nullptr; ++variable) variables.emplace_back(*variable);
  int pipe[2];
  if (::pipe2(pipe, O_CLOEXEC) != 0) fail("pipe", errno);
  int typed[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, typed) != 0) fail("socketpair", errno);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, typed[1], STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, pipe[1], STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, pipe[1], STDERR_FILENO);
  const int error = ::posix_spawn(&process_, command[0].c_str(), &actions, nullptr, pointers(command).data(),
                                  pointers(variables).data());
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(pipe[1]);
  ::close(typed[1]);
  output_ = pipe[0];
  input_ = typed[0];
  if (error != 0) fail(command[0], error);
  descriptor_ = static_cast<int>(::syscall(SYS_pidfd_open, process_, 0));
  if (descriptor_ < 0) fail("pidfd_open", errno);
}

Child::~Child() {
  if (!ended_) {
    signal(SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  ::close(descriptor_);
  ::close(input_);
  stop_listening();
}

void Child::signal(int number) const { ::kill(process_, number); }

void Child::type(const std::string& line) const {
  const auto text = line + "\n";
  if (::send(input_, text.data(), text.size(), MSG_NOSIGNAL) < 0) fail("typing", errno);
}

void Child::stop_listening() {
  if (output_ >= 0) ::close(std::exchange(output_, -1));
}

/// Reads one piece of the child's output. Returns false at the end of the output, or after this time.
bool Child::listen(int patience_ms) {
  if (output_ < 0) return false;
  char text[4096];
  if (!ready(output_, patience_ms)) return false;
  const auto length = ::read(output_, text, sizeof text);
  if (length > 0) said_.append(text, static_cast<std::size_t>(length));
  return length > 0;
}

bool Child::says(const std::string& text, int patience_ms) {
  while (said_.find(text) == std::string::npos)
    if (!listen(patience_ms)) return false;
  return true;
}

bool Child::ends_within(int patience_ms) {
  const auto start = std::chrono::steady_clock::now();
  // Keep reading the output, because a child whose pipe is full would wait for ever.
  while (listen(std::max(0, patience_ms - ms_since(start))))
    if (ms_since(start) > patience_ms) return false;
  if (!ready(descriptor_, std::max(0, patience_ms - ms_since(start)))) return false;
  int status = 0;
  ::waitpid(process_, &status, 0);
  ended_ = true;
  outcome_ = WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
  return true;
}

bool Child::handles(int number) const {
  std::ifstream status("/proc/" + std::to_string(process_) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("SigCgt:", 0) == 0)
      return (std::stoull(line.substr(7), nullptr, 16) >> (number - 1) & 1) != 0;
  return false;
}

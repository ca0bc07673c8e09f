#include "station/system/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <vector>

#include "station/system/clocks.hpp"

namespace turnpoint::system {

namespace {

constexpr std::int64_t kPatience_ns = 100'000'000, kLook_ns = 2'000'000;
constexpr std::size_t kMostUnread = 1 << 20;  // bytes of either stream that are kept until they are used
constexpr std::size_t kComplaint = 4096;      // bytes of standard error that are kept
constexpr int kNiceness = 5;

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

struct Pipe {
  core::FileDescriptor read, write;
};

Pipe new_pipe(const std::string& file) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) fail(file + ": cannot make a pipe");
  return {core::FileDescriptor(ends[0]), core::FileDescriptor(ends[1])};
}

void never_wait(const core::FileDescriptor& end) { ::fcntl(end.get(), F_SETFL, O_NONBLOCK); }

/// Everything that the new process needs, prepared before it exists: it shares our memory until it runs the
/// program, so it must not allocate.
struct Plan {
  const char* file;
  const char* folder;
  char* const* arguments;
  char* const* environment;
  int in, out, errors;
  pid_t parent;
};

/// Gives up rights that the program does not need. A right that cannot be given up was not there.
void give_up_rights() {
  sched_param ordinary{};
  ::sched_setscheduler(0, SCHED_OTHER, &ordinary);
  ::setpriority(PRIO_PROCESS, 0, kNiceness);
  const rlimit none{0, 0};
  for (const auto limit : {RLIMIT_RTPRIO, RLIMIT_MEMLOCK, RLIMIT_CORE}) ::setrlimit(limit, &none);
  ::prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0);
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  if (const int memory = ::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC); memory >= 0) {
    static_cast<void>(!::write(memory, "1000", 4));
    ::close(memory);
  }
}

/// Turns the new process into the program. Returns only if that fails.
void become(const Plan& plan) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != plan.parent) return;  // the parent died before the line above
  ::setpgid(0, 0);
  ::dup2(plan.in, STDIN_FILENO), ::dup2(plan.out, STDOUT_FILENO), ::dup2(plan.errors, STDERR_FILENO);
  // All our files are closed on exec anyway; this closes those that a library forgot.
  ::syscall(SYS_close_range, STDERR_FILENO + 1, ~0U, 0);
  give_up_rights();
  if (::chdir(plan.folder) != 0) return;
  struct sigaction standard {};
  standard.sa_handler = SIG_DFL;
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGINT, SIGTERM, SIGHUP})
    ::sigaction(signal, &standard, nullptr);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::execve(plan.file, plan.arguments, plan.environment);
}

/// Starts the process and sets `error` if the program could not be run. vfork() rather than fork(): copying
/// the page tables of a session with locked memory would hold up its audio thread.
[[gnu::noinline]] pid_t start(const Plan& plan, volatile int& error) {
  const pid_t id = ::vfork();
  if (id == 0) {
    become(plan);
    error = errno;
    ::_exit(127);
  }
  return id;
}

std::vector<std::string> sparse_environment() {
  const auto variable = [](const char* name, const char* otherwise) {
    const char* value = std::getenv(name);
    return std::string(name) + "=" + (value != nullptr ? value : otherwise);
  };
  // Without the last two, a Python program would keep its lines in a buffer, and write beside its file.
  return {variable("PATH", "/usr/local/bin:/usr/bin:/bin"), variable("HOME", "/"), "LANG=C.UTF-8",
          "PYTHONUNBUFFERED=1", "PYTHONDONTWRITEBYTECODE=1"};
}

/// Appends what can be read at once, up to a limit. Closes the descriptor at the end of the file.
void read_into(core::FileDescriptor& from, std::string& text) {
  std::array<char, 4096> buffer{};
  while (from.is_open() && text.size() < kMostUnread) {
    const auto n = ::read(from.get(), buffer.data(), buffer.size());
    if (n > 0) {
      text.append(buffer.data(), static_cast<std::size_t>(n));
      if (n < static_cast<ssize_t>(buffer.size())) return;
    } else if (n < 0 && (errno == EAGAIN || errno == EINTR)) {
      return;
    } else {
      from = core::FileDescriptor();
    }
  }
}

/// While this object exists, SIGPIPE does not reach this thread. A pending one is dropped at the end.
class NoPipeSignal {
 public:
  NoPipeSignal() {
    ::sigemptyset(&pipe_);
    ::sigaddset(&pipe_, SIGPIPE);
    ::pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  NoPipeSignal(const NoPipeSignal&) = delete;
  NoPipeSignal& operator=(const NoPipeSignal&) = delete;
  ~NoPipeSignal() {
    const timespec at_once{};
    if (::sigismember(&before_, SIGPIPE) == 0) ::sigtimedwait(&pipe_, nullptr, &at_once);
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

 private:
  sigset_t pipe_{}, before_{};
};

}  // namespace

ChildProcess::ChildProcess(const std::string& file) {
  auto in = new_pipe(file), out = new_pipe(file), errors = new_pipe(file);
  // The program begins in its own folder, so its path must not depend on ours.
  auto path = std::filesystem::absolute(file).string();
  const auto folder = std::filesystem::path(path).parent_path().string();
  auto variables = sparse_environment();
  std::vector<char*> environment;
  for (auto& variable : variables) environment.push_back(variable.data());
  environment.push_back(nullptr);
  const std::array<char*, 2> arguments{path.data(), nullptr};
  const Plan plan{path.c_str(),  folder.c_str(),  arguments.data(),   environment.data(),
                  in.read.get(), out.write.get(), errors.write.get(), ::getpid()};
  // A handler of ours must not run in the new process, which shares our memory.
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  volatile int error = 0;
  id_ = start(plan, error);
  if (id_ < 0) error = errno;
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (error != 0) {
    if (id_ > 0) ::waitpid(id_, nullptr, 0);
    errno = error;
    fail(file + ": cannot start this program");
  }
  to_ = std::move(in.write), from_ = std::move(out.read), errors_ = std::move(errors.read);
  for (const auto* end : {&to_, &from_, &errors_}) never_wait(*end);
}

ChildProcess::~ChildProcess() {
  to_ = core::FileDescriptor(), from_ = core::FileDescriptor(), errors_ = core::FileDescriptor();
  if (!ends_within(kPatience_ns)) {
    ::kill(-id_, SIGTERM);
    static_cast<void>(ends_within(kPatience_ns));
  }
  if (reaped_) return;
  // Also ends programs that this one has started and left behind.
  ::kill(-id_, SIGKILL), ::kill(id_, SIGKILL);
  while (::waitpid(id_, &status_, 0) < 0 && errno == EINTR) {
  }
}

void ChildProcess::send(std::string_view line) {
  waiting_.append(line).push_back('\n');
  write_waiting();
}

std::optional<std::string> ChildProcess::line() {
  exchange();
  const auto end = out_.find('\n');
  if (end == std::string::npos) return std::nullopt;
  auto line = out_.substr(0, end);
  out_.erase(0, end + 1);
  return line;
}

void ChildProcess::wait(std::int64_t until_ns) {
  const auto left_ms = (until_ns - monotonic_ns() + 999'999) / 1'000'000;
  std::array<pollfd, 3> events{pollfd{from_.get(), POLLIN, 0}, pollfd{errors_.get(), POLLIN, 0},
                               pollfd{waiting_.empty() ? -1 : to_.get(), POLLOUT, 0}};
  ::poll(events.data(), events.size(), static_cast<int>(std::clamp<std::int64_t>(left_ms, 0, 60'000)));
  exchange();
}

void ChildProcess::exchange() {
  write_waiting();
  read_into(from_, out_);
  read_into(errors_, said_);
  if (said_.size() > kComplaint) said_.erase(0, said_.size() - kComplaint);
}

void ChildProcess::write_waiting() {
  const NoPipeSignal no_signal;
  while (!waiting_.empty() && to_.is_open()) {
    const auto n = ::write(to_.get(), waiting_.data(), waiting_.size());
    if (n >= 0)
      waiting_.erase(0, static_cast<std::size_t>(n));
    else if (errno == EAGAIN || errno == EINTR)
      return;
    else
      to_ = core::FileDescriptor();  // the program has closed its standard input; line() will tell why
  }
}

bool ChildProcess::ended() {
  if (reaped_) return true;
  // Leave the dead process as it is until its descendants are gone, so that its number stays taken.
  siginfo_t info{};
  if (::waitid(P_PID, static_cast<id_t>(id_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid == 0)
    return false;
  ::kill(-id_, SIGKILL);
  reaped_ = ::waitpid(id_, &status_, 0) == id_;
  return reaped_;
}

bool ChildProcess::ends_within(std::int64_t ns) {
  const auto until_ns = monotonic_ns() + ns;
  while (!ended()) {
    if (monotonic_ns() >= until_ns) return false;
    sleep_until_ns(monotonic_ns() + kLook_ns);
  }
  return true;
}

std::string ChildProcess::how_it_ended() {
  if (!ends_within(kPatience_ns)) return "closed its standard output";
  return WIFSIGNALED(status_) ? "was killed by signal " + std::to_string(WTERMSIG(status_))
                              : "ended with status " + std::to_string(WEXITSTATUS(status_));
}

std::string ChildProcess::complaint() const {
  const auto last = said_.find_last_not_of(" \t\r\n");
  if (last == std::string::npos) return "";
  const auto before = said_.find_last_of('\n', last);
  const auto first = before == std::string::npos ? 0 : before + 1;
  return said_.substr(first, last + 1 - first);
}

}  // namespace turnpoint::system

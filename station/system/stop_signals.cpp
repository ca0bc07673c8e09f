#include "station/system/stop_signals.hpp"

#include <poll.h>
#include <string.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <system_error>
#include <utility>

namespace turnpoint::system {
namespace {

constexpr int kSignals[] = {SIGTERM, SIGINT, SIGHUP};

/// Global variables, because a signal handler cannot be given an argument.
std::atomic<int> wake_descriptor = -1;
std::atomic<int> first_signal = 0;
static_assert(std::atomic<int>::is_always_lock_free);

void wake(int descriptor) {
  const std::uint64_t one = 1;
  // The write fails only if the counter is full; then the waiting thread has been woken already.
  [[maybe_unused]] const auto written = ::write(descriptor, &one, sizeof one);
}

void tell(int signal) {
  const int interrupted = errno;
  int none = 0;
  first_signal.compare_exchange_strong(none, signal);
  wake(wake_descriptor);
  errno = interrupted;
}

int made_eventfd() {
  const int descriptor = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (descriptor < 0)
    throw std::system_error(errno, std::generic_category(), "stop signals: cannot make an eventfd");
  return descriptor;
}

}  // namespace

StopSignals::StopSignals() : wake_(made_eventfd()) {}

StopSignals::~StopSignals() {
  for (const auto& before : before_) ::sigaction(before.signal, &before.action, nullptr);
  wake_descriptor = -1;
  first_signal = 0;
}

void StopSignals::take_over() {
  if (!before_.empty()) return;
  wake_descriptor = wake_.get();
  for (const int signal : kSignals) {
    Before before{signal, {}};
    ::sigaction(signal, nullptr, &before.action);
    if (before.action.sa_handler == SIG_IGN) continue;
    struct sigaction ours {};
    ours.sa_handler = tell;
    // With these flags, a second signal has its default action, and interrupted system calls are restarted.
    ours.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
    ::sigemptyset(&ours.sa_mask);
    ::sigaction(signal, &ours, nullptr);
    before_.push_back(before);
  }
}

std::string StopSignals::wait() const {
  pollfd woken{wake_.get(), POLLIN, 0};
  while (::poll(&woken, 1, -1) < 0 && errno == EINTR) {
  }
  return told();
}

std::string StopSignals::told() {
  const int first = first_signal;
  return first == 0 ? "" : std::string("SIG") + ::sigabbrev_np(first);
}

int StopSignals::exit_status() {
  const int first = first_signal;
  return first == 0 ? 0 : 128 + first;
}

void StopSignals::release() { wake(wake_.get()); }

OnStopSignal::OnStopSignal(std::function<void(const std::string& signal)> act) {
  signals_.take_over();
  waiter_ = std::jthread([this, act = std::move(act)] {
    if (const auto signal = signals_.wait(); !signal.empty()) act(signal);
  });
}

}  // namespace turnpoint::system

#include "station/ui/stop_signals.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <QCoreApplication>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <system_error>

namespace turnpoint::ui {

namespace {

constexpr int kSignals[] = {SIGTERM, SIGINT, SIGHUP};

/// A signal's handler is given nothing else to find the event loop by.
std::atomic<int> wake_descriptor = -1;
static_assert(std::atomic<int>::is_always_lock_free);

void wake(int) {
  const int interrupted = errno;
  const std::uint64_t one = 1;
  // It can fail only where the counter is full: the loop is then woken already.
  [[maybe_unused]] const auto written = ::write(wake_descriptor, &one, sizeof one);
  errno = interrupted;
}

int made_eventfd() {
  const int descriptor = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (descriptor < 0)
    throw std::system_error(errno, std::generic_category(), "stop signals: cannot make an eventfd");
  return descriptor;
}

}  // namespace

StopSignals::StopSignals() : wake_(made_eventfd()), woken_(wake_, QSocketNotifier::Read) {
  // Not quit(): that asks the windows first, and one of them might object.
  connect(&woken_, &QSocketNotifier::activated, this, [this] {
    woken_.setEnabled(false);
    QCoreApplication::exit(0);
  });
}

StopSignals::~StopSignals() {
  for (const auto& before : before_) ::sigaction(before.signal, &before.action, nullptr);
  wake_descriptor = -1;
  woken_.setEnabled(false);
  ::close(wake_);
}

void StopSignals::take_over() {
  if (!before_.empty()) return;
  wake_descriptor = wake_;
  for (const int signal : kSignals) {
    Before before{signal, {}};
    ::sigaction(signal, nullptr, &before.action);
    if (before.action.sa_handler == SIG_IGN) continue;
    struct sigaction ours {};
    ours.sa_handler = wake;
    // A second one finds the kernel's way again. Calls that a signal interrupts go on.
    ours.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
    ::sigemptyset(&ours.sa_mask);
    ::sigaction(signal, &ours, nullptr);
    before_.push_back(before);
  }
}

}  // namespace turnpoint::ui

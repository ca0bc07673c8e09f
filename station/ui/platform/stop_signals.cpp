#include "station/ui/platform/stop_signals.hpp"

#include <unistd.h>

#include <QCoreApplication>
#include <condition_variable>
#include <cstdlib>
#include <mutex>

namespace turnpoint::ui {

StopSignals::StopSignals() : woken_(signals_.descriptor(), QSocketNotifier::Read) {
  // Do not use quit(), because any window could refuse it.
  connect(&woken_, &QSocketNotifier::activated, this, [this] {
    woken_.setEnabled(false);
    QCoreApplication::exit(0);
  });
}

StopSignals::~StopSignals() {
  woken_.setEnabled(false);
  signals_.release();
}

void StopSignals::take_over() {
  signals_.take_over();
  if (!patience_.joinable())
    patience_ = std::jthread([this](const std::stop_token& ended) { end_in_time(ended); });
}

void StopSignals::end_in_time(const std::stop_token& ended) const {
  if (signals_.wait().empty()) return;
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any never;
  never.wait_for(lock, ended, kPatience, [] { return false; });
  if (ended.stop_requested()) return;
  std::string says =
      "turnpoint: the program ends although something holds it up, such as a disk that does not answer";
  if (kept_) says += "; " + kept_();
  says += "\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, says.data(), says.size());
  std::_Exit(EXIT_FAILURE);
}

}  // namespace turnpoint::ui

#include "station/io/device_watch.hpp"

#include <exception>
#include <utility>

#include "station/system/clocks.hpp"
#include "station/system/rights.hpp"

namespace turnpoint::io {

namespace {

constexpr std::int64_t look_again_ns = 100'000'000;

}  // namespace

DeviceWatch::DeviceWatch(Open open, int priority, const ButtonsHandlers& handlers)
    : open_(std::move(open)), priority_(priority), handlers_(handlers), look_(open_()) {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

std::string DeviceWatch::missing() const {
  const std::lock_guard lock(mutex_);
  return missing_;
}

void DeviceWatch::run(const std::stop_token& stop) noexcept {
  static_cast<void>(system::become_realtime(priority_));
  while (!stop.stop_requested()) {
    try {
      look_ ? look_() : look_again();
    } catch (const std::exception& error) {
      let_go(error.what());
    }
  }
}

void DeviceWatch::look_again() {
  system::sleep_until_ns(system::monotonic_ns() + look_again_ns);
  look_ = open_();
  {
    const std::lock_guard lock(mutex_);
    missing_.clear();
  }
  if (handlers_.back) handlers_.back(system::monotonic_ns());
}

void DeviceWatch::let_go(const std::string& why) {
  const bool was_there = look_ != nullptr;
  look_ = nullptr;  // release the device: as long as it is open here, it cannot be found again
  {
    const std::lock_guard lock(mutex_);
    missing_ = why;
  }
  if (was_there && handlers_.fault) handlers_.fault({system::monotonic_ns(), ButtonsFault::Kind::gone, why});
}

}  // namespace turnpoint::io

#include "station/io/touch_reader.hpp"

#include <linux/input.h>
#include <poll.h>
#include <pthread.h>

#include <cerrno>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "station/core/usage_error.hpp"
#include "station/io/evdev_device.hpp"
#include "station/system/wake_up.hpp"

namespace turnpoint::io {

namespace {

constexpr int kTouchPriority = 60;
constexpr int kLookAgain_ms = 1000;

/// An open panel. If the panel can tell fingers apart, each finger is read (by protocol type B of the
/// kernel's Documentation/input/multi-touch-protocol.rst); otherwise the panel is read as a single finger.
class OpenPanel {
 public:
  /// Throws std::system_error if the device is not a touch panel.
  explicit OpenPanel(EvdevDevice device)
      : device_(std::move(device)),
        decoder_(device_.range(slots() ? ABS_MT_POSITION_X : ABS_X),
                 device_.range(slots() ? ABS_MT_POSITION_Y : ABS_Y)) {
    decoder_.resynchronise(fingers());
  }

  int descriptor() const { return device_.descriptor(); }

  /// Reads all waiting events. Throws std::system_error if the panel is gone.
  void read(TouchTimes& times) {
    for (;;) switch (device_.next()) {
        case EvdevDevice::News::none:
          return;
        case EvdevDevice::News::resynchronised:
          decoder_.resynchronise(fingers());
          break;
        case EvdevDevice::News::report:
          for (const auto& touch : decoder_.report(device_.time_ns(), fingers())) times.add(touch);
          break;
      }
  }

 private:
  bool slots() const { return device_.slot_count() > 0; }

  std::vector<Finger> fingers() const {
    if (!slots())
      return {{device_.key(BTN_TOUCH) ? std::optional(0) : std::nullopt, device_.axis(ABS_X),
               device_.axis(ABS_Y)}};
    std::vector<Finger> all;
    for (int k = 0; k < device_.slot_count(); ++k) {
      const int id = device_.slot(k, ABS_MT_TRACKING_ID);
      all.push_back({id >= 0 ? std::optional(id) : std::nullopt, device_.slot(k, ABS_MT_POSITION_X),
                     device_.slot(k, ABS_MT_POSITION_Y)});
    }
    return all;
  }

  EvdevDevice device_;
  TouchDecoder decoder_;
};

OpenPanel open_now(const std::string& device) {
  if (auto found = EvdevDevice::find(device)) return OpenPanel(std::move(*found));
  if (device.starts_with('/'))
    throw std::system_error(errno, std::generic_category(), "touch panel: cannot open " + device);
  throw core::UsageError("touch panel: no device is called \"" + device +
                         "\"; the names of devices are listed in /proc/bus/input/devices");
}

}  // namespace

class TouchReader::Thread {
 public:
  Thread(const std::string& device, OnState on_state, TouchTimes& times)
      : device_(device), on_state_(std::move(on_state)), times_(times), panel_(open_now(device)) {
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }

  ~Thread() {
    thread_.request_stop();
    wake_.ring();
  }

 private:
  void run(const std::stop_token& stop) {
    const sched_param priority{kTouchPriority};
    // without permission, the thread runs at ordinary priority
    ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &priority);
    while (!stop.stop_requested()) {
      pollfd files[] = {{wake_.descriptor(), POLLIN, 0}, {panel_ ? panel_->descriptor() : -1, POLLIN, 0}};
      ::poll(files, 2, panel_ ? -1 : kLookAgain_ms);
      if (!panel_) {
        look_again();
      } else if (files[1].revents != 0) {
        read();
      }
    }
  }

  void read() {
    try {
      panel_->read(times_);
    } catch (const std::system_error&) {
      panel_.reset();
      on_state_(TouchPanelState::lost);
    }
  }

  void look_again() {
    try {
      panel_.emplace(open_now(device_));
    } catch (const std::exception&) {
      return;  // the panel is absent or not completely attached yet: try again later
    }
    on_state_(TouchPanelState::back);
  }

  std::string device_;
  OnState on_state_;
  TouchTimes& times_;
  std::optional<OpenPanel> panel_;
  system::WakeUp wake_;
  std::jthread thread_;
};

TouchReader::TouchReader(const std::string& device, OnState on_state)
    : thread_(std::make_unique<Thread>(device, std::move(on_state), times_)) {}

TouchReader::~TouchReader() = default;

}  // namespace turnpoint::io

#pragma once
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "station/io/buttons.hpp"

namespace turnpoint::io {

/// A thread that watches the device of the buttons or of the finger contact, reports when it is lost, and
/// looks for it until it is back.
class DeviceWatch {
 public:
  /// A function that checks the open device once: it waits a short time for an event and handles it. It
  /// throws if the device is lost.
  using Look = std::function<void()>;
  /// A function that opens the device; throws if the device does not exist.
  using Open = std::function<Look()>;

  /// Opens the device and watches it on a thread with SCHED_FIFO priority `priority`, if the system grants
  /// this. `handlers` must outlive this object. Throws the errors of `open`.
  DeviceWatch(Open open, int priority, const ButtonsHandlers& handlers);

  /// Why the device cannot be watched at present; "" if it is being watched.
  std::string missing() const;

 private:
  void run(const std::stop_token& stop) noexcept;
  void look_again();
  void let_go(const std::string& why);

  Open open_;
  int priority_;
  const ButtonsHandlers& handlers_;
  Look look_;  ///< checks the open device; empty while the device is lost; used only by the thread
  mutable std::mutex mutex_;
  std::string missing_;
  std::jthread thread_;
};

}  // namespace turnpoint::io

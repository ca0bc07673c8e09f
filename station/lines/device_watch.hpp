#pragma once
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "station/lines/buttons.hpp"

namespace turnpoint::lines {

/// A thread that watches a device of the buttons or the contact, tells when it goes, and looks for it until
/// it is back.
class DeviceWatch {
 public:
  /// Looks once at the device that it owns, waiting a little for news; throws when that has gone.
  using Look = std::function<void()>;
  /// Opens the device; throws while it is not there.
  using Open = std::function<Look()>;

  /// Opens, and watches from then on at that SCHED_FIFO priority where it is granted. `handlers` must outlive
  /// this. Throws what `open` throws.
  DeviceWatch(Open open, int priority, const ButtonsHandlers& handlers);

  /// Why the device cannot be watched now; "" while it is.
  std::string missing() const;

 private:
  void run(const std::stop_token& stop) noexcept;
  void look_again();
  void let_go(const std::string& why);

  Open open_;
  int priority_;
  const ButtonsHandlers& handlers_;
  Look look_;  ///< none while the device is gone; of the thread
  mutable std::mutex mutex_;
  std::string missing_;
  std::jthread thread_;
};

}  // namespace turnpoint::lines

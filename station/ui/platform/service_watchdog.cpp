#include "station/ui/platform/service_watchdog.hpp"

#include "station/system/service_manager.hpp"

namespace turnpoint::ui {

ServiceWatchdog::ServiceWatchdog() {
  connect(&timer_, &QTimer::timeout, [] { system::notify_service_manager("WATCHDOG=1"); });
  QTimer::singleShot(0, this, [] { system::notify_service_manager("READY=1"); });
  if (const int every_ms = system::watchdog_interval_ms(); every_ms > 0) timer_.start(every_ms);
}

}  // namespace turnpoint::ui

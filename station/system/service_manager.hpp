#pragma once
#include <string_view>

namespace turnpoint::system {

/// Sends a state such as "READY=1" to the service manager (sd_notify(3): a datagram to $NOTIFY_SOCKET). Does
/// nothing if no service manager started the process.
void notify_service_manager(std::string_view state);

/// Returns the interval, in ms, at which to report to the service manager's watchdog: half of the longest
/// interval that the watchdog allows. Returns 0 if no watchdog watches this process.
int watchdog_interval_ms();

}  // namespace turnpoint::system

#pragma once
#include <string_view>

namespace turnpoint::system {

/// Sends a state such as "READY=1" to the service manager (sd_notify(3): a datagram to $NOTIFY_SOCKET).
/// Without a service manager it does nothing.
void notify_service_manager(std::string_view state);

/// Half of the longest interval that the service manager's watchdog allows between two reports, in ms; 0 if
/// it expects none from this process.
int watchdog_interval_ms();

}  // namespace turnpoint::system

#pragma once
#include <string_view>

namespace turnpoint::system {

/// Sends a state such as "READY=1" to the service manager (sd_notify(3): a datagram to $NOTIFY_SOCKET).
/// Without one nothing happens.
void notify_service_manager(std::string_view state);

/// Half of the time that the service manager's watchdog allows between two signs of life, in ms; 0 where it
/// wants none from this process.
int watchdog_interval_ms();

}  // namespace turnpoint::system

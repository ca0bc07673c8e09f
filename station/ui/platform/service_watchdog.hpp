#pragma once
#include <QTimer>

namespace turnpoint::ui {

/// Tells systemd (sd_notify(3): a datagram to $NOTIFY_SOCKET) that the station is ready, and then, as often
/// as its watchdog requires, that the event loop is still running. Without a service manager it does nothing.
class ServiceWatchdog : public QObject {
 public:
  ServiceWatchdog();

 private:
  QTimer timer_;
};

}  // namespace turnpoint::ui

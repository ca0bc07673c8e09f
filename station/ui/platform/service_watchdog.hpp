#pragma once
#include <QTimer>

namespace turnpoint::ui {

/// Reports to systemd that the station is ready and then, as often as systemd's watchdog requires, that the
/// event loop is still running (sd_notify(3): a datagram to $NOTIFY_SOCKET). Without a service manager it
/// does nothing.
class ServiceWatchdog : public QObject {
 public:
  ServiceWatchdog();

 private:
  QTimer timer_;
};

}  // namespace turnpoint::ui

#include "station/ui/service_watchdog.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace turnpoint::ui {

namespace {

void notify(std::string_view state) {
  const char* path = std::getenv("NOTIFY_SOCKET");
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path == nullptr || std::strlen(path) >= sizeof address.sun_path) return;
  std::strcpy(address.sun_path, path);
  if (address.sun_path[0] == '@') address.sun_path[0] = '\0';  // an abstract name
  const int descriptor = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return;
  // A manager that cannot be told will restart the station, and its journal says why.
  [[maybe_unused]] const auto sent = ::sendto(
      descriptor, state.data(), state.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&address),
      static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + std::strlen(path)));
  ::close(descriptor);
}

/// Half of what the manager allows between two signs of life; 0 where it wants none from this process.
int interval_ms() {
  const char* allowed_us = std::getenv("WATCHDOG_USEC");
  const char* process = std::getenv("WATCHDOG_PID");
  if (allowed_us == nullptr || (process != nullptr && std::atol(process) != ::getpid())) return 0;
  return static_cast<int>(std::atoll(allowed_us) / 2000);
}

}  // namespace

ServiceWatchdog::ServiceWatchdog() {
  connect(&timer_, &QTimer::timeout, [] { notify("WATCHDOG=1"); });
  QTimer::singleShot(0, this, [] { notify("READY=1"); });
  if (const int every_ms = interval_ms(); every_ms > 0) timer_.start(every_ms);
}

}  // namespace turnpoint::ui

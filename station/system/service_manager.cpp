#include "station/system/service_manager.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>

#include "station/core/file_descriptor.hpp"

namespace turnpoint::system {

void notify_service_manager(std::string_view state) {
  const char* path = std::getenv("NOTIFY_SOCKET");
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path == nullptr || std::strlen(path) >= sizeof address.sun_path) return;
  std::strcpy(address.sun_path, path);
  // '@' at the start of a name means the abstract namespace, where the first byte is zero
  if (address.sun_path[0] == '@') address.sun_path[0] = '\0';
  const core::FileDescriptor socket(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (!socket.is_open()) return;
  // Failure can be ignored: if the manager does not receive the state, it restarts the station, and its
  // journal says why.
  [[maybe_unused]] const auto sent = ::sendto(
      socket.get(), state.data(), state.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&address),
      static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + std::strlen(path)));
}

int watchdog_interval_ms() {
  const char* allowed_us = std::getenv("WATCHDOG_USEC");
  const char* process = std::getenv("WATCHDOG_PID");
  if (allowed_us == nullptr || (process != nullptr && std::atol(process) != ::getpid())) return 0;
  return static_cast<int>(std::atoll(allowed_us) / 2000);
}

}  // namespace turnpoint::system

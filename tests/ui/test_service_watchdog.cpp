#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <QCoreApplication>
#include <QDeadlineTimer>
#include <cstddef>
#include <cstring>
#include <string>

#include "station/ui/platform/service_watchdog.hpp"
#include "tests/support/catch.hpp"
#include "tests/ui/event_loop.hpp"

using turnpoint::ui::ServiceWatchdog;

namespace {

/// Simulates the service manager: opens an abstract datagram socket and stores its name in NOTIFY_SOCKET.
class Manager {
 public:
  Manager() : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    const std::string name = "@turnpoint-test-" + std::to_string(::getpid());
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, name.data(), name.size());
    address.sun_path[0] = '\0';
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
    REQUIRE(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), length) == 0);
    qputenv("NOTIFY_SOCKET", name.c_str());
  }
  ~Manager() {
    for (const char* name : {"NOTIFY_SOCKET", "WATCHDOG_USEC", "WATCHDOG_PID"}) qunsetenv(name);
    ::close(socket_);
  }

  /// Runs the event loop until a message arrives, and returns the message. Returns "" if none arrives within
  /// `patience_ms`.
  std::string told(int patience_ms) const {
    char text[64] = {};
    const QDeadlineTimer deadline(patience_ms);
    for (;;) {
      const auto length = ::recv(socket_, text, sizeof text, 0);
      if (length > 0) return {text, static_cast<std::size_t>(length)};
      if (deadline.hasExpired()) return "";
      QCoreApplication::processEvents(QEventLoop::AllEvents, 10);
    }
  }

 private:
  int socket_;
};

using Loop = turnpoint::EventLoop<>;

}  // namespace

TEST_CASE(
    "a service manager gets the message that the station is ready, and then regular signs that it is alive",
    "[watchdog]") {
  const Loop loop;
  const Manager manager;
  qputenv("WATCHDOG_USEC", "20000");
  qputenv("WATCHDOG_PID", std::to_string(::getpid()).c_str());
  const ServiceWatchdog watchdog;
  CHECK(manager.told(0).empty());  // no message before the event loop runs
  CHECK(manager.told(10000) == "READY=1");
  CHECK(manager.told(10000) == "WATCHDOG=1");
  CHECK(manager.told(10000) == "WATCHDOG=1");
}

TEST_CASE("signs of life are sent only if the service manager wants them from this process", "[watchdog]") {
  const Loop loop;
  const Manager manager;
  if (GENERATE(true, false)) {
    qputenv("WATCHDOG_USEC", "2000");
    qputenv("WATCHDOG_PID", "1");
  }
  const ServiceWatchdog watchdog;
  CHECK(manager.told(10000) == "READY=1");
  CHECK(manager.told(30).empty());
}

TEST_CASE("without a service manager nothing is sent", "[watchdog]") {
  const Loop loop;
  const Manager manager;
  qunsetenv("NOTIFY_SOCKET");
  const ServiceWatchdog watchdog;
  CHECK(manager.told(30).empty());
}

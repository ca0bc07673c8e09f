#include "tests/collector/proxy.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace {

bool write_all(int to, const char* bytes, std::size_t size) {
  while (size > 0) {
    const auto written = ::send(to, bytes, size, MSG_NOSIGNAL);
    if (written <= 0) return false;
    bytes += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

int connect_to(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  const int server = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (::connect(server, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) return server;
  ::close(server);
  return -1;
}

}  // namespace

Proxy::Proxy(std::string socket, std::function<Trouble()> trouble)
    : socket_(std::move(socket)), trouble_(std::move(trouble)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 || ::listen(listener_, 8) != 0 ||
      ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0 || ::pipe(wake_) != 0)
    throw std::runtime_error("the proxy cannot listen");
  port_ = ntohs(address.sin_port);
  thread_ = std::jthread([this] { serve(); });
}

Proxy::~Proxy() {
  ::close(wake_[1]);  // wakes the thread, which then ends
  thread_.join();
  ::close(wake_[0]);
  ::close(listener_);
}

void Proxy::serve() {
  for (;;) {
    pollfd ready[] = {{listener_, POLLIN, 0}, {wake_[0], POLLIN, 0}};
    if (::poll(ready, 2, -1) < 0 || ready[1].revents != 0) return;
    const int client = ::accept(listener_, nullptr, nullptr);
    if (client < 0) continue;
    pass(client, trouble_());
    ::close(client);
  }
}

void Proxy::pass(int client, const Trouble& trouble) {
  const int server = connect_to(socket_);
  std::uint64_t sent = 0, received = 0;
  char bytes[4096];
  for (bool open = server >= 0; open;) {
    pollfd ready[] = {{client, POLLIN, 0}, {server, POLLIN, 0}, {wake_[0], POLLIN, 0}};
    if (::poll(ready, 3, -1) < 0 || ready[2].revents != 0) break;
    if (ready[0].revents != 0) {
      const auto size = ::read(client, bytes, sent < trouble.slow_sent ? 1 : sizeof bytes);
      const auto end = sent + static_cast<std::uint64_t>(size > 0 ? size : 0);
      if (size <= 0 || end > trouble.cut_sent) break;
      if (trouble.corrupt_sent >= sent && trouble.corrupt_sent < end)
        bytes[trouble.corrupt_sent - sent] ^= 0x10;
      open = write_all(server, bytes, static_cast<std::size_t>(size));
      sent = end;
    }
    if (ready[1].revents != 0) {
      const auto size = ::read(server, bytes, sizeof bytes);
      received += static_cast<std::uint64_t>(size > 0 ? size : 0);
      if (size <= 0 || received > trouble.cut_received) break;
      open = write_all(client, bytes, static_cast<std::size_t>(size));
    }
  }
  if (server >= 0) ::close(server);
  sent_ = std::max(sent_.load(), sent);
  received_ = std::max(received_.load(), received);
}

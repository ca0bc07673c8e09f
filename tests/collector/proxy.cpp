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

sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  return address;
}

int connected(int family, const void* address, std::size_t size) {
  const int server = ::socket(family, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (::connect(server, static_cast<const sockaddr*>(address), static_cast<socklen_t>(size)) == 0)
    return server;
  ::close(server);
  return -1;
}

int connect_to(const std::string& where) {
  if (!where.starts_with('/')) {
    const auto address = loopback(std::stoi(where));
    return connected(AF_INET, &address, sizeof address);
  }
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, where.c_str(), sizeof address.sun_path - 1);
  return connected(AF_UNIX, &address, sizeof address);
}

/// Flips a bit of one byte in a stream, but not in the head of a message: after a changed length, both sides
/// could wait for each other for ever.
class Corruption {
 public:
  /// `before_tls` is the number of bytes before the first TLS record. -1 means no TLS: the stream then
  /// consists of PostgreSQL's messages, and the client's first message has no type byte.
  Corruption(std::uint64_t at, int before_tls)
      : at_(at), before_tls_(before_tls), tls_(before_tls >= 0), head_(tls_ ? 0 : 1) {}

  void pass(char* bytes, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
      const bool content = is_content(static_cast<unsigned char>(bytes[i]));
      if (position_++ < at_ || !content || done_) continue;
      bytes[i] ^= 0x10;
      done_ = true;
    }
  }

 private:
  /// Takes the next byte of the stream. Returns true if it belongs to the content of a message (with TLS: to
  /// its encrypted content).
  bool is_content(unsigned char byte) {
    constexpr unsigned kEncrypted = 23, kHeadBytes = 5;
    if (before_tls_ > 0) return --before_tls_, false;
    if (content_ > 0) return --content_, !tls_ || type_ == kEncrypted;
    if (head_ == 0) type_ = byte;
    if (head_ >= (tls_ ? 3U : 1U)) length_ = (length_ << 8U) | byte;
    if (++head_ < kHeadBytes) return false;
    content_ = tls_ ? length_ : length_ - 4;  // PostgreSQL's length includes the length field
    head_ = length_ = 0;
    return false;
  }

  std::uint64_t at_, position_ = 0;
  int before_tls_;
  bool tls_, done_ = false;
  unsigned head_, type_ = 0, length_ = 0, content_ = 0;
};

}  // namespace

Proxy::Proxy(std::string server, std::function<Trouble()> trouble)
    : server_(std::move(server)), trouble_(std::move(trouble)) {
  auto address = loopback(0);
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
  const int server = connect_to(server_);
  std::uint64_t sent = 0, received = 0;
  Corruption corrupt_sent(trouble.corrupt_sent, trouble.tls ? 8 : -1),
      corrupt_received(trouble.corrupt_received, trouble.tls ? 1 : -1);
  char bytes[4096];
  for (bool open = server >= 0; open;) {
    pollfd ready[] = {{client, POLLIN, 0}, {server, POLLIN, 0}, {wake_[0], POLLIN, 0}};
    if (::poll(ready, 3, -1) < 0 || ready[2].revents != 0) break;
    if (ready[0].revents != 0) {
      const auto size = ::read(client, bytes, sent < trouble.slow_sent ? 1 : sizeof bytes);
      const auto end = sent + static_cast<std::uint64_t>(size > 0 ? size : 0);
      if (size <= 0 || end > trouble.cut_sent) break;
      corrupt_sent.pass(bytes, static_cast<std::size_t>(size));
      open = write_all(server, bytes, static_cast<std::size_t>(size));
      sent = end;
    }
    if (ready[1].revents != 0) {
      const auto size = ::read(server, bytes, sizeof bytes);
      received += static_cast<std::uint64_t>(size > 0 ? size : 0);
      if (size <= 0 || received > trouble.cut_received) break;
      corrupt_received.pass(bytes, static_cast<std::size_t>(size));
      open = write_all(client, bytes, static_cast<std::size_t>(size));
    }
  }
  if (server >= 0) ::close(server);
  sent_ = std::max(sent_.load(), sent);
  received_ = std::max(received_.load(), received);
}

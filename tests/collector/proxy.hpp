#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <thread>

/// How the proxy disturbs one connection. Bytes are counted from the beginning of the connection.
struct Trouble {
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t cut_sent = kNever;      ///< cut before this byte from the client reaches the server
  std::uint64_t cut_received = kNever;  ///< cut before this byte from the server reaches the client
  std::uint64_t corrupt_sent = kNever;  ///< flip a bit of the first byte of content from this byte on
  /// flip a bit of the first byte of content from the server from this byte on
  std::uint64_t corrupt_received = kNever;
  /// true if the connection begins with a request for TLS
  bool tls = false;
  std::uint64_t slow_sent = 0;  ///< pass on this many first bytes from the client one at a time
};

/// Listens on a TCP port of the loopback interface, and passes bytes on to a server and back.
class Proxy {
 public:
  /// `server` is the path of a Unix socket, or a TCP port of the loopback interface. The proxy's thread calls
  /// `trouble` for each connection.
  Proxy(std::string server, std::function<Trouble()> trouble);
  Proxy(const Proxy&) = delete;
  Proxy& operator=(const Proxy&) = delete;
  ~Proxy();

  int port() const { return port_; }
  /// The largest numbers of bytes that a finished connection has sent and received.
  std::uint64_t sent() const { return sent_; }
  std::uint64_t received() const { return received_; }

 private:
  void serve();
  void pass(int client, const Trouble& trouble);

  std::string server_;
  std::function<Trouble()> trouble_;
  int listener_ = -1, port_ = 0, wake_[2] = {-1, -1};
  std::atomic<std::uint64_t> sent_ = 0, received_ = 0;
  std::jthread thread_;
};

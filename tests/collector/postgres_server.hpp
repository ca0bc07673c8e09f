#pragma once
#include <string>

#include "station/collector/postgres.hpp"
#include "tests/support/temporary_folder.hpp"

/// A PostgreSQL server in a temporary folder, reached through a Unix socket in that folder only, or also
/// under TLS as `localhost`. It runs as the user postgres if the test runs as root. It has the database
/// `turnpoint` with the collector's schema, and the roles station_a (station bench-a), station_b (bench-b)
/// and reader.
///
/// If TURNPOINT_POSTGRES_ROOT names the root folder of another Debian, its server is used. That root must
/// have this machine's /dev and a /proc.
class PostgresServer {
 public:
  struct Options {
    bool tls = false;
    std::string initdb;  ///< more arguments for initdb
  };
  PostgresServer();
  explicit PostgresServer(const Options& options);
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;
  ~PostgresServer();

  /// Connection string for a role.
  std::string as(const std::string& role) const;
  /// Connection string for a role as a URI, for commands that read from a collector.
  std::string address(const std::string& role) const;
  /// Connects as the superuser.
  turnpoint::collector::Connection admin() const;
  /// Makes a role that may send the sessions of this station.
  void add_station(const std::string& station_id, const std::string& role) const;
  void stop();
  void start();
  int port() const { return port_; }  ///< under TLS
  std::string certificate() const { return folder_ / "server.crt"; }
  std::string socket() const { return folder_ / ".s.PGSQL." + std::to_string(port_); }
  const std::string& folder() const { return folder_.path; }
  /// Runs a program of PostgreSQL ("psql ...") as the server's user.
  void run(const std::string& program, const std::string& arguments) const;
  /// Makes the server's user the owner of a folder.
  static void own(const std::string& folder);

 private:
  void as_server(const std::string& command) const;
  void make_certificate();

  TemporaryFolder folder_;
  bool tls_ = false;
  int port_ = 5432;
  bool runs_ = false;
};

#pragma once
#include <string>

#include "station/collector/postgres.hpp"
#include "tests/support/temporary_folder.hpp"

/// A PostgreSQL server in a temporary folder, reached through a Unix socket in that folder only. It runs as
/// the user postgres if the test runs as root. It has the database `turnpoint` with the collector's schema,
/// and the roles station_a (station bench-a), station_b (bench-b) and reader.
class PostgresServer {
 public:
  PostgresServer();
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;
  ~PostgresServer();

  /// Connection string for a role.
  std::string as(const std::string& role) const;
  /// Connects as the superuser.
  turnpoint::collector::Connection admin() const;
  /// Makes a role that may send the sessions of this station.
  void add_station(const std::string& station_id, const std::string& role) const;
  void stop();
  void start();
  std::string socket() const { return folder_ / ".s.PGSQL.5432"; }
  const std::string& folder() const { return folder_.path; }
  /// Runs a program of PostgreSQL ("psql ...") as the server's user.
  void run(const std::string& program, const std::string& arguments) const;

 private:
  TemporaryFolder folder_;
  bool runs_ = false;
};

#include "tests/collector/postgres_server.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "station/collector/schema.hpp"

namespace {

namespace fs = std::filesystem;

/// Returns the folder with the programs of the newest installed PostgreSQL.
std::string programs() {
  std::vector<std::string> found;
  for (const auto& version : fs::directory_iterator("/usr/lib/postgresql"))
    if (fs::exists(version.path() / "bin/initdb")) found.push_back(version.path() / "bin/");
  if (found.empty()) throw std::runtime_error("install the package postgresql: these tests start a server");
  return *std::max_element(found.begin(), found.end());
}

std::string read_file(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

void PostgresServer::run(const std::string& program, const std::string& arguments) const {
  const bool root = ::geteuid() == 0;
  const auto command = fmt::format("cd {0} && {1} {2}{3} {4} >>{0}/log 2>&1 </dev/null", folder_.path,
                                   root ? "setpriv --reuid=postgres --regid=postgres --clear-groups --" : "",
                                   programs(), program, arguments);
  if (std::system(command.c_str()) != 0)
    throw std::runtime_error(program + " failed:\n" + read_file(folder_ / "log"));
}

PostgresServer::PostgresServer() {
  std::ofstream(folder_ / "log") << "";
  if (::geteuid() == 0 && std::system(("chown -R postgres:postgres " + folder_.path).c_str()) != 0)
    throw std::runtime_error("no user postgres");
  run("initdb", "--no-sync --auth=trust --encoding=UTF8 --locale=C.UTF-8 --username=postgres -D data");
  start();
  run("createdb", fmt::format("-h {} -U postgres turnpoint", folder_.path));
  std::ofstream(folder_ / "schema.sql") << turnpoint::collector::schema_sql();
  run("psql", fmt::format("-q -h {} -U postgres -d turnpoint -f schema.sql", folder_.path));
  add_station("bench-a", "station_a");
  add_station("bench-b", "station_b");
  auto server = admin();
  server.query("CREATE ROLE reader LOGIN IN ROLE turnpoint_reader");
}

PostgresServer::~PostgresServer() {
  try {
    stop();
  } catch (const std::exception&) {
    // Ignore the error: a server whose folder is gone ends by itself.
  }
}

void PostgresServer::start() {
  // The data of this server need not survive a power cut, so it need not wait for the disk.
  run("pg_ctl",
      fmt::format("-w -D data -l log -o \"-c listen_addresses='' -c unix_socket_directories={} -c fsync=off"
                  " -c max_connections=60 -c shared_buffers=64MB\" start",
                  folder_.path));
  runs_ = true;
}

void PostgresServer::stop() {
  if (!runs_) return;
  runs_ = false;
  run("pg_ctl", "-w -D data -m immediate stop");
}

std::string PostgresServer::as(const std::string& role) const {
  return fmt::format("host={} dbname=turnpoint user={}", folder_.path, role);
}

turnpoint::collector::Connection PostgresServer::admin() const {
  return turnpoint::collector::Connection(as("postgres"));
}

void PostgresServer::add_station(const std::string& station_id, const std::string& role) const {
  auto server = admin();
  server.query(fmt::format("CREATE ROLE {} LOGIN IN ROLE turnpoint_station", role));
  server.query("INSERT INTO turnpoint.station (station_id, role) VALUES ($1, $2)", {station_id, role});
}

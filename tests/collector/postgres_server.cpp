#include "tests/collector/postgres_server.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "station/collector/schema.hpp"

namespace {

namespace fs = std::filesystem;

/// Returns the root folder of the Debian system whose PostgreSQL is used; "" for this machine.
std::string server_root() {
  const char* root = std::getenv("TURNPOINT_POSTGRES_ROOT");
  return root != nullptr ? root : "";
}

/// Returns the folder with the programs of the newest installed PostgreSQL.
std::string programs() {
  std::vector<std::string> found;
  for (const auto& version : fs::directory_iterator(server_root() + "/usr/lib/postgresql"))
    if (fs::exists(version.path() / "bin/initdb")) found.push_back(version.path().filename());
  if (found.empty()) throw std::runtime_error("install the package postgresql: these tests start a server");
  return "/usr/lib/postgresql/" + *std::max_element(found.begin(), found.end()) + "/bin/";
}

/// Runs a command in the root folder of the server's system.
int run_there(const std::string& command) {
  const auto root = server_root();
  return std::system(((root.empty() ? "" : "chroot " + root + " ") + "sh -c '" + command + "'").c_str());
}

std::string read_file(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns a port of the loopback interface that is not in use.
int free_port() {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  const int probe = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const bool bound = ::bind(probe, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                     ::getsockname(probe, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  ::close(probe);
  if (!bound) throw std::runtime_error("no free port");
  return ntohs(address.sin_port);
}

}  // namespace

void PostgresServer::as_server(const std::string& command) const {
  const auto* as_postgres =
      ::geteuid() == 0 ? "setpriv --reuid=postgres --regid=postgres --clear-groups --" : "";
  if (run_there(fmt::format("cd {} && PGPORT={} {} {} >>log 2>&1 </dev/null", folder_.path, port_,
                            as_postgres, command)) != 0)
    throw std::runtime_error(command + " failed:\n" + read_file(folder_ / "log"));
}

void PostgresServer::own(const std::string& folder) {
  if (::geteuid() == 0 && run_there("chown -R postgres:postgres " + folder) != 0)
    throw std::runtime_error("no user postgres");
}

void PostgresServer::run(const std::string& program, const std::string& arguments) const {
  as_server(programs() + program + " " + arguments);
}

void PostgresServer::make_certificate() {
  port_ = free_port();
  tls_ = true;
  as_server(
      "openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 2 -subj /CN=localhost"
      " -addext subjectAltName=DNS:localhost -keyout server.key -out server.crt");
}

PostgresServer::PostgresServer() : PostgresServer(Options()) {}

PostgresServer::PostgresServer(const Options& options) {
  std::ofstream(folder_ / "log") << "";
  own(folder_.path);
  run("initdb", "--no-sync --auth=trust --encoding=UTF8 --locale=C.UTF-8 --username=postgres -D data " +
                    options.initdb);
  if (options.tls) make_certificate();
  start();
  run("createdb", fmt::format("-h {} -U postgres turnpoint", folder_.path));
  std::ofstream(folder_ / "schema.sql") << turnpoint::collector::schema_sql();
  run("psql", fmt::format("-q -h {} -U postgres -d turnpoint -f schema.sql", folder_.path));
  add_station("bench-a", "station_a");
  add_station("bench-b", "station_b");
  auto server = admin();
  server.query("CREATE ROLE reader LOGIN IN ROLE turnpoint_reader");
  server.query("GRANT CONNECT ON DATABASE turnpoint TO reader");
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
  const auto network = tls_ ? fmt::format(
                                  "-c listen_addresses=127.0.0.1 -c ssl=on -c ssl_cert_file={0}/server.crt"
                                  " -c ssl_key_file={0}/server.key",
                                  folder_.path)
                            : "-c listen_addresses=";
  run("pg_ctl", fmt::format("-w -D data -l log -o \"{} -c port={} -c unix_socket_directories={} -c fsync=off"
                            " -c max_connections=60 -c shared_buffers=64MB\" start",
                            network, port_, folder_.path));
  runs_ = true;
}

void PostgresServer::stop() {
  if (!runs_) return;
  runs_ = false;
  run("pg_ctl", "-w -D data -m immediate stop");
}

std::string PostgresServer::as(const std::string& role) const {
  return fmt::format("host={} port={} dbname=turnpoint user={}", folder_.path, port_, role);
}

std::string PostgresServer::address(const std::string& role) const {
  return fmt::format("postgresql:///turnpoint?host={}&port={}&user={}", folder_.path, port_, role);
}

turnpoint::collector::Connection PostgresServer::admin() const {
  return turnpoint::collector::Connection(as("postgres"));
}

void PostgresServer::add_station(const std::string& station_id, const std::string& role) const {
  auto server = admin();
  server.query(fmt::format("CREATE ROLE {} LOGIN IN ROLE turnpoint_station", role));
  server.query(fmt::format("GRANT CONNECT ON DATABASE turnpoint TO {}", role));
  server.query("INSERT INTO turnpoint.station (station_id, role) VALUES ($1, $2)", {station_id, role});
}

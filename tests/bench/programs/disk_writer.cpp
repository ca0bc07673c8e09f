// disk_writer DATABASE FULL|NORMAL COUNT DEVICE: writes COUNT one-row transactions in WAL mode. After each
// commit it writes a mark such as "FULL 17" to DEVICE (see disk_marker.hpp). With FULL, a marked row must
// survive a power cut. With NORMAL most cuts lose some rows, which shows that the test can fail.
#include <sqlite3.h>

#include <algorithm>

#include "tests/bench/programs/disk_marker.hpp"

int main(int argc, char** argv) {
  if (argc != 5) return std::fprintf(stderr, "disk_writer DATABASE FULL|NORMAL COUNT DEVICE\n"), 2;
  sqlite3* db = nullptr;
  const auto run = [&db](const std::string& sql) {
    char* message = nullptr;
    if (sqlite3_exec(db, sql.c_str(), nullptr, nullptr, &message) == SQLITE_OK) return;
    std::fprintf(stderr, "%s: %s\n", sql.c_str(), message);
    std::exit(1);
  };
  if (sqlite3_open(argv[1], &db) != SQLITE_OK) return std::fprintf(stderr, "%s\n", sqlite3_errmsg(db)), 1;
  const std::string mode = argv[2];
  run("PRAGMA journal_mode=WAL; PRAGMA synchronous=" + mode);
  run("CREATE TABLE row (number INTEGER PRIMARY KEY, text TEXT)");
  DiskMarker marker(argv[4]);
  for (int i = 1; i <= std::atoi(argv[3]); ++i) {
    run("INSERT INTO row VALUES (" + std::to_string(i) + ", hex(randomblob(200)))");
    marker.mark(mode + " " + std::to_string(i));
  }
  std::_Exit(0);  // leave the database open, as a running station would at a power cut
}

// disk_writer DATABASE FULL|NORMAL COUNT ACKNOWLEDGED: so many one-row transactions in WAL mode; after each
// commit its number is appended to ACKNOWLEDGED, which lies on another, safe file system.
#include <sqlite3.h>

#include <cstdio>
#include <cstdlib>
#include <string>

int main(int argc, char** argv) {
  if (argc != 5) return std::fprintf(stderr, "disk_writer DATABASE FULL|NORMAL COUNT ACKNOWLEDGED\n"), 2;
  sqlite3* db = nullptr;
  const auto run = [&db](const std::string& sql) {
    char* message = nullptr;
    if (sqlite3_exec(db, sql.c_str(), nullptr, nullptr, &message) == SQLITE_OK) return;
    std::fprintf(stderr, "%s: %s\n", sql.c_str(), message);
    std::exit(1);
  };
  if (sqlite3_open(argv[1], &db) != SQLITE_OK) return std::fprintf(stderr, "%s\n", sqlite3_errmsg(db)), 1;
  run("PRAGMA journal_mode=WAL");
  run(std::string("PRAGMA synchronous=") + argv[2]);
  run("CREATE TABLE IF NOT EXISTS row (number INTEGER PRIMARY KEY, text TEXT)");
  std::FILE* acknowledged = std::fopen(argv[4], "w");
  for (int i = 1; i <= std::atoi(argv[3]); ++i) {
    run("BEGIN IMMEDIATE");
    run("INSERT INTO row VALUES (" + std::to_string(i) + ", hex(randomblob(200)))");
    run("COMMIT");
    std::fprintf(acknowledged, "%d\n", i);
    std::fflush(acknowledged);
  }
  // No orderly close: the file stays as a running station would leave it.
  std::_Exit(0);
}

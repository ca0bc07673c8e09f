// watch_rows DATABASE TABLE DEVICE: counts the rows that another process has committed to a table, until
// killed. Writes each count as a mark such as "rows 17" (see disk_marker.hpp). With WAL mode and synchronous
// FULL, a row that a reader sees must survive a power cut.
#include <sqlite3.h>

#include <algorithm>

#include "tests/bench/programs/disk_marker.hpp"

namespace {

int rows(sqlite3* db, const char* table) {
  sqlite3_stmt* query = nullptr;
  int count = -1;
  if (sqlite3_prepare_v2(db, (std::string("SELECT count(*) FROM ") + table).c_str(), -1, &query, nullptr) ==
          SQLITE_OK &&
      sqlite3_step(query) == SQLITE_ROW)
    count = sqlite3_column_int(query, 0);
  sqlite3_finalize(query);
  return count;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return std::fprintf(stderr, "watch_rows DATABASE TABLE DEVICE\n"), 2;
  DiskMarker marker(argv[3]);
  sqlite3* db = nullptr;
  for (int known = -1;; ::usleep(2000)) {
    if (!db && sqlite3_open_v2(argv[1], &db, SQLITE_OPEN_READONLY, nullptr) != SQLITE_OK)
      sqlite3_close(db), db = nullptr;
    const int now = db ? rows(db, argv[2]) : -1;
    if (now > known) marker.mark("rows " + std::to_string(known = now));
  }
}

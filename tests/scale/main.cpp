// scale make FILE SESSIONS TRIALS [STATION]: makes a large database (database.hpp).
// scale begin FILE: begins a session and ends it at once.
// scale start-page FILE: makes the database queries of the start page.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "station/store/backup.hpp"
#include "station/store/read.hpp"
#include "tests/scale/database.hpp"

using namespace turnpoint;

namespace {

void begin(const std::string& path) {
  core::SessionStart start;
  start.participant = "P99999";
  start.station_id = "scale";
  start.protocol_id = "demo";
  auto log = store::SessionLog::begin(path, start, {});
  log.finish(core::SessionStatus::stopped, "");
}

int run(const std::string& what, int argc, char** argv) {
  const std::string path = argv[2];
  if (what == "make" && argc >= 5)
    make_database(path, std::atoi(argv[3]), std::atoi(argv[4]), argc > 5 ? argv[5] : "scale");
  else if (what == "begin")
    begin(path);
  else if (what == "start-page")
    std::printf("%zu participants%s%s\n", store::participants(path).size(),
                store::interrupted_session(path) ? ", one interrupted" : "",
                store::last_backup(path) ? ", a backup" : "");
  else
    return 2;
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  try {
    return run(argv[1], argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "scale: %s\n", error.what());
    return 1;
  }
}

#include <fstream>

#include "station/session/planned_session.hpp"
#include "station/store/session_log.hpp"
#include "station/store/station.hpp"
#include "station/view/station_state.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/small_disk.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/view/demo.hpp"

using namespace turnpoint;

namespace {

/// The key of what the sign of the database says.
std::string database_says(const view::StationState& state) {
  for (const auto& sign : state.signs)
    if (sign.name == "database") return sign.says.key;
  return "";
}

std::string database_in(const std::string& folder) {
  core::SessionStart start;
  start.participant = "P01", start.protocol_id = "demo", start.run_mode = core::RunMode::pilot;
  start.station_id = store::suggested_station_name(), start.started_local = session::local_time();
  store::SessionLog::begin(folder + "/lab.sqlite", start, {}).finish(core::SessionStatus::completed, "");
  return folder + "/lab.sqlite";
}

}  // namespace

TEST_CASE("a station with a good database, or none yet, can record, and says its name", "[state]") {
  const TemporaryFolder folder;
  const auto database = GENERATE(false, true) ? database_in(folder.path) : folder / "none.sqlite";
  const auto state = view::station_state(database);
  CHECK(state.refusal.empty());
  CHECK(database_says(state) == "state.database_good");
  CHECK_FALSE(state.station.empty());
  CHECK(state.signs.size() == 3);
}

TEST_CASE("a damaged database is found before a session, also if the damage is behind the first page",
          "[state]") {
  const TemporaryFolder folder;
  const auto database = database_in(folder.path);
  {
    std::fstream file(database, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(GENERATE(0, 4096, 8192));
    file << std::string(600, '\x5a');
  }
  const auto state = view::station_state(database);
  CAPTURE(core::say(state.refusal, "en"));
  CHECK_FALSE(state.refusal.empty());
  CHECK(database_says(state) == "state.database_damaged");
}

TEST_CASE("a full disk and a write-protected one are found before a session", "[state]") {
  SmallDisk disk(24);
  if (!disk.mounted) {
    WARN("not tested: needs the right to mount a file system");
    return;
  }
  const auto database = database_in(disk.folder.path);
  CHECK(view::station_state(database).refusal.empty());
  SECTION("full") {
    SmallDisk::fill(disk / "filling");
    const auto state = view::station_state(database);
    CHECK_FALSE(state.refusal.empty());
    CHECK(database_says(state) == "state.database_full");
  }
  SECTION("write-protected") {
    REQUIRE(disk.protect());
    const auto state = view::station_state(database);
    CHECK_FALSE(state.refusal.empty());
    CHECK(database_says(state) == "state.database_read_only");
  }
}

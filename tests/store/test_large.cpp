// These tests measure the cost of large databases in steps of SQLite's virtual machine. Unlike time, the
// number of steps is the same on every computer.
#include <sqlite3.h>

#include <functional>

#include "station/store/backup.hpp"
#include "station/store/export.hpp"
#include "station/store/merge.hpp"
#include "station/store/read.hpp"
#include "station/store/verify.hpp"
#include "tests/scale/database.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::store;
namespace fs = std::filesystem;

namespace {

std::int64_t steps = 0;

int count(void* /*unused*/) {
  ++steps;
  return 0;
}
int count_every_connection(sqlite3* connection, const char** /*error*/, const void* /*routines*/) {
  sqlite3_progress_handler(connection, 100, count, nullptr);
  return SQLITE_OK;
}

/// Runs `action` and returns the number of steps of SQLite's virtual machine on all its connections, in
/// hundreds.
std::int64_t steps_of(const std::function<void()>& action) {
  const auto extension = reinterpret_cast<void (*)()>(count_every_connection);
  sqlite3_auto_extension(extension);
  steps = 0;
  action();
  sqlite3_cancel_auto_extension(extension);
  return steps;
}

void begin_session(const std::string& db) {
  sample::session(db, 0, sample::start("X1"), SessionStatus::stopped);
}

}  // namespace

TEST_CASE("a session begins, and the start page opens, as quickly with many stored trials as with few",
          "[store][large]") {
  TemporaryFolder folder;
  const auto few = folder / "few.sqlite", many = folder / "many.sqlite";
  make_database(few, 3, 10);
  make_database(many, 3, 300);
  for (const auto& action : std::vector<std::function<void(const std::string&)>>{
           begin_session, [](const auto& db) { participants(db); },
           [](const auto& db) { interrupted_session(db); }}) {
    const auto small = steps_of([&] { action(few); }), large = steps_of([&] { action(many); });
    INFO(small << " and " << large);
    CHECK(large <= small + 5);
  }
}

TEST_CASE(
    "the cost per session of reading or copying a whole database does not grow with the number of sessions",
    "[store][large]") {
  TemporaryFolder folder;
  const auto few = folder / "few.sqlite", many = folder / "many.sqlite";
  constexpr int sessions = 30, times = 8;
  make_database(few, sessions, 2);
  make_database(many, times * sessions, 2);
  ExportOptions bids;
  bids.format = ExportFormat::bids;
  int run = 0;
  const std::vector<std::pair<const char*, std::function<void(const std::string&)>>> actions = {
      {"sessions", [](const auto& db) { list_sessions(db); }},
      {"verify", [](const auto& db) { verify(db); }},
      {"export", [&](const auto& db) { export_data(db, folder / ("csv" + std::to_string(++run)), {}); }},
      {"BIDS", [&](const auto& db) { export_data(db, folder / ("bids" + std::to_string(++run)), bids); }},
      {"backup",
       [&](const auto& db) {
         backup(db, {folder / ("backups" + std::to_string(++run)), 9});
       }},
      {"merge", [&](const auto& db) { merge(db + ".all", db); }},
      {"merge again", [&](const auto& db) { merge(db + ".all", db); }},
  };
  for (const auto& [name, action] : actions) {
    const auto small = steps_of([&] { action(few); }), large = steps_of([&] { action(many); });
    INFO(name << ": " << small << " and " << large);
    REQUIRE(small > 10);
    CHECK(static_cast<double>(large) < 1.3 * times * static_cast<double>(small));
  }
}

TEST_CASE(
    "damage far from where a session writes does not prevent a session, but backup, verify, export and merge "
    "detect it",
    "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", dir = folder / "backups";
  {
    auto log = SessionLog::begin(db, sample::start(), sample::segment());
    log.begin_block(sample::block());
    for (int i = 0; i < 200; ++i) {
      auto trial = sample::answered(i);
      if (i == 100) trial.procedure = "needle";
      log.append(trial);
    }
    log.finish(SessionStatus::completed, "");
  }
  const auto good = backup(db, {dir, 9});
  sample::session(db, 20, sample::start("P02"));
  auto bytes = sample::bytes_of(db);
  const auto page = bytes.find("needle") / 4096 * 4096;
  bytes.replace(page, 4096, 4096, '\0');
  std::ofstream(db, std::ios::binary) << bytes;

  CHECK(sample::session(db, 3, sample::start("P03")).size() == 36);
  CHECK(list_sessions(db).size() == 3);
  for (const auto& action :
       std::vector<std::function<void()>>{[&] {
                                            backup(db, {dir, 1});
                                          },
                                          [&] { verify(db); }, [&] { export_data(db, folder / "out", {}); },
                                          [&] { merge(folder / "b.sqlite", db); }})
    CHECK(sample::failure(action).first == ErrorKind::corrupt);
  CHECK(backups_in(dir, db) == std::vector<std::string>{good.path});
  CHECK_FALSE(fs::exists(folder / "out"));
  CHECK(restore_backup(db, {dir, ""}).trials == 200);
}

TEST_CASE("a database whose last trial has lost its block is refused before a session", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 5);
  sample::raw(db).execute("PRAGMA foreign_keys = OFF; DELETE FROM block");
  const auto [fault, message] = sample::failure([&] { begin_session(db); });
  CHECK(fault == ErrorKind::corrupt);
  CHECK(sample::contains(message, "block"));
}

TEST_CASE("a list of sessions leaves out the long texts, and a session that is read by its id includes them",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  const auto id = sample::session(db, 2, sample::start(), SessionStatus::interrupted);
  const auto listed = list_sessions(db).front();
  CHECK(listed.start.protocol_text.empty());
  CHECK(listed.start.rig_text.empty());
  CHECK(listed.start.protocol_sha256 == sample::start().protocol_sha256);
  CHECK(read_session(db, id).session.start.protocol_text == sample::start().protocol_text);
  CHECK(interrupted_session(db)->session.start.rig_text == sample::start().rig_text);
}

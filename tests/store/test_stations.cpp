#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "station/store/annotate.hpp"
#include "station/store/backup.hpp"
#include "station/store/export.hpp"
#include "station/store/merge.hpp"
#include "station/store/read.hpp"
#include "station/store/withdraw.hpp"
#include "station/terms/usage_error.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::store;

namespace {

SessionStart at_station(const std::string& participant, const std::string& station) {
  auto start = sample::start(participant);
  start.station_id = station;
  return start;
}

std::string trials_csv(const std::string& db, const std::string& out) {
  return sample::bytes_of(export_data(db, out, {})[0].path);
}

/// Returns the content of all files whose names begin with the name of the database, as one string.
std::string all_bytes(const std::string& db) {
  std::string all;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(db).parent_path()))
    if (entry.path().string().rfind(db, 0) == 0) all += sample::bytes_of(entry.path().string());
  return all;
}

}  // namespace

TEST_CASE("merging copies complete sessions of another station, and merging again changes nothing",
          "[store]") {
  TemporaryFolder folder;
  const auto a = folder / "a.sqlite", b = folder / "b.sqlite";
  sample::session(a, 5, at_station("P00", "a"));
  const auto id = sample::session(b, 7, at_station("P01", "b"));
  sample::session(b, 3, at_station("P02", "b"));
  annotate(b, id, "lights went out at trial 3");
  const auto report = merge(a, b);
  REQUIRE(report.sessions.size() == 2);
  CHECK(report.sessions[0].what == MergedSession::What::added);
  CHECK(report.sessions[0].trials == 7);
  CHECK(list_sessions(a).size() == 3);
  ExportOptions options;
  options.session_id = id;
  CHECK(sample::bytes_of(export_data(a, folder / "from-a", options)[0].path) ==
        sample::bytes_of(export_data(b, folder / "from-b", options)[0].path));
  CHECK(read_session(a, id).session.annotations.size() == 1);
  CHECK(sample::raw(a).text("PRAGMA integrity_check") == "ok");
  const auto before = trials_csv(a, folder / "one");
  const auto again = merge(a, b);
  for (const auto& session : again.sessions) CHECK(session.what == MergedSession::What::unchanged);
  CHECK(trials_csv(a, folder / "two") == before);
  CHECK(report.sessions[0].sha256 == again.sessions[0].sha256);
}

TEST_CASE("merging adds the new trials of a session that continued at its own station", "[store]") {
  TemporaryFolder folder;
  const auto a = folder / "a.sqlite", b = folder / "b.sqlite";
  const auto id = sample::session(b, 2, at_station("P01", "b"), SessionStatus::interrupted);
  CHECK(merge(a, b).sessions[0].what == MergedSession::What::added);
  {
    auto log = SessionLog::resume(b, id, sample::segment("resume"));
    log.begin_block(sample::block());
    log.append(sample::answered(2));
    log.finish(SessionStatus::completed, "");
  }
  const auto report = merge(a, b);
  CHECK(report.sessions[0].what == MergedSession::What::extended);
  CHECK(report.sessions[0].trials == 1);
  CHECK(read_session(a, id).session.status == SessionStatus::completed);
  CHECK(merge(b, a).sessions[0].what == MergedSession::What::unchanged);
}

TEST_CASE("merging refuses contradictory rows, says which they are, and changes nothing", "[store]") {
  TemporaryFolder folder;
  const auto a = folder / "a.sqlite", b = folder / "b.sqlite";
  const auto id = sample::session(b, 4, at_station("P01", "b"));
  merge(a, b);
  sample::session(b, 2, at_station("P02", "b"));
  const auto sessions_before = list_sessions(a).size();
  std::string expected;
  SECTION("a session that was continued on both stations") {
    for (const auto& db : {a, b}) {
      sample::raw(db).execute("UPDATE session SET status = 'interrupted' WHERE participant = 'P01'");
      auto log = SessionLog::resume(db, id, sample::segment("resume"));
      log.begin_block(sample::block());
      auto trial = sample::answered(4);
      trial.onset_ns += db == a ? 1 : 2;
      log.append(trial);
    }
    expected = "table trial, session_id " + id + ", trial_index 4: onset_ns is";
  }
  SECTION("two databases with the same station name") {
    std::filesystem::remove(a);
    sample::session(a, 1, at_station("P09", "b"));
    expected =
        "station b has given place 0 of protocol two-boundaries to P09 in this database and to P01 in the "
        "other";
  }
  const auto [fault, message] = sample::failure([&] { merge(a, b); });
  CHECK(fault == ErrorKind::conflict);
  INFO(message);
  CHECK(sample::contains(message, expected));
  CHECK(list_sessions(a).size() == sessions_before);
}

TEST_CASE("a backup can be merged unless its checksum is wrong, and a file is never merged with itself",
          "[store]") {
  TemporaryFolder folder;
  const auto a = folder / "a.sqlite", b = folder / "b.sqlite";
  sample::session(b, 4, at_station("P01", "b"));
  const auto made = backup(b, {folder / "backups", 3});
  CHECK(merge(a, made.path).sessions.size() == 1);
  std::ofstream(made.path, std::ios::app | std::ios::binary) << "x";
  const auto [fault, message] = sample::failure([&] { merge(a, made.path); });
  CHECK(fault == ErrorKind::corrupt);
  CHECK(sample::contains(message, "sha256"));
  CHECK(sample::failure([&] { merge(a, a); }).first == ErrorKind::refused);
}

TEST_CASE("a backup can be made during a session, is checked, and the oldest backups are removed",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", dir = folder / "backups";
  sample::session(db, 4);
  auto log = SessionLog::begin(db, sample::start("P02"), sample::segment());
  log.begin_block(sample::block());
  std::vector<BackupReport> made;
  for (int i = 0; i < 4; ++i) {
    log.append(sample::answered(i));
    made.push_back(backup(db, {dir, 2}));
    CHECK(made.back().trials == 5 + i);
    CHECK(made.back().sessions == 2);
  }
  const auto left = backups_in(dir, db);
  REQUIRE(left.size() == 2);
  CHECK(left[1] == made[3].path);
  CHECK(made[3].removed == std::vector<std::string>{made[1].path});
  CHECK_FALSE(std::filesystem::exists(made[0].path + ".sha256"));
  CHECK(list_sessions(left[1]).size() == 2);
  CHECK(sample::contains(sample::bytes_of(left[1] + ".sha256"), made[3].sha256));
}

TEST_CASE("a restore sets a damaged database aside and puts the newest good backup in its place", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", dir = folder / "backups";
  sample::session(db, 4);
  backup(db, {dir, 9});
  sample::session(db, 3, sample::start("P02"));
  const auto newest = backup(db, {dir, 9});
  // The database is undamaged, so a restore must be refused.
  CHECK(sample::failure([&] { restore_backup(db, {dir, ""}); }).first == ErrorKind::refused);
  auto bytes = sample::bytes_of(db);
  bytes.resize(6000);
  std::ofstream(db, std::ios::binary | std::ios::trunc) << bytes;
  bool newest_is_good = true;
  SECTION("the newest is good") {}
  SECTION("the newest is damaged too") {
    newest_is_good = false;
    std::filesystem::resize_file(newest.path, 5000);
  }
  const auto restored = restore_backup(db, {dir, ""});
  CHECK(restored.trials == (newest_is_good ? 7 : 4));
  CHECK(restored.rejected.size() == (newest_is_good ? 0 : 1));
  CHECK(sample::bytes_of(restored.quarantined) == bytes);
  CHECK(list_sessions(db).size() == (newest_is_good ? 2 : 1));
  CHECK(sample::session(db, 1).size() == 36);
}

namespace {

struct stat status_of(const std::string& path) {
  struct stat status {};
  REQUIRE(::stat(path.c_str(), &status) == 0);
  return status;
}

}  // namespace

TEST_CASE(
    "files that root makes in the station's folder belong to the station, and a backup keeps the database's "
    "permissions",
    "[store]") {
  if (::geteuid() != 0) {
    WARN("skipped: only root can try this; sudo tests/run");
    return;
  }
  TemporaryFolder folder;
  const auto home = folder / "home", db = home + "/a.sqlite", dir = folder / "backups";
  constexpr uid_t kStation = 65533;
  std::filesystem::create_directory(home);
  REQUIRE(::chown(home.c_str(), kStation, kStation) == 0);
  const auto is_stations = [&](const std::string& path) {
    CAPTURE(path);
    CHECK(status_of(path).st_uid == kStation);
    CHECK(status_of(path).st_gid == kStation);
  };
  sample::session(db, 4);
  is_stations(db);
  is_stations(db + ".lock");
  std::filesystem::permissions(db, std::filesystem::perms(0640));
  const auto copy = backup(db, {dir, 9});
  CHECK((status_of(copy.path).st_mode & 0777) == 0640);
  CHECK(status_of(copy.path).st_uid == 0);  // the backup belongs to root, as does its folder
  std::filesystem::remove(db + ".lock");
  std::filesystem::resize_file(db, 6000);
  restore_backup(db, {dir, ""});
  is_stations(db);
  is_stations(db + ".lock");
  CHECK((status_of(db).st_mode & 0777) == 0640);
}

TEST_CASE(
    "a database that root makes by a relative path belongs to the folder's owner, and a lock file keeps its "
    "owner",
    "[store]") {
  if (::geteuid() != 0) {
    WARN("skipped: only root can try this; sudo tests/run");
    return;
  }
  TemporaryFolder folder;
  constexpr uid_t kStation = 65533;
  REQUIRE(::chown(folder.path.c_str(), kStation, kStation) == 0);
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path);
  sample::session("a.sqlite", 1);
  std::filesystem::current_path(before);
  CHECK(status_of(folder / "a.sqlite").st_uid == kStation);
  CHECK(status_of(folder / "a.sqlite.lock").st_uid == kStation);
  REQUIRE(::chown(folder.path.c_str(), 0, 0) == 0);
  sample::session(folder / "a.sqlite", 1);
  CHECK(status_of(folder / "a.sqlite.lock").st_uid == kStation);
}

TEST_CASE("a link in place of the lock file is not followed", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", target = folder / "target";
  std::ofstream(target) << "precious";
  SECTION("a symbolic one") { std::filesystem::create_symlink(target, db + ".lock"); }
  SECTION("a second name") { std::filesystem::create_hard_link(target, db + ".lock"); }
  const auto [fault, message] = sample::failure([&] { sample::session(db, 1); });
  CHECK(fault == ErrorKind::io);
  CHECK(sample::contains(message, "a.sqlite.lock"));
  CHECK(sample::contains(message, "was not used; remove the"));
  CHECK(sample::bytes_of(target) == "precious");
}

TEST_CASE("a database file with a second hard link is refused under both names", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", other = folder / "b.sqlite";
  sample::session(db, 1);
  std::filesystem::create_hard_link(db, other);
  const auto before = sample::bytes_of(db);
  for (const auto& name : {db, other}) {
    const auto [fault, message] = sample::failure([&] { sample::session(name, 1); });
    CHECK(fault == ErrorKind::busy);
    CHECK(sample::contains(message, "has a second name"));
  }
  CHECK(sample::bytes_of(db) == before);
  std::filesystem::remove(other);
  sample::session(db, 1);
  CHECK(sample::bytes_of(db) != before);
}

TEST_CASE("a restore without a good backup moves nothing", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  std::ofstream(db, std::ios::binary) << "";
  CHECK(sample::failure([&] { restore_backup(db, {folder / "none", ""}); }).first == ErrorKind::missing);
  CHECK(std::filesystem::exists(db));
}

TEST_CASE("a withdrawal lists what it removes and leaves no trace in the database, its log or later backups",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  auto start = sample::start("XQ77ZK");
  start.observer = "sim:secret=QWERTZ";
  auto id = sample::session(db, 60, start);
  annotate(db, id, "told us about JKLMNO");
  sample::session(db, 5, sample::start("P02"));
  CHECK(sample::contains(all_bytes(db), "XQ77ZK"));  // negative control: the search finds text that is there
  const auto old_backup = backup(db, {folder / "backups", 9});
  const auto gone = withdraw(db, {"XQ77ZK", "", "", folder / "backups"});
  REQUIRE(gone.sessions.size() == 1);
  CHECK(gone.sessions[0].session_id == id);
  CHECK(gone.trials == 60);
  CHECK(gone.tones == 240);
  CHECK(gone.events == 120);
  CHECK(gone.annotations == 1);
  CHECK(gone.removed_copies == std::vector<std::string>{old_backup.path});
  const auto later = backup(db, {folder / "backups", 9});
  for (const auto& trace : {"XQ77ZK", "QWERTZ", "JKLMNO"}) {
    CHECK_FALSE(sample::contains(all_bytes(db), trace));
    CHECK_FALSE(sample::contains(sample::bytes_of(later.path), trace));
  }
  CHECK(list_sessions(db).size() == 1);
  CHECK(sample::raw(db).text("PRAGMA integrity_check") == "ok");
  CHECK(withdraw(db, {"XQ77ZK", "", "", ""}).sessions.empty());  // withdrawing a second time changes nothing
  CHECK(sample::failure([&] { withdraw(db, {"P99", "", "", ""}); }).first == ErrorKind::missing);
  CHECK(sample::failure([&] { sample::session(db, 1, start); }).first == ErrorKind::refused);
}

TEST_CASE("negative control: a plain DELETE leaves traces that the search finds", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  const auto id = sample::session(db, 60, sample::start("P01"));
  annotate(db, id, "told us about JKLMNO");
  sample::raw(db).execute("PRAGMA secure_delete = OFF; DELETE FROM annotation");
  CHECK(sample::contains(all_bytes(db), "JKLMNO"));
}

TEST_CASE("merging does not bring back withdrawn sessions, nor later sessions with the withdrawn code",
          "[store]") {
  TemporaryFolder folder;
  const auto a = folder / "a.sqlite", b = folder / "b.sqlite";
  sample::session(b, 4, at_station("P01", "b"));
  merge(a, b);
  withdraw(a, {"P01", "", "", ""});
  sample::session(b, 4, at_station("P01", "b"));
  sample::session(b, 2, at_station("P02", "b"));
  const auto report = merge(a, b);
  REQUIRE(report.sessions.size() == 3);
  CHECK(report.sessions[0].what == MergedSession::What::withdrawn);
  CHECK(report.sessions[1].what == MergedSession::What::withdrawn);
  CHECK(report.sessions[2].what == MergedSession::What::added);
  REQUIRE(list_sessions(a).size() == 1);
  CHECK_FALSE(sample::contains(all_bytes(a), "P01"));
  // station b still has one withdrawn session, and reports it
  CHECK(merge(b, a).withdrawn_there.size() == 1);
}

TEST_CASE("the next participant after a withdrawal gets the sequence index that became free", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  for (const auto* code : {"P01", "P02", "P03"}) sample::session(db, 1, sample::start(code));
  withdraw(db, {"P02", "", "", ""});
  const auto id = sample::session(db, 1, sample::start("P04"));
  CHECK(read_session(db, id).session.sequence_index == 1);
}

TEST_CASE("an interrupted session can be closed for good, but a completed one cannot", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  const auto open = sample::session(db, 2, sample::start(), SessionStatus::interrupted);
  const auto done = sample::session(db, 2);
  REQUIRE(interrupted_session(db));
  abandon(db, open, "too old");
  CHECK_FALSE(interrupted_session(db));
  CHECK(read_session(db, open).session.status_reason == "too old");
  CHECK(sample::failure([&] { abandon(db, done, ""); }).first == ErrorKind::refused);
  CHECK_THROWS_AS(annotate(db, done, ""), turnpoint::terms::UsageError);
}

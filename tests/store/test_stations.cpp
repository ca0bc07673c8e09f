#include <fmt/format.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "station/core/number.hpp"
#include "station/store/backup.hpp"
#include "station/store/backup_folder.hpp"
#include "station/store/export.hpp"
#include "station/store/merge.hpp"
#include "station/store/open.hpp"
#include "station/store/read.hpp"
#include "station/store/seal.hpp"
#include "station/store/session_log.hpp"
#include "station/store/station.hpp"
#include "station/store/verify.hpp"
#include "station/store/withdraw.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/number_from.hpp"

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
      auto raw = sample::raw(db);
      SealedTransaction change(raw);
      raw.execute("UPDATE session SET status = 'interrupted' WHERE participant = 'P01'");
      change.commit();
      auto log = SessionLog::resume(db, id, sample::segment("resume"));
      log.begin_block(sample::block());
      auto trial = sample::answered(4);
      trial.timing.onset_ns += db == a ? 1 : 2;
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

TEST_CASE("a withdrawal that arrives from elsewhere takes all sessions of the person, sent or not",
          "[store]") {
  TemporaryFolder folder;
  const auto a = folder / "a.sqlite", server = folder / "server.sqlite", dir = folder / "backups";
  sample::session(a, 3, at_station("P01", "a"));
  sample::session(a, 2, at_station("P02", "a"));
  merge(server, a);  // the server has the first sessions only
  sample::session(a, 1, at_station("P01", "a"),
                  GENERATE(SessionStatus::completed, SessionStatus::interrupted));
  { auto died = SessionLog::begin(a, at_station("P01", "a"), sample::segment()); }
  sample::session(a, 4, at_station("P01", "b"));  // another person, at another station
  backup(a, {dir, 9});
  withdraw(server, {"P01", "a", "", ""});
  auto elsewhere = sample::raw(server);
  const auto stones = list_tombstones(elsewhere);
  const auto gone = follow_tombstones(a, stones, dir);
  CHECK(gone.sessions.size() == 3);
  CHECK(gone.bearers == std::vector<Bearer>{{"a", "P01"}});
  CHECK(gone.removed_copies.size() == 1);
  CHECK(verify(a).good());
  CHECK(list_sessions(a).size() == 2);
  CHECK_FALSE(interrupted_session(a));
  CHECK(sample::failure([&] { sample::session(a, 1, at_station("P01", "a")); }).first == ErrorKind::refused);
  CHECK(follow_tombstones(a, stones).sessions.empty());
  CHECK(sample::raw(a).integer("SELECT count(*) FROM tombstone") == 3);
}

TEST_CASE("a withdrawal that was interrupted is completed once its folder of backups is given", "[store]") {
  TemporaryFolder folder;
  const auto a = folder / "a.sqlite", dir = folder / "backups";
  sample::session(a, 3, at_station("P01", "a"));
  const auto kept = sample::session(a, 2, at_station("P02", "a"));
  backup(a, {dir, 9});
  withdraw(a, {"P01", "a", "", ""});
  auto reader = sample::raw(a);
  const auto stones = list_tombstones(reader);
  {  // as if the backups had not been reached
    auto writer = open_writer(a, IfMissing::fail);
    SealedTransaction transaction(writer.database);
    Statement(writer.database, "INSERT INTO meta VALUES ('erasing', ?)").bind(dir).run();
    transaction.commit();
  }
  const auto unfinished = [&] {
    return sample::raw(a).integer("SELECT count(*) FROM meta WHERE key = 'erasing'") == 1;
  };
  CHECK(follow_tombstones(a, stones).removed_copies.empty());
  CHECK(unfinished());
  CHECK(follow_tombstones(a, stones, dir).removed_copies.size() == 1);
  CHECK_FALSE(unfinished());
  CHECK(follow_tombstones(a, stones, dir).removed_copies.empty());
  CHECK(verify(a).good());
  CHECK(backups_in(dir, a).size() == 1);
  CHECK(list_sessions(a).front().session_id == kept);
}

TEST_CASE("a tombstone that names another station or another person than its session deletes nothing",
          "[store]") {
  TemporaryFolder folder;
  const auto a = folder / "a.sqlite";
  const auto id = sample::session(a, 3, at_station("P01", "a"));
  const auto hash = [](const std::string& code) { return turnpoint::core::sha256("salt/" + code); };
  CHECK(follow_tombstones(a, {{id, "salt", hash("P01"), 1, "b"}}).sessions.empty());
  CHECK(follow_tombstones(a, {{id, "salt", hash("P02"), 1, "a"}}).sessions.empty());
  CHECK(follow_tombstones(a, {{id, "salt", "", 1, "b"}}).sessions.empty());
  CHECK(list_sessions(a).size() == 1);
  CHECK(sample::raw(a).integer("SELECT count(*) FROM tombstone") == 0);
  CHECK(verify(a).good());
  CHECK(follow_tombstones(a, {{id, "salt", "", 1, "a"}}).sessions.size() == 1);
  CHECK(sample::raw(a).integer("SELECT count(*) FROM enrolment") == 1);  // the code stays in use
}

TEST_CASE("a code whose sessions were withdrawn one by one can still be withdrawn", "[store]") {
  TemporaryFolder folder;
  const auto a = folder / "a.sqlite";
  const auto id = sample::session(a, 1, at_station("P01", "a"));
  withdraw(a, {"P01", "", id, ""});
  CHECK(sample::raw(a).integer("SELECT count(*) FROM enrolment") == 1);
  withdraw(a, {"P01", "", "", ""});
  CHECK(sample::raw(a).integer("SELECT count(*) FROM participant") == 0);
  CHECK(verify(a).good());
}

namespace {

/// Makes a finished session at a station on a machine.
std::string recorded(const std::string& db, const std::string& participant, const std::string& station,
                     const std::string& machine) {
  auto segment = sample::segment();
  segment.machine = machine;
  auto log = SessionLog::begin(db, at_station(participant, station), segment);
  log.begin_block(sample::block());
  log.append(sample::answered(0));
  log.finish(SessionStatus::completed, "");
  return log.session().session_id;
}

}  // namespace

namespace {

/// The files by which a machine is known, as every user sees them.
struct Machine {
  TemporaryFolder folder;
  const std::string board = "sys/firmware/devicetree/base/serial-number",
                    uuid = "sys/class/dmi/id/product_uuid", serial = "sys/class/dmi/id/board_serial";

  explicit Machine(const std::string& machine_id = "4c1d0f5b7e2a49c38d6e90b1a7f35c28\n") {
    if (!machine_id.empty()) write("etc/machine-id", machine_id);
  }
  std::filesystem::path write(const std::string& path, const std::string& text) const {
    const auto name = std::filesystem::path(folder / path);
    std::filesystem::create_directories(name.parent_path());
    std::ofstream(name) << text;
    std::filesystem::permissions(name, std::filesystem::perms(0444));
    return name;
  }
  std::string identity() const { return machine_identity(folder.path); }
};

}  // namespace

TEST_CASE("a machine is known by its machine-id and its board, and an image's name gets a part of that",
          "[store]") {
  CHECK(Machine("").identity().empty());
  const Machine machine;
  const auto of_card = machine.identity();
  const auto uuid = machine.write(machine.uuid, "8f1b0a6c-52d3-4e79-9c04-b7e1a2d63f58\n");
  std::filesystem::permissions(uuid, std::filesystem::perms::owner_read);
  CHECK(machine.identity() == of_card);  // it must not depend on who asks
  std::filesystem::permissions(uuid, std::filesystem::perms::others_read, std::filesystem::perm_options::add);
  const auto of_pc = machine.identity();
  CHECK(of_pc != of_card);
  machine.write(machine.board, std::string("100000008a7d41f3\0", 17));
  const auto of_board = machine.identity();
  CHECK(of_board != of_pc);
  CHECK(of_board.size() == 64);
  CHECK(machine_traits(machine.folder.path).hardware == "100000008a7d41f3");
  machine.write("etc/turnpoint/station", "lab-3\n");
  CHECK(suggested_station_name(machine.folder.path) == "lab-3");
}

TEST_CASE("what a maker never set does not make two machines one", "[store]") {
  const auto plain = Machine().identity();
  const auto with = [](const std::string& which, const std::string& value) {
    const Machine machine;
    machine.write(which, value);
    return machine.identity();
  };
  const Machine names;
  for (const auto* shared :
       {"00000000-0000-0000-0000-000000000000\n", "FFFFFFFF-FFFF-FFFF-FFFF-FFFFFFFFFFFF\n",
        "ffffffff-ffff-ffff-ffff-ffffffffffff\n", "03000200-0400-0500-0006-000700080009\n",
        "00020003-0004-0005-0006-000700080009\n", "12345678-1234-5678-90AB-CDDEEFAABBCC\n",
        "12345678-1234-1234-1234-123456789012\n", "11111111-2222-3333-4444-555555555555\n",
        "00112233-4455-6677-8899-AABBCCDDEEFF\n", "FEFEFEFE-FEFE-FEFE-FEFE-FEFEFEFEFEFE\n",
        "4C4C4544-0000-2010-8020-80C04F202020\n", "Not Settable\n", "Not Present\n", "\n", "   \n"}) {
    INFO(shared);
    CHECK(with(names.uuid, shared) == plain);
    CHECK(with(names.serial, shared) == plain);
  }
  for (const auto* shared : {"Default string\n",
                             "Default string 1\n",
                             "To be filled by O.E.M.\n",
                             "To Be Filled By O.E.M. 01\n",
                             "None\n",
                             "N/A\n",
                             "0\n",
                             "0000000000000000",
                             "0123456789\n",
                             "123456789\n",
                             "1234567890\n",
                             "0123456789ABCDEF",
                             "fedcba9876543210",
                             "xxxxxxxxxxxx\n",
                             "............\n",
                             "SN123456789\n",
                             "System Serial Number\n",
                             "Type2 - Board Serial Number\n",
                             "Base Board Serial Number\n",
                             "Not Specified\n",
                             "Not Applicable\n",
                             "INVALID\n",
                             "OEM\n",
                             "empty\n",
                             "Unknown\n"}) {
    INFO(shared);
    CHECK(with(names.board, shared) == plain);
    CHECK(with(names.serial, shared) == plain);
  }
  // Without a machine-id as well, nothing is known, instead of one identity for all of them.
  for (const auto* which : {&names.board, &names.uuid, &names.serial}) {
    const Machine bare("");
    bare.write(*which, "Default string\n");
    CHECK(bare.identity().empty());
  }
  // The next number counts if the first one is not one.
  const Machine machine;
  machine.write(machine.uuid, "03000200-0400-0500-0006-000700080009\n");
  machine.write(machine.serial, "BSS-0123-X7421\n");
  CHECK(machine_traits(machine.folder.path).hardware == "BSS-0123-X7421");
}

TEST_CASE("numbers that makers give to one board each count", "[store]") {
  std::set<std::string> identities;
  const std::vector<std::string> given{"100000008a7d41f3",
                                       "00000000b3f0e1a2",
                                       "1000000010a0305c",
                                       "10000000deadbeef",
                                       "c3d9b8674f4b94f6",
                                       "/6XKJ9Y2/CN7220059N00A1/",
                                       "PF2ZKQ7M",
                                       "L1HF65E00X9",
                                       "VMware-56 4d 1a 2b 8c 07 f1 3e-a4 5b 6c 90 11 d2 3e 4f",
                                       "5CG8234TQX",
                                       "GEBN12400BCX",
                                       "4C4C4544-0051-3510-8056-B7C04F4D4832",
                                       "00000000-0000-0000-0000-AC1F6B8D42E0",
                                       "EC2E1916-9099-7CAF-FD21-012345ABCDEF"};
  for (const auto& number : given) {
    const Machine machine;
    machine.write(machine.board, number);
    INFO(number);
    CHECK(machine_traits(machine.folder.path).hardware == number);
    identities.insert(machine.identity());
  }
  CHECK(identities.size() == given.size());
  // Virtual machines that share a UUID differ in the machine-id.
  const Machine one, two("9be07a3c5d1f42e68a0c7b94f2d35e61\n");
  for (const auto* machine : {&one, &two}) machine->write(machine->uuid, given[11] + "\n");
  CHECK(one.identity() != two.identity());
  // Of random numbers, none is taken for what nobody set.
  std::mt19937_64 random(11);
  const Machine machine;
  int lost = 0;
  for (int k = 0; k < 2000; ++k) {
    std::filesystem::remove(machine.folder / machine.board);
    machine.write(machine.board, fmt::format("10000000{:08x}", static_cast<std::uint32_t>(random())));
    lost += machine_traits(machine.folder.path).hardware.empty() ? 1 : 0;
  }
  CHECK(lost == 0);
}

TEST_CASE("a copied disk in a computer whose maker set no number is known by its own number", "[store]") {
  const auto with = [&](const std::string& file, const std::string& number) {
    const Machine machine;
    machine.write(machine.uuid, "03000200-0400-0500-0006-000700080009\n");
    const auto disk = machine.folder / "sys/devices/mmcblk0", blocks = machine.folder / "sys/dev/block";
    std::filesystem::create_directories(disk + "/mmcblk0p2");
    std::filesystem::create_directories(blocks);
    machine.write("sys/devices/mmcblk0/mmcblk0p2/partition", "2\n");
    machine.write("sys/devices/mmcblk0/" + file, number + "\n");
    const auto number_of_device = status_of(machine.folder / "etc").st_dev;
    std::filesystem::create_symlink(
        disk + "/mmcblk0p2",
        blocks + fmt::format("/{}:{}", major(number_of_device), minor(number_of_device)));
    const auto alone = machine.identity();
    machine.write(machine.serial, "BSS-0123-X7421\n");  // a number of the board comes before that of the disk
    CHECK(machine_traits(machine.folder.path).hardware == "BSS-0123-X7421");
    return alone;
  };
  const auto plain = Machine().identity();
  std::set<std::string> identities{plain};
  for (const auto* number : {"035344534836344780b1f0c2a4015a00", "035344534836344780b1f0c2a5015a00"})
    identities.insert(with("device/cid", number));
  identities.insert(with("wwid", "eui.0025385b21404f7a"));
  identities.insert(
      with("device/wwid", "t10.ATA     Samsung SSD 860 EVO 250GB               S3YJNB0K512345X"));
  CHECK(identities.size() == 5);
  CHECK(with("serial", "00000000000000000000") == plain);
}

TEST_CASE("a machine-id that the next boot replaces is no identity", "[store]") {
  const std::string serial = "100000008a7d41f3";
  const Machine board("");
  board.write(board.board, serial);
  const auto of_board = board.identity();
  CHECK_FALSE(of_board.empty());
  for (const auto* transient :
       {"\n", " \n", "uninitialized\n", "00000000000000000000000000000000\n",
        "ffffffffffffffffffffffffffffffff\n", "4c1d\n", "0123456789abcdef0123456789abcdef\n"}) {
    INFO(transient);
    const Machine machine(transient);
    CHECK(machine.identity().empty());
    machine.write(machine.board, serial);
    CHECK(machine.identity() == of_board);  // known by the board alone, and the same at each boot
  }
  const Machine hidden;
  std::filesystem::permissions(hidden.folder / "etc/machine-id", std::filesystem::perms::owner_read);
  CHECK(hidden.identity().empty());
}

TEST_CASE("a machine-id that systemd has mounted from memory is no identity", "[store]") {
  const Machine machine;
  const auto lasting = machine.identity();
  const auto run = machine.folder / "run", id = machine.folder / "etc/machine-id";
  std::filesystem::create_directory(run);
  if (::mount("tmpfs", run.c_str(), "tmpfs", 0, nullptr) != 0) {
    WARN("skipped: only root can mount; sudo tests/run");
    return;
  }
  machine.write("run/machine-id", "9be07a3c5d1f42e68a0c7b94f2d35e61\n");
  REQUIRE(::mount((run + "/machine-id").c_str(), id.c_str(), nullptr, MS_BIND, nullptr) == 0);
  CHECK(machine.identity().empty());
  ::umount2(id.c_str(), MNT_DETACH);
  CHECK(machine.identity() == lasting);  // once systemd has written it to the disk, it counts
  ::umount2(run.c_str(), MNT_DETACH);
}

TEST_CASE("a machine-id that an overlay keeps in memory is no identity, and one on a disk is", "[store]") {
  const Machine first, second("9be07a3c5d1f42e68a0c7b94f2d35e61\n"), machine;
  const auto etc = machine.folder / "etc";
  std::string disk = "/var/tmp/turnpoint-test-XXXXXX";  // not where other tests write, which may be memory
  REQUIRE(::mkdtemp(disk.data()) != nullptr);
  const auto memory = disk + "/memory", lower = disk + "/lower";
  for (const auto& name : {memory, lower}) std::filesystem::create_directory(name);
  std::filesystem::copy_file(first.folder / "etc/machine-id", lower + "/machine-id");
  if (::mount("tmpfs", memory.c_str(), "tmpfs", 0, nullptr) != 0) {
    WARN("skipped: only root can mount; sudo tests/run");
    std::filesystem::remove_all(disk);
    return;
  }
  for (const auto& [upper, lasts] : {std::pair{memory, false}, {disk, true}})
    for (const auto* inodes : {"", ",xino=on"}) {  // without the option, each layer has numbers of its own
      INFO(upper << inodes);
      for (const auto* name : {"/changes", "/work"}) {
        std::filesystem::remove_all(upper + name);
        std::filesystem::create_directory(upper + name);
      }
      const auto layers =
          fmt::format("lowerdir={},upperdir={}/changes,workdir={}/work{}", lower, upper, upper, inodes);
      REQUIRE(::mount("overlay", etc.c_str(), "overlay", 0, layers.c_str()) == 0);
      CHECK(machine.identity() == first.identity());  // that of the lower layer, which the next boot has too
      std::filesystem::remove(etc + "/machine-id");
      machine.write("etc/machine-id", "9be07a3c5d1f42e68a0c7b94f2d35e61\n");
      CHECK(machine.identity() == (lasts ? second.identity() : ""));
      ::umount2(etc.c_str(), MNT_DETACH);
    }
  ::umount2(memory.c_str(), MNT_DETACH);
  std::filesystem::remove_all(disk);
}

TEST_CASE("a database keeps the name of its station, whatever the host is called", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  CHECK(station_name(db) == suggested_station_name());
  recorded(db, "P01", "lab-1", "board-1");
  CHECK(station_name(db) == "lab-1");
  CHECK(read_station(db).machine == "board-1");
  CHECK(verify(db).good());
}

TEST_CASE("a copied card is noticed, and becomes a station of its own when it is named", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", copy = folder / "copy.sqlite", hub = folder / "hub.sqlite";
  const auto first = recorded(db, "P01", "lab", "board-1");
  sample::raw(db).execute("PRAGMA wal_checkpoint(TRUNCATE)");
  std::filesystem::copy_file(db, copy);
  const auto [kind, message] = sample::failure([&] { recorded(copy, "P02", "lab", "board-2"); });
  CHECK(kind == ErrorKind::other_machine);
  CHECK(sample::contains(message, "if this is a copy"));
  CHECK(sample::contains(message, "--moved"));
  CHECK(sample::failure([&] { name_station(copy, {}, "board-2"); }).first == ErrorKind::other_machine);
  CHECK(sample::failure([&] { name_station(copy, {"lab"}, "board-2"); }).first == ErrorKind::refused);
  CHECK(sample::failure([&] { name_station(copy, {"no name"}, "board-2"); }).first == ErrorKind::refused);
  const auto named = name_station(copy, {"lab-2"}, "board-2");
  CHECK(named.is_new_identity);
  CHECK(named.database_id != read_station(db).database_id);
  recorded(copy, "P02", station_name(copy), "board-2");
  recorded(db, "P02", station_name(db), "board-1");
  merge(hub, db);
  merge(hub, copy);
  CHECK(list_sessions(hub).size() == 3);
  CHECK(list_sessions(hub, {"", "P02@lab-2", ""}).size() == 1);
  for (const auto& path : {db, copy, hub}) CHECK(verify(path).good());
}

namespace {

/// Makes a backup as another machine would make it.
std::string backup_of_other_machine(const std::string& db, const std::string& dir, int keep) {
  const auto made = backup(db, {dir, keep}).path;
  auto raw = sample::raw(made);
  raw.execute("PRAGMA journal_mode = DELETE");
  SealedTransaction change(raw);
  raw.execute("UPDATE meta SET value = 'board-2' WHERE key = 'backup_machine'");
  change.commit();
  std::filesystem::remove(made + ".sha256");
  return made;
}

}  // namespace

TEST_CASE("two copies of one database share a folder of backups, and neither loses or gets the other's",
          "[store]") {
  if (machine_identity().empty()) {
    WARN("skipped: this machine has no identity");
    return;
  }
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", copy = folder / "copy/a.sqlite", dir = folder / "backups";
  recorded(db, "P01", "lab", machine_identity());
  const auto own = backup(db, {dir, 9}).path;
  sample::raw(db).execute("PRAGMA wal_checkpoint(TRUNCATE)");
  std::filesystem::create_directory(folder / "copy");
  std::filesystem::copy_file(db, copy);
  sample::session(copy, 2, at_station("P02", "lab"));
  const auto foreign = backup_of_other_machine(copy, dir, 9);
  const auto newer = backup(db, {dir, 1}).path;  // removes its own first one, and not the other's
  CHECK_FALSE(std::filesystem::exists(own));
  CHECK(std::filesystem::exists(foreign));
  std::filesystem::resize_file(db, 6000);
  SECTION("a restore takes its own, although the other's is newer") {
    const auto newest = backup_of_other_machine(copy, dir, 9);
    const auto restored = restore_backup(db, {dir, ""});
    CHECK(restored.sessions == 1);
    CHECK(std::filesystem::exists(newest));
  }
  SECTION("a restore asks if there are only the other's") {
    remove_backup(newer);
    const auto [kind, message] = sample::failure([&] { restore_backup(db, {dir, ""}); });
    CHECK(kind == ErrorKind::other_machine);
    CHECK(sample::contains(message, "of station lab: " + foreign));
    CHECK(sample::contains(message, "if this machine replaces that one, add --moved"));
    CHECK(std::filesystem::file_size(db) == 6000);
    RestoreOptions moved{dir, ""};
    moved.whose = Whose::moved;
    CHECK(restore_backup(db, moved).sessions == 2);
    CHECK(read_station(db).machine == machine_identity());
  }
}

TEST_CASE("a replaced board goes on as the same station when somebody has said so", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", hub = folder / "hub.sqlite";
  recorded(db, "P01", "lab", "board-1");
  merge(hub, db);
  StationName moved;
  moved.whose = Whose::moved;
  const auto named = name_station(db, moved, "board-2");
  CHECK(named.name == "lab");
  CHECK_FALSE(named.is_new_identity);
  recorded(db, "P01", "lab", "board-2");
  merge(hub, db);
  CHECK(list_sessions(hub, {"", "P01", ""}).size() == 2);
  CHECK(verify(db).good());
}

TEST_CASE("two machines with one name are not merged until one of them has another, which exports outlive",
          "[store]") {
  TemporaryFolder folder;
  const auto a = folder / "a.sqlite", b = folder / "b.sqlite", hub = folder / "hub.sqlite";
  recorded(a, "P01", "turnpoint", "board-1");
  recorded(b, "P01", "turnpoint", "board-2");
  export_data(b, folder / "out", {});
  const auto csv = folder / "out/two-boundaries/sessions.csv";
  merge(hub, a);
  const auto [kind, message] = sample::failure([&] { merge(hub, b); });
  CHECK(kind == ErrorKind::conflict);
  CHECK(sample::contains(message, "two machines have recorded as station turnpoint"));
  StationName how{"lab-2"};
  how.stored_sessions = true;
  CHECK(name_station(b, how, "board-2").sessions == 1);
  CHECK(verify(b, {"", csv}).good());
  merge(hub, b);
  CHECK(list_sessions(hub, {"", "P01@lab-2", ""}).size() == 1);
  CHECK(verify(hub, {"", csv}).good());
  // Nobody is exempt: rows that differ do not give the earlier checksum, even with a new chain.
  auto raw = sample::raw(b);
  raw.execute(
      "DROP TRIGGER trial_is_never_changed; DROP TRIGGER link_is_never_changed; UPDATE trial SET level = 3");
  const auto id = list_sessions(raw)[0].session_id;
  CHECK_FALSE(verify_session(raw, id).problems.empty());
  renew_links(raw, id);
  CHECK(verify_session(raw, id).problems.empty());
  CHECK_FALSE(verify(b, {"", csv}).sessions[0].problems.empty());
}

TEST_CASE("under a new name, a station's participants stay the same people", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  recorded(db, "P01", "lab", "board-1");
  name_station(db, {"attic"}, "board-1");
  recorded(db, "P01", station_name(db), "board-1");
  const auto sessions = list_sessions(db, {"", "P01", ""});
  REQUIRE(sessions.size() == 2);
  CHECK(sessions[1].session_index == 2);
  CHECK(sessions[1].sequence_index == sessions[0].sequence_index);
  CHECK(verify(db).good());
}

namespace {

/// A station, its backups, and a second database that stands for the collector: it gets the station's
/// sessions, and each of the two follows the withdrawals of the other.
struct Room {
  TemporaryFolder folder;
  std::string station = folder / "station.sqlite", server = folder / "server.sqlite",
              backups = folder / "backups";
  std::set<std::string> staying;  ///< sessions of the participant who stays
  bool withdrawn = false;

  Room() {
    std::filesystem::create_directory(backups);
    staying.insert(recorded(station, "P02", "a", ""));
    send();
  }

  void send() { merge(server, station); }

  static void follow(const std::string& there, const std::string& here, const std::string& backups) {
    auto reader = sample::raw(there);
    follow_tombstones(here, list_tombstones(reader), backups);
  }

  void withdraw_at(const std::string& database) {
    withdraw(database, {"P01", "a", "", database == station ? backups : ""});
    withdrawn = true;
  }

  void step(int which) {
    if (which == 0) recorded(station, "P01", "a", "");
    if (which == 1) staying.insert(recorded(station, "P02", "a", ""));
    if (which == 2) sample::session(station, 1, at_station("P01", "a"), SessionStatus::interrupted);
    if (which == 3) send();
    if (which == 4) withdraw_at(server);
    if (which == 5) withdraw_at(station);
    if (which == 6) follow(server, station, backups);
    if (which == 7) follow(station, server, "");
    if (which == 8) backup(station, {backups, 0});
  }

  /// Returns the ids of a participant's sessions.
  static std::set<std::string> sessions(const std::string& database, const std::string& code) {
    std::set<std::string> ids;
    for (const auto& session : list_sessions(database))
      if (session.start.participant == code) ids.insert(session.session_id);
    return ids;
  }
};

}  // namespace

TEST_CASE("in whatever order things happen, withdrawn is withdrawn, and nothing else is", "[store]") {
  const int runs = number_from("TURNPOINT_INTERLEAVINGS", 20);
  std::mt19937 random(20261128);
  int withdrawals = 0;
  for (int run = 0; run < runs; ++run) {
    Room room;
    std::string steps;
    for (int i = 0; i < 8; ++i) {
      const int which = static_cast<int>(random() % 9);
      steps += std::to_string(which) + " ";
      try {
        room.step(which);
      } catch (const StoreError& error) {
        // a withdrawn code is refused, and a participant whom the database has never had cannot withdraw
        CHECK((error.kind() == ErrorKind::refused || error.kind() == ErrorKind::missing));
      }
    }
    INFO(steps);
    Room::follow(room.server, room.station, room.backups);
    room.send();
    Room::follow(room.station, room.server, "");
    Room::follow(room.server, room.station, room.backups);
    for (const auto& database : {room.station, room.server}) {
      CHECK(verify(database).good());
      CHECK(Room::sessions(database, "P02") == room.staying);
      if (room.withdrawn) CHECK(Room::sessions(database, "P01").empty());
    }
    CHECK(Room::sessions(room.station, "P01") == Room::sessions(room.server, "P01"));
    if (room.withdrawn)
      for (const auto& path : backups_in(room.backups, room.station))
        CHECK(Room::sessions(path, "P01").empty());
    withdrawals += room.withdrawn ? 1 : 0;
  }
  CHECK(withdrawals > runs / 4);
}

// Tests of backing up, restoring and withdrawing: which files belong to which database, and which files may
// be replaced.
#include <sys/wait.h>
#include <unistd.h>

#include "station/store/backup.hpp"
#include "station/store/export.hpp"
#include "station/store/merge.hpp"
#include "station/store/people.hpp"
#include "station/store/read.hpp"
#include "station/store/withdraw.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::store;
namespace fs = std::filesystem;

namespace {

SessionStart at_station(const std::string& participant, const std::string& station) {
  auto start = sample::start(participant);
  start.station_id = station;
  return start;
}

/// Leaves the files that a killed session leaves: the database, and a write-ahead log that contains some of
/// its pages.
void leave_log(const std::string& db) {
  auto raw = sample::raw(db);
  raw.execute("CREATE TABLE filler (a); INSERT INTO filler SELECT randomblob(9000) FROM event");
  fs::copy_file(db + "-wal", db + "-kept");
}

void damage(const std::string& db) { fs::resize_file(db, 6000); }

/// Renames a backup as if a computer had made it whose clock is years ahead.
void postdate(const std::string& backup) {
  const auto at = backup.rfind("-20");
  REQUIRE(at != std::string::npos);
  auto later = backup;
  later.replace(at + 1, 4, "2099");
  fs::rename(backup, later);
}

}  // namespace

TEST_CASE("neither a new nor a restored database uses the write-ahead log of a lost one", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", dir = folder / "backups";
  sample::session(db, 4);
  backup(db, {dir, 9});
  leave_log(db);
  fs::remove(db);
  fs::rename(db + "-kept", db + "-wal");
  const auto log = sample::bytes_of(db + "-wal");
  REQUIRE(log.size() > 10000);
  const auto [fault, message] = sample::failure([&] { sample::session(db, 1); });
  CHECK(fault == ErrorKind::missing);
  CHECK(sample::contains(message, "a.sqlite-wal is there"));
  CHECK_FALSE(fs::exists(db));
  CHECK(sample::bytes_of(db + "-wal") == log);
  const auto restored = restore_backup(db, {dir, ""});
  CHECK(restored.trials == 4);
  CHECK(sample::bytes_of(restored.quarantined + "-wal") == log);
  CHECK(list_sessions(db).size() == 1);
  CHECK(sample::session(db, 1).size() == 36);
  CHECK(sample::raw(db).text("PRAGMA integrity_check") == "ok");
}

TEST_CASE(
    "a restore interrupted between its two renames can be continued, and until then no new database is made",
    "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", dir = folder / "backups";
  sample::session(db, 4);
  backup(db, {dir, 9});
  fs::rename(db, db + ".restored");  // the state between the two renames of a restore
  CHECK(sample::failure([&] { sample::session(db, 1); }).first == ErrorKind::missing);
  CHECK(restore_backup(db, {dir, ""}).trials == 4);
  CHECK_FALSE(fs::exists(db + ".restored"));
}

TEST_CASE("a restore does not replace an intact database that cannot be opened", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", dir = folder / "backups";
  sample::session(db, 4);
  backup(db, {dir, 9});
  sample::session(db, 3);
  const auto before = sample::bytes_of(db);
  if (::geteuid() != 0) {
    fs::permissions(db, fs::perms::none);
    CHECK_THROWS_AS(restore_backup(db, {dir, ""}), StoreError);
    return;
  }
  // Root can read every file, so the test runs in a child process of another user, who owns the folder but
  // may not read the file.
  fs::permissions(folder.path, fs::perms::all);
  fs::permissions(dir, fs::perms::all);
  for (const auto& entry : fs::directory_iterator(folder.path))
    if (entry.is_regular_file())
      fs::permissions(entry.path(), fs::perms::owner_read | fs::perms::owner_write);
  for (const auto& entry : fs::directory_iterator(dir)) fs::permissions(entry.path(), fs::perms::all);
  fs::remove(db + ".lock");
  const auto child = ::fork();
  if (child == 0) {
    int status = 3;
    if (::setuid(65534) == 0) {
      const auto [fault, message] = sample::failure([&] { restore_backup(db, {dir, ""}); });
      status = fault == ErrorKind::cannot_open && sample::contains(message, "permissions") ? 0 : 1;
    }
    ::_exit(status);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  CHECK(WEXITSTATUS(status) == 0);
  CHECK(sample::bytes_of(db) == before);
}

TEST_CASE("databases with equal names, or names that begin alike, keep separate backups", "[store]") {
  TemporaryFolder folder;
  const auto dir = folder / "backups";
  fs::create_directory(folder / "other");
  const auto lab = folder / "lab.sqlite", longer = folder / "lab-b.sqlite",
             same = folder / "other/lab.sqlite";
  sample::session(lab, 1);
  sample::session(longer, 2);
  sample::session(same, 3);
  const auto first = backup(lab, {dir, 2});
  for (const auto& db : {longer, same, longer, same}) CHECK(backup(db, {dir, 2}).removed.empty());
  const auto second = backup(lab, {dir, 2});
  CHECK(second.removed.empty());
  CHECK(backups_in(dir, lab) == std::vector<std::string>{first.path, second.path});
  CHECK(backup(lab, {dir, 1}).removed == std::vector<std::string>{first.path, second.path});
  for (const auto& [db, trials] : {std::pair(lab, 1), std::pair(longer, 2), std::pair(same, 3)}) {
    damage(db);
    CHECK(restore_backup(db, {dir, ""}).trials == trials);
  }
}

TEST_CASE("if nothing tells the id of a lost database, a restore does not guess which backups are its own",
          "[store]") {
  TemporaryFolder folder;
  const auto dir = folder / "backups";
  fs::create_directory(folder / "other");
  const auto lab = folder / "lab.sqlite", same = folder / "other/lab.sqlite";
  sample::session(lab, 1);
  sample::session(same, 3);
  backup(lab, {dir, 2});
  const auto id = sample::raw(lab).text("SELECT value FROM meta WHERE key = 'database_id'");
  backup(same, {dir, 2});
  fs::remove(lab);
  SECTION("its lock file tells") { CHECK(restore_backup(lab, {dir, ""}).trials == 1); }
  SECTION("nothing tells") {
    fs::remove(lab + ".lock");
    const auto [fault, message] = sample::failure([&] { restore_backup(lab, {dir, ""}); });
    CHECK(fault == ErrorKind::conflict);
    CHECK(sample::contains(message, id));
    CHECK(sample::contains(message, "--database-id"));
    CHECK(restore_backup(lab, {dir, id}).trials == 1);
  }
}

TEST_CASE("backups are numbered, so that a clock that was ahead does not cause the loss of new backups",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", dir = folder / "backups";
  sample::session(db, 1);
  for (int i = 0; i < 3; ++i) postdate(backup(db, {dir, 3}).path);
  sample::session(db, 2, sample::start("P02"));
  const auto made = backup(db, {dir, 3});
  CHECK(made.number == 4);  // backups 1 to 3 have later dates, but lower numbers
  CHECK(made.removed.size() == 1);
  CHECK(fs::exists(made.path));
  damage(db);
  const auto restored = restore_backup(db, {dir, ""});
  CHECK(restored.from == made.path);
  CHECK(restored.trials == 3);
}

TEST_CASE("a backup that keeps only one copy keeps the one that was just made", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", dir = folder / "backups";
  sample::session(db, 1);
  const auto first = backup(db, {dir, 1});
  const auto second = backup(db, {dir, 1});
  CHECK_FALSE(fs::exists(first.path));
  CHECK(fs::exists(second.path));
}

TEST_CASE("a restore names the sessions whose rows were changed before the backup was made", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", dir = folder / "backups";
  sample::session(db, 4);
  const auto changed = sample::session(db, 3, sample::start("P02"));
  const bool edited = GENERATE(false, true);
  if (edited)
    sample::raw(db).execute(
        "DROP TRIGGER trial_is_never_changed; UPDATE trial SET level = 7 WHERE session_id = '" + changed +
        "' AND trial_index = 1");
  backup(db, {dir, 9});
  damage(db);
  const auto restored = restore_backup(db, {dir, ""});
  CHECK(restored.sessions == 2);
  CHECK(restored.changed == (edited ? std::vector<std::string>{changed} : std::vector<std::string>{}));
}

TEST_CASE("all commands accept the name of a database without a folder", "[store]") {
  TemporaryFolder folder;
  const auto before = fs::current_path();
  fs::current_path(folder.path);
  sample::session("a.sqlite", 2);
  sample::session("b.sqlite", 2, at_station("P01", "b"));
  backup("a.sqlite", {"backups", 2});
  CHECK(merge("a.sqlite", "b.sqlite").sessions.size() == 1);
  damage("a.sqlite");
  CHECK(restore_backup("a.sqlite", {"backups", ""}).trials == 2);
  CHECK(withdraw("a.sqlite", {"P01", "", "", "backups"}).trials == 2);
  fs::current_path(before);
}

TEST_CASE("the newest interrupted session is the one that was written last, even if the clock was wrong",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  const auto ahead = sample::session(db, 2, sample::start("P01"), SessionStatus::interrupted);
  sample::raw(db).execute("UPDATE segment SET realtime_ns = 4102444800000000000");  // the year 2100
  const auto last = sample::session(db, 2, sample::start("P02"), SessionStatus::interrupted);
  REQUIRE(interrupted_session(db));
  CHECK(interrupted_session(db)->session.session_id == last);
  CHECK(interrupted_session(db, ahead)->age_s < 0);
}

TEST_CASE("withdrawing a participant includes files that interrupted operations have left behind",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", dir = folder / "backups";
  sample::session(db, 4, sample::start("XQ77ZK"));
  sample::session(db, 2, sample::start("P02"));
  const auto good = backup(db, {dir, 9});
  sample::raw(db).execute("PRAGMA wal_checkpoint(TRUNCATE)");
  for (const auto* name : {".new", ".merging", ".merging.new", ".restored", ".restored.new"})
    fs::copy_file(db, db + name);
  fs::copy_file(good.path, good.path + ".new");
  const auto plan = plan_withdrawal(db, {"XQ77ZK", "", "", dir});
  CHECK(plan.removed_copies.size() == 1);
  CHECK(list_sessions(db).size() == 2);
  const auto gone = withdraw(db, {"XQ77ZK", "", "", dir});
  CHECK(gone.removed_copies.size() == 1);
  CHECK(gone.remaining_copies.empty());
  for (const auto& entry : fs::recursive_directory_iterator(folder.path))
    if (entry.is_regular_file()) {
      INFO(entry.path());
      CHECK_FALSE(sample::contains(sample::bytes_of(entry.path()), "XQ77ZK"));
    }
}

TEST_CASE("a withdrawal that was interrupted before it reached the copies is finished by the next one",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", dir = folder / "backups";
  sample::session(db, 4, sample::start("XQ77ZK"));
  const auto old = backup(db, {dir, 9});
  withdraw(db, {"XQ77ZK", "", "", ""});
  CHECK(fs::exists(old.path));
  CHECK(withdraw(db, {"XQ77ZK", "", "", dir}).removed_copies == std::vector<std::string>{old.path});
  CHECK_FALSE(fs::exists(old.path));
}

TEST_CASE(
    "a withdrawal fails if the folder of backups is missing, and names backups of other databases that it "
    "leaves",
    "[store]") {
  TemporaryFolder folder;
  const auto a = folder / "a.sqlite", b = folder / "b.sqlite", dir = folder / "backups";
  sample::session(b, 4, at_station("P01", "b"));
  sample::session(a, 1, at_station("P02", "a"));
  merge(a, b);
  CHECK(sample::failure([&] { withdraw(a, {"P01", "", "", dir}); }).first == ErrorKind::missing);
  CHECK(list_sessions(a).size() == 2);
  const auto other = backup(b, {dir, 9});
  const auto gone = withdraw(a, {"P01", "", "", dir});
  CHECK(gone.removed_copies.empty());
  CHECK(gone.remaining_copies == std::vector<std::string>{other.path});
  CHECK(fs::exists(other.path));
}

TEST_CASE("the same code at two stations stands for two people until somebody joins them", "[store]") {
  TemporaryFolder folder;
  const auto a = folder / "a.sqlite", b = folder / "b.sqlite";
  sample::session(a, 2, at_station("P01", "a"));
  sample::session(b, 3, at_station("P01", "b"));
  sample::session(b, 4, at_station("P07", "b"));
  merge(a, b);
  auto persons = [&] {
    std::vector<std::string> names;
    for (const auto& session : list_sessions(a)) names.push_back(session.person);
    return names;
  };
  CHECK(persons() == std::vector<std::string>{"P01@a", "P01@b", "P07"});
  CHECK(sample::failure([&] { withdraw(a, {"P01", "", "", ""}); }).first == ErrorKind::refused);
  CHECK(join(a, "P01@a", "P07") == "P01@a");
  CHECK(persons() == std::vector<std::string>{"P01@a", "P01@a", "P01@b"});
  // Numbering of the joined person's sessions continues at any station.
  const auto id = sample::session(a, 1, at_station("P01", "a"));
  CHECK(read_session(a, id).session.session_index == 2);
  CHECK(join(a, "P01@a", "P07", Relation::two_people) == "P01@a");
  CHECK(persons() == std::vector<std::string>{"P01@a", "P01@a", "P01@b", "P07"});
  CHECK(sample::failure([&] { join(a, "P01", "P07"); }).first == ErrorKind::refused);
  CHECK(sample::failure([&] { join(a, "P99", "P07"); }).first == ErrorKind::missing);
}

TEST_CASE(
    "a withdrawal can be limited to one of two people with the same code, to one station, or to one session",
    "[store]") {
  TemporaryFolder folder;
  const auto a = folder / "a.sqlite", b = folder / "b.sqlite";
  const auto here = sample::session(a, 2, at_station("P01", "a"));
  const auto second = sample::session(a, 2, at_station("P01", "a"));
  const auto there = sample::session(b, 3, at_station("P01", "b"));
  merge(a, b);
  SECTION("one of two people") {
    CHECK(withdraw(a, {"P01@b", "", "", ""}).trials == 3);
    CHECK(list_sessions(a).size() == 2);
    // The other P01, of station a, has not withdrawn and may do another session.
    CHECK(sample::session(a, 1, at_station("P01", "a")).size() == 36);
    CHECK(sample::failure([&] { sample::session(a, 1, at_station("P01", "b")); }).first ==
          ErrorKind::refused);
    CHECK(merge(a, b).sessions[0].what == MergedSession::What::withdrawn);
  }
  SECTION("by station") { CHECK(withdraw(a, {"P01", "a", "", ""}).trials == 4); }
  SECTION("one session") {
    const auto gone = withdraw(a, {"P01@a", "", second, ""});
    CHECK(gone.sessions.size() == 1);
    CHECK(gone.bearers.empty());
    CHECK(sample::session(a, 1, at_station("P01", "a")).size() == 36);
  }
  SECTION("all of a joined person") {
    join(a, "P01@a", "P01@b");
    CHECK(withdraw(a, {"P01", "", "", ""}).trials == 7);
    CHECK(list_sessions(a).empty());
  }
}

TEST_CASE("participants whose codes BIDS cannot distinguish get different labels", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  for (const auto* code : {"P1", "P-1", "p1", "P2"}) sample::session(db, 1, sample::start(code));
  sample::session(db, 1, at_station("P2", "b"));
  ExportOptions options;
  options.format = ExportFormat::bids;
  export_data(db, folder / "one", options);
  int subjects = 0;
  for (const auto& entry : fs::directory_iterator(folder / "one/two-boundaries"))
    subjects += entry.path().filename().string().rfind("sub-", 0) == 0 ? 1 : 0;
  CHECK(subjects == 5);
  export_data(db, folder / "one", options);  // a second export must give participants the same labels
}

// Tests of the restore drill (a trial run of a restore), of the note about the last backup that the start
// page reads, and of backups that require a separate disk.
#include <sys/stat.h>

#include <algorithm>

#include "station/store/backup.hpp"
#include "station/store/read.hpp"
#include "station/store/withdraw.hpp"
#include "station/system/clocks.hpp"
#include "station/system/uuid.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::store;
using namespace turnpoint::system;
namespace fs = std::filesystem;

namespace {

/// Returns the names of the files in the folder, without those that SQLite keeps beside a database while
/// reading it.
std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    if (const auto name = entry.path().filename().string();
        !name.ends_with("-wal") && !name.ends_with("-shm"))
      names.push_back(name);
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

TEST_CASE(
    "a restore drill restores the newest backup, compares it with the database, and leaves nothing behind",
    "[store][drill]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", dir = folder / "backups";
  sample::session(db, 4);
  backup(db, {dir, 9});
  sample::session(db, 3, sample::start("P02"));
  const auto newest = backup(db, {dir, 9});
  sample::session(db, 2, sample::start("P03"));
  const auto beside = names_in(folder.path), before = names_in(dir);
  const auto drill = drill_restore(db, dir);
  CHECK(drill.from == newest.path);
  CHECK(drill.number == 2);
  CHECK(drill.age_s > -2);
  CHECK(drill.age_s < 600);
  CHECK(drill.trials == 7);
  CHECK(drill.live_trials == 9);
  CHECK(drill.live_sessions == 3);
  CHECK(drill.problems.empty());
  CHECK(names_in(dir) == before);
  CHECK(names_in(folder.path) == beside);
}

TEST_CASE("a drill finds backups of every year, and says how old they are", "[store][drill]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", dir = folder / "backups";
  sample::session(db, 1);
  const auto path = backup(db, {dir, 9}).path;
  const auto [year, years] = GENERATE(std::pair{"1965", 61.0}, std::pair{"2400", -374.0});
  auto renamed = path;
  renamed.replace(renamed.rfind("Z.sqlite") - 19, 4, year);
  std::filesystem::rename(path, renamed);
  const auto drill = drill_restore(db, dir);
  CHECK(drill.from == renamed);
  CHECK(drill.age_s / (365.25 * 86400) == Approx(years).margin(2));
}

TEST_CASE(
    "a restore drill detects a backup that is damaged, was changed, or does not contain the database's "
    "sessions",
    "[store][drill]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", dir = folder / "backups";
  const auto id = sample::session(db, 4);
  SECTION("damaged") {
    const auto made = backup(db, {dir, 9});
    auto bytes = sample::bytes_of(made.path);
    bytes[bytes.size() / 2] ^= 1;
    std::ofstream(made.path, std::ios::binary) << bytes;
    CHECK(sample::failure([&] { drill_restore(db, dir); }).first == ErrorKind::corrupt);
  }
  SECTION("it is empty, although an older one is good") {
    backup(db, {dir, 9});
    const auto made = backup(db, {dir, 9});
    fs::resize_file(made.path, 0);
    CHECK(sample::failure([&] { drill_restore(db, dir); }).first == ErrorKind::corrupt);
  }
  SECTION("rows were changed before it was made") {
    sample::raw(db).execute("DROP TRIGGER trial_is_never_changed; UPDATE trial SET level = 7");
    backup(db, {dir, 9});
    CHECK_FALSE(drill_restore(db, dir).problems.empty());
  }
  SECTION("the database has lost a session since") {
    backup(db, {dir, 9});
    sample::raw(db).execute(
        "PRAGMA foreign_keys = OFF; DROP TRIGGER trial_is_never_deleted; DROP TRIGGER tone_is_never_deleted;"
        "DELETE FROM tone; DELETE FROM trial; DELETE FROM session");
    const auto problems = drill_restore(db, dir).problems;
    REQUIRE(problems.size() == 1);
    CHECK(sample::contains(problems[0], "no longer contains this session"));
  }
  SECTION("a session was withdrawn since, which is no fault of the backup") {
    backup(db, {dir, 9});
    withdraw(db, {"P01", "", "", ""});
    CHECK(drill_restore(db, dir).problems.empty());
  }
  SECTION("there is none") {
    fs::create_directory(dir);
    CHECK(sample::failure([&] { drill_restore(db, dir); }).first == ErrorKind::missing);
  }
  for (const auto& entry : fs::recursive_directory_iterator(folder.path))
    CHECK_FALSE(sample::contains(entry.path().filename().string(), ".drill"));
}

TEST_CASE("the next backup removes the files that a killed restore drill has left", "[store][drill]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", dir = folder / "backups";
  sample::session(db, 4);
  const auto made = backup(db, {dir, 9});
  for (const auto* left : {".drill", ".drill.new", ".drill.new-journal"})
    fs::copy_file(made.path, made.path + left);
  backup(db, {dir, 9});
  for (const auto& name : names_in(dir)) CHECK_FALSE(sample::contains(name, ".drill"));
}

TEST_CASE("the last good backup is noted in a file beside the database, and a failed one is not", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", dir = folder / "backups";
  sample::session(db, 4);
  CHECK_FALSE(last_backup(db));
  const auto before = realtime_ns();
  const auto made = backup(db, {dir, 9});
  CHECK(made.unrecorded.empty());
  auto last = last_backup(db);
  REQUIRE(last);
  CHECK(last->path == made.path);
  CHECK(last->realtime_ns >= before);
  CHECK(last->realtime_ns <= realtime_ns());

  std::ofstream(folder / "file") << "no folder";
  CHECK_THROWS_AS(backup(db, {folder / "file", 9}), StoreError);
  CHECK(last_backup(db)->path == made.path);

  SECTION("not of another database that came to the same name") {
    for (const auto* ending : {"", "-wal", "-shm", ".lock"}) fs::remove(db + ending);
    sample::session(db, 1);
    CHECK_FALSE(last_backup(db));
  }
  SECTION("nor by half a record") {
    std::ofstream(db + ".last-backup") << "one line";
    CHECK_FALSE(last_backup(db));
  }
}

TEST_CASE("a backup that requires a separate disk is refused if none is mounted", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 2);
  fs::create_directory(folder / "mnt");
  for (const auto& dir : {folder / "mnt", folder / "mnt/backups"}) {
    const auto [fault, message] = sample::failure([&] { backup(db, {dir, 9, Destination::disk}); });
    CHECK(fault == ErrorKind::no_disk);
    CHECK(sample::contains(message, "no disk is mounted"));
    CHECK(fs::is_empty(folder / "mnt"));
  }
  CHECK_FALSE(last_backup(db));

  struct stat memory {
  }, build{};
  if (::stat("/dev/shm", &memory) != 0 || ::stat(TURNPOINT_BINARY_DIR, &build) != 0 ||
      memory.st_dev == build.st_dev) {
    WARN("skipped: /dev/shm is not a separate file system here; mount -t tmpfs tmpfs /dev/shm");
    return;
  }
  const auto dir = "/dev/shm/turnpoint-" + new_uuid(), other = TURNPOINT_BINARY_DIR "/drill-" + new_uuid();
  fs::create_directory(other);
  sample::session(other + "/a.sqlite", 2);
  CHECK(backup(other + "/a.sqlite", {dir, 9, Destination::disk}).trials == 2);
  fs::copy_file(other + "/a.sqlite", dir + "/b.sqlite");
  fs::remove_all(other);
  const auto [fault, message] = sample::failure([&] {
    backup(dir + "/b.sqlite", {dir, 9, Destination::disk});
  });
  CHECK(fault == ErrorKind::no_disk);
  CHECK(sample::contains(message, "the same disk as the database"));
  fs::remove_all(dir);
}

#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "station/store/backup.hpp"
#include "station/store/export.hpp"
#include "station/store/merge.hpp"
#include "station/store/read.hpp"
#include "station/store/schema.hpp"
#include "station/store/verify.hpp"
#include "station/store/withdraw.hpp"
#include "tests/store/failing_disk.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::store;

namespace {

void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// Runs `action` in a child process. Returns the value of the action, as the child's exit status.
int in_child(const std::function<int()>& action) {
  const auto child = ::fork();
  if (child == 0) {
    int status = 99;
    try {
      status = action();
    } catch (...) {
    }
    ::_exit(status);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

TEST_CASE(
    "a full disk stops the session before its next trial and loses no row, and the trial is written once "
    "there is space",
    "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  const std::int64_t bytes = GENERATE(0, 1000, 5000, 13000, 40000);
  {
    FailingDisk disk;
    auto log = SessionLog::begin(db, sample::start(), sample::segment());
    log.begin_block(sample::block());
    disk.bytes_left(bytes);
    int acknowledged = 0;
    std::pair<ErrorKind, std::string> failure;
    for (; acknowledged < 100 && failure.second.empty(); ++acknowledged) {
      log.event({1, "touch", "", acknowledged});
      failure = sample::failure([&] { log.append(sample::answered(acknowledged)); });
    }
    --acknowledged;
    REQUIRE(acknowledged < 99);
    CHECK(failure.first == ErrorKind::disk_full);
    CHECK(sample::contains(failure.second, "free some space"));
    auto reader = sample::raw(db);
    CHECK(reader.integer("SELECT count(*) FROM trial") == acknowledged);
    CHECK(reader.text("PRAGMA integrity_check") == "ok");
    disk.space_again();
    log.append(sample::answered(acknowledged));
    log.finish(SessionStatus::completed, "");
    CHECK(reader.integer("SELECT count(*) FROM trial") == acknowledged + 1);
    CHECK(reader.integer("SELECT count(*) FROM event") == acknowledged + 1);
  }
}

TEST_CASE("a file of 0 bytes is a lost database, not a new one", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  write_bytes(db, "");
  for (const auto& action : std::vector<std::function<void()>>{
           [&] { SessionLog::begin(db, sample::start(), sample::segment()); }, [&] { list_sessions(db); }}) {
    const auto [fault, message] = sample::failure(action);
    CHECK(fault == ErrorKind::not_a_database);
    CHECK(sample::contains(message, "0 bytes"));
    CHECK(sample::contains(message, "restore"));
  }
  CHECK(std::filesystem::file_size(db) == 0);
}

TEST_CASE("a file that is not a database, or belongs to another program, is not changed", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  SECTION("text") { write_bytes(db, "participant,response\nP01,left\n" + std::string(5000, 'x')); }
  SECTION("another program's database") {
    Database(db, Database::Access::create).execute("CREATE TABLE trial (a); INSERT INTO trial VALUES (1)");
  }
  const auto before = sample::bytes_of(db);
  const auto [fault, message] =
      sample::failure([&] { SessionLog::begin(db, sample::start(), sample::segment()); });
  CHECK(fault == ErrorKind::not_a_database);
  CHECK(sample::contains(message, db));
  CHECK(sample::bytes_of(db) == before);
}

TEST_CASE("no command changes a damaged database", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 200);
  auto bytes = sample::bytes_of(db);
  SECTION("pages of zeros") { bytes.replace(5 * 4096, 8 * 4096, 8 * 4096, '\0'); }
  SECTION("cut short") { bytes.resize(bytes.size() / 2 + 100); }
  SECTION("truncated within its first page") { bytes.resize(1000); }
  write_bytes(db, bytes);
  for (const auto& action : std::vector<std::function<void()>>{
           [&] { SessionLog::begin(db, sample::start(), sample::segment()); }, [&] { list_sessions(db); },
           [&] { export_data(db, folder / "out", {}); },
           [&] {
             backup(db, {folder / "backups", 3});
           }}) {
    const auto [fault, message] = sample::failure(action);
    INFO(message);
    CHECK((fault == ErrorKind::corrupt || fault == ErrorKind::not_a_database));
    CHECK(sample::contains(message, db));
  }
  CHECK(sample::bytes_of(db) == bytes);
  CHECK_FALSE(std::filesystem::exists(folder / "out"));
}

TEST_CASE("a second station process is told which process uses the database, and the first continues",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  auto log = SessionLog::begin(db, sample::start(), sample::segment());
  log.begin_block(sample::block());
  const int status = in_child([&] {
    const auto [fault, message] =
        sample::failure([&] { SessionLog::begin(db, sample::start("P02"), sample::segment()); });
    const bool named = sample::contains(message, "pid " + std::to_string(::getppid()));
    return fault == ErrorKind::busy && named ? 0 : 1;
  });
  CHECK(status == 0);
  std::filesystem::create_symlink(db, folder / "link.sqlite");
  CHECK(sample::failure([&] {
          SessionLog::begin(folder / "link.sqlite", sample::start("P02"), sample::segment());
        }).first == ErrorKind::busy);
  log.append(sample::answered(0));
  CHECK(list_sessions(db).size() == 1);  // reading is still allowed
}

TEST_CASE("the lock on a database ends with its process, however the process ends", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  CHECK(in_child([&] {
          auto log = SessionLog::begin(db, sample::start(), sample::segment());
          ::_exit(7);
          return 0;
        }) == 7);
  CHECK(sample::session(db, 1).size() == 36);
}

TEST_CASE("a read-only database is refused before the session, and can still be exported", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "data/a.sqlite";
  std::filesystem::create_directory(folder / "data");
  std::filesystem::create_directory(folder / "out");
  sample::session(db, 3);
  std::filesystem::permissions(folder.path, std::filesystem::perms::all);
  std::filesystem::permissions(folder / "out", std::filesystem::perms::all);
  std::filesystem::permissions(db, static_cast<std::filesystem::perms>(0444));
  std::filesystem::permissions(db + ".lock", static_cast<std::filesystem::perms>(0444));
  std::filesystem::permissions(folder / "data", static_cast<std::filesystem::perms>(0555));
  const auto before = sample::bytes_of(db);
  const int status = in_child([&] {
    // drop root's rights, because root may write anything
    if (::geteuid() == 0 && ::setuid(65534) != 0) return 50;
    const auto [fault, message] =
        sample::failure([&] { SessionLog::begin(db, sample::start(), sample::segment()); });
    if (fault != ErrorKind::read_only || !sample::contains(message, "writable")) return 1;
    if (list_sessions(db).size() != 1) return 2;
    return export_data(db, folder / "out", {})[0].rows == 3 ? 0 : 3;
  });
  CHECK(status == 0);
  CHECK(sample::bytes_of(db) == before);
  std::filesystem::permissions(folder / "data", std::filesystem::perms::all);
}

TEST_CASE("the error for a missing folder names the folder", "[store]") {
  const auto [fault, message] = sample::failure(
      [] { SessionLog::begin("/nonexistent/folder/a.sqlite", sample::start(), sample::segment()); });
  CHECK(fault == ErrorKind::missing);
  CHECK(sample::contains(message, "/nonexistent/folder"));
}

TEST_CASE("a database of another schema is not changed, and the message says which program reads it",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 1);
  const int schema = GENERATE(1, kSchema - 1, kSchema + 1);
  sample::raw(db).execute("PRAGMA user_version = " + std::to_string(schema));
  const auto before = sample::bytes_of(db);
  const auto check = [&](auto&& action) {
    const auto [kind, message] = sample::failure(action);
    CHECK(kind == ErrorKind::other_schema);
    CHECK(sample::contains(message, "has schema " + std::to_string(schema)));
    CHECK(sample::contains(message, schema < kSchema ? "`turnpoint export` of commit fb95ea6f" : "update"));
  };
  check([&] { sample::session(db, 1); });
  check([&] { list_sessions(db); });
  check([&] { export_data(db, folder / "out", {}); });
  check([&] { merge(folder / "b.sqlite", db); });
  CHECK(sample::bytes_of(db) == before);
}

TEST_CASE("a view in place of a table is refused by every function, even one that never ends", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", dir = folder / "backups", other = folder / "b.sqlite";
  sample::session(db, 1);
  sample::session(other, 1, sample::start("P02"));
  const auto stored = backup(db, {dir, 9});
  const std::string endless =
      "WITH RECURSIVE n(i) AS (VALUES (1) UNION ALL SELECT i + 1 FROM n) SELECT i AS annotation_id, i AS "
      "session_id, i AS realtime_ns, i AS text, i AS key, i AS value FROM n";
  const std::string table = GENERATE("annotation", "meta");
  for (const auto& path : {db, stored.path})
    sample::raw(path).execute("DROP TABLE " + table + "; CREATE VIEW " + table + " AS " + endless);
  std::filesystem::remove(stored.path + ".sha256");
  const auto refused = [&](auto&& action) {
    const auto [kind, message] = sample::failure(action);
    CHECK(kind == ErrorKind::corrupt);
    CHECK(sample::contains(message, "table " + table + " is not as this program makes it"));
  };
  refused([&] { list_sessions(db); });
  refused([&] { export_data(db, folder / "out", {}); });
  refused([&] { sample::session(db, 1); });
  refused([&] { merge(other, db); });
  refused([&] { backup(db, {dir, 9}); });
  refused([&] { verify(db); });
  refused([&] { withdraw(db, {"P01", "", "", dir}); });
  CHECK(withdraw(other, {"P02", "", "", dir}).remaining_copies == std::vector{stored.path});
  CHECK(sample::failure([&] { restore_backup(db, {dir, ""}); }).first == ErrorKind::missing);
}

TEST_CASE("nothing is recorded in a database with somebody else's trigger, and it can be read", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 1);
  sample::raw(db).execute("CREATE TRIGGER better AFTER INSERT ON session BEGIN DELETE FROM annotation; END");
  const auto [kind, message] = sample::failure([&] { sample::session(db, 1); });
  CHECK(kind == ErrorKind::refused);
  CHECK(sample::contains(message, "DROP TRIGGER \"better\""));
  CHECK(list_sessions(db).size() == 1);
  CHECK(verify(db).problems == std::vector<std::string>{"trigger better was added"});
}

TEST_CASE("a database on a read-only medium is read together with its log", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", medium = folder / "medium";
  std::filesystem::create_directory(medium);
  {
    auto log = SessionLog::begin(db, sample::start(), sample::segment());
    log.begin_block(sample::block());
    log.append(sample::answered(0));
    for (const auto* suffix : {"", "-wal"})
      std::filesystem::copy_file(db + suffix, medium + "/a.sqlite" + suffix);
  }
  REQUIRE(std::filesystem::file_size(medium + "/a.sqlite-wal") > 0);
  const int status = in_child([&] {
    const int spaces = CLONE_NEWNS | (::geteuid() == 0 ? 0 : CLONE_NEWUSER);
    if (::unshare(spaces) != 0 || ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        ::mount(medium.c_str(), medium.c_str(), nullptr, MS_BIND, nullptr) != 0 ||
        ::mount("none", medium.c_str(), nullptr, MS_BIND | MS_REMOUNT | MS_RDONLY, nullptr) != 0)
      return 77;
    const auto copy = medium + "/a.sqlite";
    if (list_sessions(copy).at(0).trials != 1) return 1;
    if (!verify(copy).good()) return 2;
    if (export_data(copy, folder / "out", {})[0].rows != 1) return 3;
    if (backup(copy, {folder / "backups", 0}).trials != 1) return 4;
    if (merge(folder / "b.sqlite", copy).sessions.size() != 1) return 5;
    return sample::failure([&] { sample::session(copy, 1); }).first == ErrorKind::read_only ? 0 : 6;
  });
  if (status == 77) WARN("not tested: this machine does not allow a mount");
  CHECK((status == 0 || status == 77));
}

#include "station/store/backup.hpp"
#include "station/store/export.hpp"
#include "station/store/read.hpp"
#include "station/store/schema.hpp"
#include "station/store/verify.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::store;

namespace {

/// Makes a database of an older schema version, from a dump of a database that the older release wrote.
void make_old(const std::string& path, int version, const std::string& dump = "v") {
  Database database(path, Database::Access::create);
  database.execute("PRAGMA journal_mode = WAL");
  database.execute(sample::bytes_of(std::string(TURNPOINT_SOURCE_DIR) + "/tests/store/schemas/" + dump +
                                    std::to_string(version) + ".sql"));
  database.execute("PRAGMA application_id = " + std::to_string(kApplicationId));
  database.execute("PRAGMA user_version = " + std::to_string(version));
}

std::string schema_of(Database& database) {
  return database.text(
      "SELECT group_concat(sql, char(10)) FROM (SELECT sql FROM sqlite_schema WHERE sql NOT NULL"
      " AND name NOT LIKE 'sqlite_%' ORDER BY type, name)");
}

}  // namespace

TEST_CASE("each released step of the schema still creates the tables that it created when it was released",
          "[store]") {
  TemporaryFolder folder;
  const int version = GENERATE(range(1, schema_version()));
  make_old(folder / "old.sqlite", version);
  auto old = sample::raw(folder / "old.sqlite");
  Database made(folder / "made.sqlite", Database::Access::create);
  create_schema(made, version);
  CHECK(schema_of(old) == schema_of(made));
}

TEST_CASE("a copy of an older database has the same file permissions as the database", "[store]") {
  namespace fs = std::filesystem;
  TemporaryFolder folder;
  const auto db = folder / "old.sqlite";
  make_old(db, 1);
  fs::permissions(db, fs::perms::owner_read | fs::perms::owner_write);
  const auto copy = backup(db, {folder / "backups", 9});
  CHECK(fs::status(copy.path).permissions() == (fs::perms::owner_read | fs::perms::owner_write));
}

TEST_CASE("migrating an older database keeps its rows, and a copy of the old file", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "old.sqlite";
  const int version = GENERATE(range(1, schema_version()));
  make_old(db, version);
  // opening the database for writing migrates it
  const auto id = sample::session(db, 2, sample::start("P03"));
  auto migrated = sample::raw(db);
  CHECK(migrated.integer("PRAGMA user_version") == schema_version());
  Database fresh(folder / "fresh.sqlite", Database::Access::create);
  create_schema(fresh, schema_version());
  CHECK(schema_of(migrated) == schema_of(fresh));
  CHECK(migrated.text("PRAGMA integrity_check") == "ok");
  const auto sessions = list_sessions(db);
  REQUIRE(sessions.size() == 3);
  CHECK(sessions[0].trials == 6);
  CHECK(sessions[1].annotations == std::vector<std::string>{"a note"});
  CHECK(sessions[2].session_id == id);
  CHECK(sessions[2].sequence_index == 2);
  const auto kept = db + ".before-v" + std::to_string(schema_version());
  REQUIRE(std::filesystem::exists(kept));
  CHECK(sample::raw(kept).integer("PRAGMA user_version") == version);
  CHECK(sample::raw(kept).integer("SELECT count(*) FROM trial") == 7);
}

TEST_CASE("checksums of an earlier encoding still hold after a migration, and find a change", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "old.sqlite";
  make_old(db, GENERATE(4, 5, 6, 7, 8), "linked_v");
  CHECK(verify(db).good());
  sample::session(db, 1, sample::start("P09"));  // migrates the database
  auto database = sample::raw(db);
  CHECK(database.integer("SELECT count(DISTINCT encoding) FROM link") == 2);
  CHECK(verify(db).good());
  database.execute("DROP TRIGGER trial_is_never_changed");
  database.execute("UPDATE trial SET level = 9 WHERE trial_id = 3");
  CHECK_FALSE(verify(db).good());
}

TEST_CASE("an older database can be read and exported without changing it", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "old.sqlite";
  make_old(db, 1);
  const auto before = sample::bytes_of(db);
  CHECK(list_sessions(db).size() == 2);
  const auto files = export_data(db, folder / "out", {});
  CHECK(files[0].rows == 7);
  CHECK(sample::bytes_of(db) == before);
  sample::session(db, 1, sample::start("P03"));
  ExportOptions options;
  options.participant = "P01";
  const auto first = sample::bytes_of(export_data(db, folder / "after", options)[0].path);
  std::filesystem::remove_all(folder / "out");
  TemporaryFolder other;
  make_old(other / "old.sqlite", 1);
  CHECK(first == sample::bytes_of(export_data(other / "old.sqlite", folder / "out", options)[0].path));
}

TEST_CASE(
    "a database of a newer release is not changed, and the message says that the station must be updated",
    "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 1);
  sample::raw(db).execute("PRAGMA user_version = 99");
  const auto before = sample::bytes_of(db);
  const auto check = [&](auto&& action) {
    const auto [fault, message] = sample::failure(action);
    CHECK(fault == ErrorKind::newer_schema);
    CHECK(sample::contains(message, "schema version 99"));
    CHECK(sample::contains(message, "update Turnpoint"));
  };
  check([&] { sample::session(db, 1); });
  check([&] { list_sessions(db); });
  check([&] { export_data(db, folder / "out", {}); });
  CHECK(sample::bytes_of(db) == before);
}

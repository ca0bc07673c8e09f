#include <set>

#include "station/collector/tables.hpp"
#include "station/store/schema.hpp"
#include "tests/collector/postgres_server.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;

TEST_CASE("every table of the station that holds data of sessions is collected", "[collector]") {
  // These tables are not collected, because they describe one file or one station. The codes (participant)
  // follow from sessions and enrolments.
  const std::set<std::string> own = {"participant", "meta", "merged", "lease", "renamed", "seal"};
  std::set<std::string> collected;
  for (const auto& table : collector::collected_tables()) collected.insert(table.name);
  store::Database database(":memory:", store::Database::Access::create);
  store::create_schema(database);
  store::Statement rows(database, "SELECT name FROM sqlite_schema WHERE type = 'table'");
  int count = 0;
  for (; rows.step(); ++count) {
    INFO(rows.text(0));
    CHECK((collected.count(rows.text(0)) + own.count(rows.text(0))) == 1);
  }
  CHECK(count >= 20);
}

TEST_CASE("the server's tables have the columns, types and keys of the station's", "[collector]") {
  const PostgresServer postgres;
  auto server = postgres.admin();
  store::Database database(":memory:", store::Database::Access::create);
  store::create_schema(database);
  const auto type = [](const std::string& sqlite) -> std::string {
    if (sqlite == "INTEGER") return "bigint";
    if (sqlite == "REAL") return "double precision";
    return sqlite == "BLOB" ? "bytea" : "text";
  };
  for (const auto& table : collector::collected_tables()) {
    INFO(table.name);
    std::set<std::string> expected, found;
    store::Statement columns(database, "SELECT name, type, \"notnull\" OR pk FROM pragma_table_info(?)");
    columns.bind(table.name);
    while (columns.step())
      if (columns.text(0) != "trial_id")
        expected.insert(columns.text(0) + " " + type(columns.text(1)) +
                        (columns.integer(2) != 0 ? " NO" : " YES"));
    const auto rows = server.query(
        "SELECT column_name || ' ' || data_type || ' ' || is_nullable FROM information_schema.columns"
        " WHERE table_schema = 'turnpoint' AND table_name = $1",
        {table.name});
    for (int i = 0; i < rows.count(); ++i) found.insert(rows.text(i, 0));
    CHECK(found == expected);
  }
  const auto comment = server.query(
      "SELECT col_description('turnpoint.tone'::regclass, attnum) FROM pg_attribute"
      " WHERE attrelid = 'turnpoint.tone'::regclass AND attname = 'frequency_Hz'");
  CHECK(sample::contains(comment.text(0, 0), "[Hz]"));
  CHECK_THROWS_AS(server.query("INSERT INTO turnpoint.version VALUES (NULL)"), collector::ServerError);
}

TEST_CASE("the schema may be applied again, and a server of another schema is refused", "[collector]") {
  const PostgresServer postgres;
  auto server = postgres.admin();
  const auto apply = [&] {
    postgres.run("psql", "-q -h " + postgres.folder() + " -U postgres -d turnpoint -f schema.sql");
  };
  apply();
  for (const int other : {store::kSchema - 1, 99}) {
    server.query("UPDATE turnpoint.version SET schema = " + std::to_string(other));
    CHECK_THROWS(apply());
    CHECK(server.query("SELECT schema FROM turnpoint.version").integer(0, 0) == other);
  }
}

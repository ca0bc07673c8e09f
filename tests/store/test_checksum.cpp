#include "station/store/checksum.hpp"

#include <sys/stat.h>

#include <bit>
#include <fstream>
#include <random>

#include "station/core/usage_error.hpp"
#include "station/store/export.hpp"
#include "station/store/fields.hpp"
#include "station/store/merge.hpp"
#include "station/store/open.hpp"
#include "station/store/read.hpp"
#include "station/store/seal.hpp"
#include "station/store/session_log.hpp"
#include "station/store/text_table.hpp"
#include "station/store/verify.hpp"
#include "station/store/whole_file.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::store;

namespace {

/// Returns all problems that `turnpoint verify` finds in the database's pages, its references, and the chain
/// of checksums of each session.
std::vector<std::string> problems_of(const std::string& db) {
  Database database(db, Database::Access::read_only);
  std::vector<std::string> problems;
  try {
    check_pages(database);
  } catch (const StoreError& error) {
    problems.push_back(error.what());
  }
  for (const auto& session : verify_database(database))
    problems.insert(problems.end(), session.problems.begin(), session.problems.end());
  return problems;
}

/// Makes a database with a resumed session, a session of another participant, and a calibration.
void make(const std::string& db) {
  auto start = sample::start();
  start.calibration_id = std::string(64, 'c');
  start.calibration_text = "measured\n";
  const auto id = sample::session(db, 6, start, SessionStatus::interrupted);
  auto log = SessionLog::resume(db, id, sample::segment("resume"));
  log.begin_block(sample::block());
  log.presented(6, 9'000'000'000);
  log.append(sample::answered(6));
  log.finish(SessionStatus::completed, "");
  log = SessionLog(std::move(log));
}

/// Opens the database and removes the triggers that protect rows, as anybody with an SQLite shell could.
Database unguarded(const std::string& db) {
  auto database = sample::raw(db);
  std::vector<std::string> triggers;
  {
    Statement rows(database, "SELECT name FROM sqlite_schema WHERE type = 'trigger'");
    while (rows.step()) triggers.push_back(rows.text(0));
  }
  for (const auto& name : triggers) database.execute("DROP TRIGGER " + name);
  database.execute("PRAGMA foreign_keys = OFF; PRAGMA ignore_check_constraints = ON");
  return database;
}

const std::vector<std::pair<std::string, std::string>> kTables = {
    {"session", "session_id"},
    {"segment", "session_id, segment_index"},
    {"block", "session_id, block_index, attempt"},
    {"trial", "trial_id"},
    {"tone", "session_id, trial_index, interval_index, scene_index, tone_index"},
    {"signal", "session_id, trial_index, stream"},
    {"event", "session_id, event_index"},
    {"protocol", "protocol_key"},
    {"rig", "rig_key"},
    {"calibration", "calibration_id"},
    {"participant", "code"},
    {"enrolment", "station_id, protocol_id, participant"},
    {"link", "session_id, link_index"}};

struct Damage {
  std::mt19937_64 random;

  std::uint64_t below(std::uint64_t n) { return random() % n; }

  /// Returns an SQL condition that selects one random row of the table.
  std::string some_row(Database& database, const std::string& table, const std::string& key) {
    const auto count = database.integer("SELECT count(*) FROM " + table);
    return "(" + key + ") = (SELECT " + key + " FROM " + table + " ORDER BY " + key + " LIMIT 1 OFFSET " +
           std::to_string(below(static_cast<std::uint64_t>(count))) + ")";
  }

  /// Flips one bit of one stored value. Returns false if the value has no bits, or if the schema refuses the
  /// changed value.
  bool flip(Database& database) {
    const auto& [table, key] = kTables[below(kTables.size())];
    std::vector<std::string> columns;
    {
      Statement rows(database, "SELECT name FROM pragma_table_info(?)");
      rows.bind(table);
      while (rows.step()) columns.push_back(rows.text(0));
    }
    const auto& column = columns[below(columns.size())];
    // the checksums leave out this row number, because merging assigns new ones
    if (column == "trial_id") return false;
    const auto row = some_row(database, table, key);
    Statement value(database, "SELECT " + column + " FROM " + table + " WHERE " + row);
    value.step();
    Statement update(database, "UPDATE " + table + " SET " + column + " = ? WHERE " + row);
    if (value.is_null(0)) return false;
    if (value.is_real(0)) {
      const auto bits = std::bit_cast<std::uint64_t>(value.real(0)) ^ (std::uint64_t{1} << below(52));
      update.bind(std::bit_cast<double>(bits));
    } else if (value.is_text(0) || value.is_blob(0)) {
      auto bytes = value.text(0);
      if (bytes.empty()) return false;
      bytes[below(bytes.size())] ^= static_cast<char>(1U << below(8));
      if (value.is_blob(0))
        update.bind_blob(1, bytes);
      else
        update.bind(bytes);
    } else {
      update.bind(std::bit_cast<std::int64_t>(std::bit_cast<std::uint64_t>(value.integer(0)) ^
                                              (std::uint64_t{1} << below(63))));
    }
    value.reset();
    return run(update);
  }

  /// Changes a value to another one that the schema allows. Only the chain of checksums can detect this
  /// change.
  bool edit(Database& database) {
    const std::vector<std::string> edits = {
        "UPDATE trial SET level = level + 0.5 WHERE ", "UPDATE trial SET response_time_s = 0.4 WHERE ",
        "UPDATE trial SET correct = 1 - correct, response = correct_response WHERE correct = 0 AND ",
        "UPDATE trial SET factors = '{}' WHERE "};
    Statement update(database, edits[below(edits.size())] + some_row(database, "trial", "trial_id"));
    return run(update) && database.changes() > 0;
  }

  bool remove(Database& database) {
    const auto& [table, key] = kTables[below(kTables.size())];
    Statement statement(database, "DELETE FROM " + table + " WHERE " + some_row(database, table, key));
    return run(statement);
  }

  static bool run(Statement& statement) {
    try {
      statement.run();
      return true;
    } catch (const StoreError&) {
      return false;
    }
  }
};

}  // namespace

TEST_CASE("verify finds no changed rows in sessions that were resumed, annotated, interrupted or merged",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  make(db);
  annotate(db, list_sessions(db).front().session_id, "notes are outside of the chain");
  CHECK(problems_of(db).empty());
  {
    auto died = SessionLog::begin(db, sample::start("P02"), sample::segment());
    died.begin_block(sample::block());
    died.append(sample::answered(0));
    died.presented(1, 1);
  }
  // beginning this session marks that of the dead process as interrupted
  sample::session(db, 1, sample::start("P03"));
  CHECK(list_sessions(db, {"", "P02", ""}).front().status == SessionStatus::interrupted);
  CHECK(problems_of(db).empty());
  const auto other = folder / "b.sqlite";
  merge(other, db);
  CHECK(problems_of(other).empty());
}

TEST_CASE("verify finds each of 1000 flipped bits, edited rows and missing rows", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", damaged = folder / "damaged.sqlite";
  make(db);
  sample::raw(db).execute("PRAGMA journal_mode = DELETE");
  Damage damage{std::mt19937_64(20261122)};
  int found = 0;
  for (int made = 0; made < 1000;) {
    std::filesystem::copy_file(db, damaged, std::filesystem::copy_options::overwrite_existing);
    const bool done = [&] {
      auto database = unguarded(damaged);
      return made % 3 == 0   ? damage.flip(database)
             : made % 3 == 1 ? damage.edit(database)
                             : damage.remove(database);
    }();
    if (!done) continue;
    ++made;
    if (!problems_of(damaged).empty()) ++found;
  }
  CHECK(found == 1000);
  // Negative control: removing only the protecting triggers, without damage, must not be reported.
  std::filesystem::copy_file(db, damaged, std::filesystem::copy_options::overwrite_existing);
  unguarded(damaged);
  CHECK(problems_of(damaged).empty());
}

TEST_CASE("rows that were edited and got new checksums differ from a checksum that was exported before",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  make(db);
  const auto id = list_sessions(db).front().session_id;
  std::string exported;
  {
    auto database = unguarded(db);
    exported = verify_session(database, id).last_sha256;
    REQUIRE(exported.size() == 64);
    CHECK(holds_link(database, id, exported));
    database.execute("UPDATE trial SET response_time_s = 0.3 WHERE trial_index = 2; DELETE FROM link");
    Transaction transaction(database);
    Chain chain(database, id);
    chain.accept(chain.add());
    transaction.commit();
    CHECK_FALSE(holds_link(database, id, exported));
  }
  CHECK(problems_of(db).empty());
}

TEST_CASE("verify compares a database with a sessions.csv that was exported earlier", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  make(db);
  ExportOptions style;
  style.separator = GENERATE(',', ';');
  annotate(db, list_sessions(db).front().session_id, "two\nlines, and \"more\"");
  export_data(db, folder / "out", style);
  const auto csv = folder / "out/two-boundaries/sessions.csv";
  CHECK(verify(db, {"", csv}).good());
  sample::session(db, 1, sample::start("P04"));
  CHECK(verify(db, {"", csv}).good());  // the export is valid although it lacks later sessions
  SECTION("edited rows with new checksums") {
    auto database = unguarded(db);
    database.execute("UPDATE trial SET level = 3; DELETE FROM link");
    for (const auto& session : list_sessions(database)) Chain(database, session.session_id).add();
    const auto result = verify(db, {"", csv});
    REQUIRE_FALSE(result.good());
    CHECK(sample::contains(result.sessions[0].problems.at(0), "the checksum in the export"));
  }
  SECTION("another database") {
    sample::session(folder / "b.sqlite", 2);
    const auto result = verify(folder / "b.sqlite", {"", csv});
    REQUIRE(result.problems.size() == 1);
    CHECK(sample::contains(result.problems[0], "but not in the database"));
  }
  SECTION("not a sessions.csv") {
    const auto [fault, message] = sample::failure([&] {
      verify(db, {"", folder / "out/two-boundaries/trials.csv"});
    });
    CHECK(sample::contains(message, "no column checksum"));
    CHECK(sample::contains(sample::failure([&] {
                             verify(db, {"", folder / "absent.csv"});
                           }).second,
                           "absent.csv"));
  }
  SECTION("a file that cannot be read completely") {
    std::ofstream(folder / "empty.csv");
    REQUIRE(::mkfifo((folder / "fifo.csv").c_str(), 0600) == 0);
    const auto message = [&](const std::string& against) {
      const auto [fault, text] = sample::failure([&] { verify(db, {"", against}); });
      CHECK(fault == ErrorKind::missing);
      return text;
    };
    CHECK(sample::contains(message(folder / "empty.csv"), "empty.csv: the file is empty"));
    CHECK(sample::contains(message(folder / "fifo.csv"), "fifo.csv: not a file but a pipe"));
    CHECK(sample::contains(message(folder / "out"), "out: Is a directory"));
    CHECK(sample::contains(message("/proc/self/mem"), "mem: Input/output error"));
  }
}

TEST_CASE("only an export shows that a file is older, or that somebody has resealed what he changed",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", older = folder / "older.sqlite";
  const auto csv = folder / "out/two-boundaries/sessions.csv";
  sample::session(db, 3);
  const auto continued = sample::session(db, 2, sample::start("P02"), SessionStatus::interrupted);
  sample::raw(db).execute("PRAGMA wal_checkpoint(TRUNCATE)");
  std::filesystem::copy_file(db, older);
  SECTION("a session is missing in the older file") { sample::session(db, 1, sample::start("P03")); }
  SECTION("a session has grown since") {
    SessionLog::resume(db, continued, sample::segment("resume")).finish(SessionStatus::completed, "");
  }
  SECTION("a trial was changed and everything was computed again") {
    auto database = sample::raw(older);
    std::vector<std::pair<std::string, std::string>> triggers;
    {
      Statement rows(database, "SELECT name, sql FROM sqlite_schema WHERE type = 'trigger'");
      while (rows.step()) triggers.emplace_back(rows.text(0), rows.text(1));
    }
    for (const auto& [name, sql] : triggers) database.execute("DROP TRIGGER " + name);
    database.execute("UPDATE trial SET level = 3 WHERE trial_index = 1; DELETE FROM link; DELETE FROM seal");
    for (const auto& session : list_sessions(database)) Chain(database, session.session_id).add();
    create_seal(database);
    for (const auto& [name, sql] : triggers) database.execute(sql);
  }
  export_data(db, folder / "out", {});
  CHECK(verify(db, {"", csv}).good());
  CHECK(verify(older).good());
  CHECK_FALSE(verify(older, {"", csv}).good());
}

TEST_CASE("a change by somebody else stays visible, however often the program writes afterwards", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  const auto id = sample::session(db, 1);
  CHECK_THROWS_AS(annotate(db, id, ""), turnpoint::core::UsageError);
  annotate(db, id, "first");
  sample::raw(db).execute("DELETE FROM annotation");
  annotate(db, id, "second");
  sample::session(db, 1, sample::start("P02"));
  CHECK(verify(db).problems == std::vector<std::string>{"table annotation has 1 rows, and 2 were recorded"});
}

TEST_CASE("a session that continued after an export still contains the checksum in the export", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  const auto id = sample::session(db, 3, sample::start(), SessionStatus::interrupted);
  std::string exported;
  {
    auto database = sample::raw(db);
    exported = verify_session(database, id).last_sha256;
  }
  {
    auto log = SessionLog::resume(db, id, sample::segment("resume"));
    log.finish(SessionStatus::completed, "");
  }
  auto database = sample::raw(db);
  CHECK(verify_session(database, id).last_sha256 != exported);
  CHECK(holds_link(database, id, exported));
}

TEST_CASE("a database whose rows were changed is not merged", "[store]") {
  TemporaryFolder folder;
  const auto a = folder / "a.sqlite", b = folder / "b.sqlite";
  sample::session(a, 2);
  sample::session(b, 4, sample::start("P05"));
  { unguarded(b).execute("UPDATE trial SET level = 7 WHERE trial_index = 3"); }
  const auto [fault, message] = sample::failure([&] { merge(a, b); });
  CHECK(fault == ErrorKind::corrupt);
  CHECK(sample::contains(message, "trial 3"));
  CHECK(list_sessions(a).size() == 1);
}

TEST_CASE("the bytes over which the checksums of a session are made change only with the schema", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  auto start = sample::start();
  start.rig_text = "format = \"friction-rig/1\"\n";
  sample::session(db, 2, start);
  auto database = unguarded(db);
  // Gives fixed values to everything that differs between runs: random values, clock times, and data from
  // zlib, which depend on its version. Removes what was added to the sample after the expected checksum had
  // been recorded.
  database.execute(
      "UPDATE session SET session_id = '00000000-0000-4000-8000-000000000000';"
      "UPDATE trial SET session_id = (SELECT session_id FROM session), recorded_realtime_ns = 5;"
      "UPDATE tone SET session_id = (SELECT session_id FROM session);"
      "UPDATE signal SET session_id = (SELECT session_id FROM session), data = x'00FF10', start_frame = "
      "192000,"
      " channels = '[{\"name\":\"normal_N\",\"resolution\":0.0001,\"unit\":\"N\"},"
      "{\"name\":\"position_mm\",\"resolution\":0.01,\"unit\":\"mm\"}]';"
      "UPDATE event SET session_id = (SELECT session_id FROM session);"
      "UPDATE block SET session_id = (SELECT session_id FROM session);"
      "UPDATE segment SET session_id = (SELECT session_id FROM session); DELETE FROM link");
  Transaction transaction(database);
  Chain chain(database, "00000000-0000-4000-8000-000000000000");
  CHECK(chain.add().sha256 == "374f751db6b3b6aab1c2ad628eee82bd40b7d829ff6fd347bdb0b4ec26a0dd1d");
}

#include "station/collector/push.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <functional>

#include "station/collector/fetch.hpp"
#include "station/store/checksum.hpp"
#include "station/store/merge.hpp"
#include "station/store/schema.hpp"
#include "station/store/session_log.hpp"
#include "tests/collector/exported.hpp"
#include "tests/collector/postgres_server.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using What = collector::PushedSession::What;

namespace {

store::SessionStart at_station(const std::string& station, const std::string& participant) {
  auto start = sample::start(participant);
  start.station_id = station;
  return start;
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const collector::ServerError& error) {
    return error.what();
  } catch (const store::StoreError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a push sends each session once, and a continued session is extended", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto db = folder / "lab.sqlite";
  const auto first = sample::session(db, 12);
  const auto second = sample::session(db, 7, sample::start("P02"), store::SessionStatus::interrupted);
  const collector::PushOptions options{db, postgres.as("station_a"), "", "", {}, {}};

  auto report = collector::push(options);
  REQUIRE(report.sessions.size() == 2);
  CHECK(report.complete());
  CHECK(report.sessions[0].what == What::added);
  CHECK(report.sessions[0].trials == 12);
  auto server = postgres.admin();
  const auto count = [&](const std::string& table) {
    return server.query("SELECT count(*) FROM turnpoint." + table).integer(0, 0);
  };
  auto reader = sample::raw(db);
  const auto same_counts = [&] {
    for (const auto* table : {"session", "segment", "block", "trial", "tone", "signal", "event", "link",
                              "annotation", "enrolment"}) {
      INFO(table);
      CHECK(count(table) == reader.integer(std::string("SELECT count(*) FROM ") + table));
    }
  };
  same_counts();

  for (const auto& session : collector::push(options).sessions) CHECK(session.what == What::unchanged);

  {
    auto log = store::SessionLog::resume(db, second, sample::segment("resume"));
    log.begin_block(sample::block());
    log.append(sample::answered(7));
    // A running session is not sent. What the server has of it from before the resume stays.
    const auto meanwhile = collector::push(options);
    CHECK(meanwhile.running == 1);
    CHECK(count("trial") == 19);
    log.finish(store::SessionStatus::completed, "");
  }
  store::annotate(db, first, "a note that came later");
  report = collector::push(options);
  CHECK(report.sessions[0].what == What::extended);
  CHECK(report.sessions[0].trials == 0);
  CHECK(report.sessions[1].what == What::extended);
  CHECK(report.sessions[1].trials == 1);
  same_counts();
  CHECK(server.query("SELECT status FROM turnpoint.session WHERE session_id = $1", {second}).text(0, 0) ==
        "completed");
}

TEST_CASE("a server gives the same exports as the merged files of its stations", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto a = folder / "a.sqlite", b = folder / "b.sqlite", merged = folder / "merged.sqlite";
  const auto noted = sample::session(a, 6);
  store::annotate(a, noted, "dropped the stylus; \"twice\"");
  sample::session(a, 3, sample::start("P02"), store::SessionStatus::interrupted);
  sample::session(b, 5, at_station("bench-b", "P01"));
  sample::session(b, 4, at_station("bench-b", "P09"));
  collector::push({b, postgres.as("station_b"), "", "", {}, {}});
  collector::push({a, postgres.as("station_a"), "", "", {}, {}});
  store::merge(merged, a);
  store::merge(merged, b);
  const collector::ReadableDatabase fetched(postgres.address("reader"));
  const auto from_file = exported(merged, folder / "file"),
             from_server = exported(fetched.path(), folder / "server");
  CHECK(from_file.size() > 10);
  CHECK(from_server == from_file);
}

TEST_CASE("rows that were changed on the server are not read", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  sample::session(folder / "a.sqlite", 3);
  collector::push({folder / "a.sqlite", postgres.as("station_a"), "", "", {}, {}});
  postgres.admin().query("UPDATE turnpoint.trial SET level = level + 1 WHERE trial_index = 1");
  const auto message = message_of([&] { collector::ReadableDatabase fetched(postgres.address("reader")); });
  CHECK(sample::contains(message, "trial 1"));
  CHECK(sample::contains(message, "differs from what was recorded"));
}

TEST_CASE("the server calculates each checksum from what it stored", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  std::string id;
  {
    auto log = store::SessionLog::begin(db, sample::start(), sample::segment());
    id = log.session().session_id;
    store::EventRow test{1, "self_test", "passed", std::nullopt},
        question{2, "questionnaire", "", std::nullopt}, table{3, "friction_table", "used", std::nullopt};
    test.checks.push_back({"disk", store::Verdict::passed, 12.5, 1.0, "GB", "free"});
    question.answers.push_back({"sleep", "hours", 0, "7", 2.5});
    log.event(test);
    table.friction_levels.push_back({0.5, 6, 0.71, 0.7, 0.03, 0.63, 0.78});
    log.event(question);
    log.event(table);
    store::EventRow started{4, "program", "stairs", std::nullopt},
        given{5, "estimates", "stairs", std::nullopt};
    started.programs.push_back({"procedure", "stairs", "example", "1", "/stairs.py", std::string(64, 'c')});
    given.estimates.push_back({0, 0, "stairs", "threshold", -6, 1.5, ""});
    log.event(started);
    log.event(given);
    log.begin_block(sample::block());
    for (int i = 0; i < 3; ++i) log.append(sample::answered(i));
    log.finish(store::SessionStatus::completed, "");
  }
  store::annotate(db, id, "a note");
  auto server = postgres.admin();
  server.query("GRANT USAGE ON SCHEMA public TO turnpoint_owner");
  // Each of these changes makes the server store something other than what arrives.
  const std::pair<std::string, std::string> changes[] = {{"trial", "NEW.\"threshold_sd\" := 1.25"},
                                                         {"tone", "NEW.\"friction\" := NULL"},
                                                         {"signal", "NEW.data := NEW.data || '\\x00'"},
                                                         {"event", "NEW.value := NEW.value || ' '"},
                                                         {"self_test", "NEW.limit_value := 2"},
                                                         {"answer", "NEW.answer := '8'"},
                                                         {"friction_level", "NEW.sd := 0.04"},
                                                         {"program", "NEW.version := '2'"},
                                                         {"estimate", "NEW.mean := -5"},
                                                         {"segment", "NEW.boottime_ns := 0"},
                                                         {"block", "NEW.instruction := 'accuracy'"},
                                                         {"session", "NEW.kernel := 'other'"},
                                                         {"rig", "NEW.text := 'other'"},
                                                         {"annotation", "NEW.text := 'other'"}};
  for (const auto& [table, change] : changes) {
    INFO(table);
    server.query(
        fmt::format("CREATE OR REPLACE FUNCTION public.change() RETURNS trigger LANGUAGE plpgsql AS"
                    " $$ BEGIN {}; RETURN NEW; END $$",
                    change));
    server.query(fmt::format(
        "CREATE TRIGGER change BEFORE INSERT ON turnpoint.{} FOR EACH ROW EXECUTE FUNCTION public.change()",
        table));
    const auto report = collector::push({db, postgres.as("station_a"), "", "", {}, {}});
    CHECK(report.sessions.at(0).what == What::refused);
    CHECK_FALSE(report.complete());
    CHECK(server.query("SELECT count(*) FROM turnpoint.session").integer(0, 0) == 0);
    server.query(fmt::format("DROP TRIGGER change ON turnpoint.{}", table));
  }
  CHECK(collector::push({db, postgres.as("station_a"), "", "", {}, {}}).complete());
}

TEST_CASE("a session that was changed on the station is not sent, and the others are", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  const auto bad = sample::session(db, 3);
  const auto good = sample::session(db, 3, sample::start("P02"));
  auto raw = sample::raw(db);
  raw.execute("DROP TRIGGER trial_is_never_changed; UPDATE trial SET level = 0 WHERE session_id = '" + bad +
              "'");
  const auto report = collector::push({db, postgres.as("station_a"), "", "", {}, {}});
  REQUIRE(report.sessions.size() == 2);
  CHECK(report.sessions[0].what == What::refused);
  CHECK(report.sessions[0].session_id == bad);
  CHECK(report.sessions[1].what == What::added);
}

TEST_CASE("two continuations of one session are not mixed", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto db = folder / "a.sqlite", copy = folder / "copy.sqlite";
  const auto id = sample::session(db, 3, sample::start(), store::SessionStatus::interrupted);
  std::filesystem::copy_file(db, copy);
  const auto go_on = [&](const std::string& path, int trials) {
    auto log = store::SessionLog::resume(path, id, sample::segment("resume"));
    log.begin_block(sample::block());
    for (int i = 0; i < trials; ++i) log.append(sample::answered(3 + i));
    log.finish(store::SessionStatus::interrupted, "");
  };
  go_on(db, 1);
  go_on(copy, 2);
  CHECK(collector::push({db, postgres.as("station_a"), "", "", {}, {}}).complete());
  const auto report = collector::push({copy, postgres.as("station_a"), "", "", {}, {}});
  CHECK(report.sessions.at(0).what == What::refused);
  CHECK(sample::contains(report.sessions.at(0).problem, "another continuation"));
  CHECK(postgres.admin().query("SELECT count(*) FROM turnpoint.trial").integer(0, 0) == 4);
}

TEST_CASE("a server with another schema is refused with what to do", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  sample::session(folder / "a.sqlite", 2);
  const auto push = [&] { collector::push({folder / "a.sqlite", postgres.as("station_a"), "", "", {}, {}}); };
  postgres.admin().query("UPDATE turnpoint.version SET schema = schema - 1");
  CHECK(sample::contains(message_of(push), "update the server first"));
  CHECK(sample::contains(message_of([&] { collector::ReadableDatabase fetched(postgres.address("reader")); }),
                         "update the server"));
  postgres.admin().query("UPDATE turnpoint.version SET schema = schema + 2");
  CHECK(sample::contains(message_of(push), "update Turnpoint on this station"));
  postgres.admin().query("DROP SCHEMA turnpoint CASCADE");
  CHECK(sample::contains(message_of(push), "not a collector's database"));
}

TEST_CASE("sessions wait for a server that is away, and wrong clocks do not matter", "[collector]") {
  PostgresServer postgres;
  const TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  auto start = sample::start();
  start.started_local = "1970-01-01T00:00:00+00:00";
  auto segment = sample::segment();
  segment.realtime_ns = -5;
  {
    auto log = store::SessionLog::begin(db, start, segment);
    log.finish(store::SessionStatus::stopped, "");
  }
  postgres.stop();
  CHECK(sample::contains(message_of([&] {
                           collector::push({db, postgres.as("station_a"), "", "", {}, {}});
                         }),
                         "collector:"));
  sample::session(db, 2, sample::start("P02"));
  postgres.start();
  const auto report = collector::push({db, postgres.as("station_a"), "", "", {}, {}});
  CHECK(report.sessions.size() == 2);
  CHECK(report.complete());
}

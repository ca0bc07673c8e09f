#include <algorithm>
#include <string>
#include <vector>

#include "station/core/number.hpp"
#include "station/core/read_file.hpp"
#include "station/session/program_estimator.hpp"
#include "station/store/export.hpp"
#include "station/store/verify.hpp"
#include "station/view/report_data.hpp"
#include "tests/session/program_session.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using Catch::Matchers::ContainsSubstring;

namespace {

std::vector<core::ProgramRow> programs_in(const store::StoredSession& stored) {
  std::vector<core::ProgramRow> all;
  for (const auto& event : stored.events) all.insert(all.end(), event.programs.begin(), event.programs.end());
  return all;
}

std::vector<core::EstimateRow> estimates_in(const store::StoredSession& stored) {
  std::vector<core::EstimateRow> all;
  for (const auto& event : stored.events)
    all.insert(all.end(), event.estimates.begin(), event.estimates.end());
  return all;
}

/// Fails once, at message `at`, and removes the file "flag" before.
std::string failing_at(int at, const std::string& how) {
  return shell_procedure("[ -e flag ] && [ $n = " + std::to_string(at) + " ] && { rm flag; " + how + "; }");
}

}  // namespace

TEST_CASE("a session takes its levels from a program, and stores which program it was and what it estimated",
          "[programs][session]") {
  const ProgramSession session;
  const auto summary = session.run();
  CHECK(summary.status == core::SessionStatus::completed);
  CHECK(summary.answered == ProgramSession::trials);
  REQUIRE(summary.estimates.size() == 1);
  const auto stored = session.stored(summary.session_id);
  int right = 0;
  for (const auto& row : stored.blocks.at(0).trials) {
    CHECK(*row.level == -5 - right);
    right += *row.given.correct ? 1 : 0;
  }
  REQUIRE(right > 0);
  const auto programs = programs_in(stored);
  REQUIRE(programs.size() == 1);
  CHECK(programs[0] == core::ProgramRow{"procedure", "levels", "shell", "1", session.folder / "p",
                                        core::sha256(shell_procedure())});
  const auto estimates = estimates_in(stored);
  REQUIRE(estimates.size() == 1);
  CHECK(estimates[0].parameter == "threshold");
  CHECK(estimates[0].mean == -right);
  CHECK(estimates[0].sd == 0.5);
  CHECK(estimates[0].basis == std::to_string(right) + " right");
  CHECK(store::verify(session.setup.database).good());

  const auto report = view::report_data(session.setup.database, summary.session_id).front();
  REQUIRE(report.estimates.size() == 1);
  CHECK(report.estimates[0].mean == -right);
  CHECK(std::ranges::any_of(report.facts, [](const auto& fact) {
    return fact.first == "Program of levels" && fact.second.starts_with("shell 1, SHA-256 ");
  }));
  store::export_data(session.setup.database, session.folder / "csv", {});
  CHECK_THAT(core::read_file(session.folder / "csv/live/programs.csv"),
             ContainsSubstring(",procedure,levels,shell,1,"));
  CHECK_THAT(core::read_file(session.folder / "csv/live/estimates.csv"),
             ContainsSubstring(",levels,threshold,-"));
}

TEST_CASE("an estimator gets the trials of a session, and only those that count", "[programs][session]") {
  const ProgramSession session;
  const auto summary = session.run();
  const auto stored = session.stored(summary.session_id);
  auto blocks = stored.blocks;
  const auto& trials = blocks.at(0).trials;
  int right = 0;
  for (const auto& row : trials) right += *row.given.correct ? 1 : 0;
  const auto program =
      "program:" + std::string(TURNPOINT_SOURCE_DIR) + "/protocols/programs/right_answers.py,limit_s=60";
  const auto found = session::estimated_by(program, session.setup.protocol, blocks);
  CHECK(found.program.name == "right-answers");
  CHECK(found.estimates.at("proportion right").mean == Approx(right / 8.0));
  CHECK(found.estimates.at("proportion right").basis == "8 answers");

  // Void, practice and repeated trials do not count; a time limit of the settings leaves out others.
  blocks[0].trials[0].outcome = core::Outcome::fault;
  blocks.push_back(blocks[0]), blocks.back().start.practice = true, blocks.back().start.block_index = 1;
  CHECK(
      session::estimated_by(program, session.setup.protocol, blocks).estimates.at("proportion right").basis ==
      "7 answers");
  blocks.push_back(blocks[0]), blocks.back().start.attempt = 1, blocks.back().trials.clear();
  CHECK(session::estimated_by(program, session.setup.protocol, blocks).estimates.empty());
  CHECK(session::estimated_by(program + ",fastest_s=1000", session.setup.protocol, stored.blocks)
            .estimates.empty());
  CHECK_THROWS_WITH(session::estimated_by("program:" + (session.folder / "p") + ",limit_s=0.1",
                                          session.setup.protocol, blocks),
                    ContainsSubstring("did not reply within"));
}

TEST_CASE("a session is resumed as if its program had never failed, whenever that was",
          "[programs][session]") {
  const ProgramSession unbroken;
  const auto whole = unbroken.rows(unbroken.run().session_id);
  REQUIRE(whole.size() == ProgramSession::trials);
  // Message 2 asks for the first level; messages 2 i + 1 and 2 i + 2 follow trial i.
  for (int at = 1; at <= 2 + 2 * ProgramSession::trials; ++at) {
    INFO(at);
    const ProgramSession session(failing_at(at, "kill -9 $$"));
    std::ofstream(session.folder / "flag") << "";
    const auto broken = session.run();
    CHECK(broken.status == core::SessionStatus::interrupted);
    CHECK_THAT(broken.reason, ContainsSubstring("killed by signal 9"));
    const auto before = session.rows(broken.session_id);
    CHECK(before.size() == static_cast<std::size_t>(at < 3 ? 0 : (at - 1) / 2));  // every answer was kept
    if (before.empty()) continue;  // there is nothing to resume
    const auto resumed = session.resume(broken.session_id);
    CHECK(resumed.status == core::SessionStatus::completed);
    CHECK(session.rows(broken.session_id) == whole);
    const auto stored = session.stored(broken.session_id);
    CHECK(programs_in(stored).size() == 2);  // once in each segment
    REQUIRE(estimates_in(stored).size() == 1);
    CHECK(store::verify(session.setup.database).good());
  }
}

TEST_CASE(
    "a session whose program misbehaves is interrupted with the reason, and continues when it is repaired",
    "[programs][session]") {
  const auto [how, limit_s, says] = GENERATE(
      std::tuple("echo garbage", "30", "not a JSON object"),
      std::tuple("echo '{\"type\":\"level\",\"id\":4,\"level\":25}'", "30", "gives level 25"),
      std::tuple("sleep 1000", "0.2", "did not reply within 0.2 s"),
      std::tuple("head -c 70000 /dev/zero | tr '\\0' x; echo", "30", "a line of more than 65536 bytes"));
  const ProgramSession unbroken;
  const auto whole = unbroken.rows(unbroken.run().session_id);
  const ProgramSession session(failing_at(8, how), limit_s);
  std::ofstream(session.folder / "flag") << "";
  const auto broken = session.run();
  CHECK(broken.status == core::SessionStatus::interrupted);
  CHECK_THAT(broken.reason, ContainsSubstring(says));
  CHECK(session.rows(broken.session_id).size() == 3);
  CHECK(session.resume(broken.session_id).status == core::SessionStatus::completed);
  CHECK(session.rows(broken.session_id) == whole);
}

TEST_CASE("a changed program may continue a session only if it gives the stored levels",
          "[programs][session]") {
  // With the file "again" beside it, it begins 3 levels lower.
  const auto program =
      replaced(failing_at(10, "exit 1"), "right=0 n=0", "right=$([ -e again ] && echo 3 || echo 0) n=0");
  const ProgramSession session(program);
  std::ofstream(session.folder / "flag") << "";
  const auto broken = session.run();
  REQUIRE(broken.status == core::SessionStatus::interrupted);
  SECTION("the same levels: it continues, and a note says so") {
    session.write(shell_procedure("", "2"));
    CHECK(session.resume(broken.session_id).status == core::SessionStatus::completed);
    const auto stored = session.stored(broken.session_id);
    REQUIRE(stored.session.annotations.size() == 1);
    CHECK_THAT(stored.session.annotations[0],
               ContainsSubstring("has changed since the session was interrupted: version 1"));
    const auto programs = programs_in(stored);
    REQUIRE(programs.size() == 2);
    CHECK(programs[0].sha256 != programs[1].sha256);
    CHECK(programs[1].version == "2");
  }
  SECTION("other levels: it is refused, and nothing changes") {
    session.write(replaced(shell_procedure("", "2"), "5 + right", "6 + right"));
    const auto before = session.stored(broken.session_id).session;
    CHECK_THROWS_WITH(session.resume(broken.session_id),
                      ContainsSubstring("stored trial 0 cannot be replayed") &&
                          ContainsSubstring("now gives level -6") &&
                          ContainsSubstring("has changed since it was stored: its version was 1") &&
                          ContainsSubstring("and is 2"));
    const auto after = session.stored(broken.session_id).session;
    CHECK(after.status == core::SessionStatus::interrupted);
    CHECK(after.checksum == before.checksum);
    CHECK(after.segments == 1);
  }
  SECTION("the same file, but other levels") {
    std::ofstream(session.folder / "again") << "";
    CHECK_THROWS_WITH(session.resume(broken.session_id),
                      ContainsSubstring("now gives level -8, but level -5 is stored") &&
                          ContainsSubstring("does not give the same levels for the same seed and answers"));
  }
  SECTION("no file: it is refused, and nothing changes") {
    std::filesystem::remove(session.folder / "p");
    CHECK_THROWS_WITH(session.resume(broken.session_id), ContainsSubstring("there is no such file"));
    CHECK(session.stored(broken.session_id).session.segments == 1);
  }
}

TEST_CASE("a session with people pauses when its program dies, and Continue starts the program again",
          "[programs][session][live]") {
  using live_room::PageKind;
  const ProgramSession unbroken;
  ProgramSession session(failing_at(8, "echo 'out of paper' >&2; exit 4"));
  std::ofstream(session.folder / "flag") << "";
  session.setup.observer.clear();
  session.setup.run_mode = core::RunMode::pilot;
  live_room::Room room;
  room.reacts = [&](const auto& page) { room.cooperate(page); };
  const auto summary = session::run(session.setup, &room, room.inputs, room.devices());
  CHECK(summary.status == core::SessionStatus::completed);
  CHECK(summary.answered == ProgramSession::trials);
  std::vector<session::Page> faults;
  for (const auto& page : room.pages)
    if (page.kind == PageKind::fault && page.fault.kind == core::FaultKind::program) faults.push_back(page);
  REQUIRE(faults.size() == 1);
  CHECK_THAT(faults[0].fault.detail, ContainsSubstring("ended with status 4: \"out of paper\""));
  // Every answer is "left", which is right for levels below 0, so each level is 1 lower than the one before.
  const auto stored = session.stored(summary.session_id);
  double level = -5;
  for (const auto& row : stored.blocks.at(0).trials) CHECK(*row.level == level--);
  CHECK(std::ranges::count_if(stored.events, [](const auto& event) {
          return event.kind == "fault" && event.value.starts_with("program: ");
        }) == 1);
  CHECK(programs_in(stored).size() == 2);
}

TEST_CASE("a session with people that stops at the page of a failed program can be resumed",
          "[programs][session][live]") {
  ProgramSession session(failing_at(8, "exit 4"));
  std::ofstream(session.folder / "flag") << "";
  session.setup.observer.clear();
  session.setup.run_mode = core::RunMode::pilot;
  live_room::Room room;
  room.reacts = [&](const auto& page) {
    if (page.kind == live_room::PageKind::fault && page.fault.kind == core::FaultKind::program)
      room.push(live_room::input::Stop{});
    else
      room.cooperate(page);
  };
  const auto broken = session::run(session.setup, &room, room.inputs, room.devices());
  CHECK(broken.status == core::SessionStatus::interrupted);
  CHECK(session.rows(broken.session_id).size() == 3);
  live_room::Room next;
  next.reacts = [&](const auto& page) { next.cooperate(page); };
  session.setup.resume_session = broken.session_id;
  CHECK(session::run(session.setup, &next, next.inputs, next.devices()).status ==
        core::SessionStatus::completed);
  double level = -5;
  const auto stored = session.stored(broken.session_id);
  for (const auto& row : stored.blocks.at(0).trials) CHECK(*row.level == level--);
}

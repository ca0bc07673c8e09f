#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "station/core/draws.hpp"
#include "station/core/usage_error.hpp"
#include "station/procedure/trace.hpp"
#include "station/session/programs.hpp"
#include "tests/session/written_program.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/quick_rig.hpp"

using namespace turnpoint;
using procedure::Answer;

namespace {

const std::string kSource = TURNPOINT_SOURCE_DIR;
using Catch::Matchers::ContainsSubstring;

/// Answers a procedure until it is done; every `nth` answer is wrong, and one in 13 is missing.
std::vector<double> levels_of(procedure::Procedure& procedure, int nth, int most = 1000) {
  std::vector<double> levels;
  while (const auto proposal = procedure.next()) {
    levels.push_back(proposal->level);
    const auto i = static_cast<int>(levels.size());
    procedure.record(i % 13 == 0 ? Answer::none : i % nth == 0 ? Answer::zero : Answer::one);
    if (i == most) break;
  }
  return levels;
}

}  // namespace

TEST_CASE("the Python example gives the same levels and the same estimate as the built-in staircase",
          "[programs]") {
  auto spec = program_spec(kSource + "/protocols/programs/one_up_two_down.py", 400);
  spec.min = -34;
  spec.program.settings =
      core::parse_toml("start = -5.0\nstep = [4.0, 2.0, 1.0]\nreversals = 12\n", "settings");
  procedure::Spec built_in;
  built_in.name = "built-in", built_in.kind = procedure::Kind::up_down, built_in.level = spec.level;
  built_in.start = -5, built_in.min = -34, built_in.max = -3, built_in.step = {4, 2, 1};
  built_in.n_down = 2, built_in.stop.reversals = 12;
  session::Programs programs(kSource + "/protocols/friction-program.toml");
  procedure::Context context;
  context.programs = &programs;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    core::Draws draws({seed, core::Stream::observer, 0, 0, 0});
    const auto program = procedure::make_procedure(spec, context, {}),
               known = procedure::make_procedure(built_in, {}, {});
    int trials = 0;
    for (; program->next(); ++trials) {
      REQUIRE(known->next());
      REQUIRE(program->next()->level == known->next()->level);
      const double drawn = draws.uniform();
      const auto answer = drawn < 0.05 ? Answer::none : drawn < 0.7 ? Answer::one : Answer::zero;
      program->record(answer), known->record(answer);
    }
    CHECK_FALSE(known->next());
    CHECK(trials > 12);
    const auto mine = program->estimates().at("threshold"), theirs = known->estimates().at("threshold");
    CHECK(mine.mean == Approx(theirs.mean).epsilon(1e-14));
    CHECK(mine.sd.value() == Approx(theirs.sd.value()).epsilon(1e-12));
    CHECK(mine.basis == theirs.basis);
  }
  const auto started = programs.take_started();
  REQUIRE(started.size() == 1);
  CHECK(started[0].program == "one-up-two-down");
  CHECK(started[0].version == "1.0");
  CHECK(started[0].sha256.size() == 64);
}

TEST_CASE("a program that is killed and started again continues with the same levels", "[programs]") {
  const TemporaryFolder folder;
  const auto path = written_program(folder / "p", shell_procedure());
  session::Programs programs(folder / "protocol.toml");
  const auto whole = levels_of(*programs.procedure(program_spec(path, 40), {}), 4);
  CHECK(whole.size() == 40);
  CHECK(whole.front() == -5);
  CHECK(*std::ranges::min_element(whole) == -24);
  const auto unbroken = programs.procedure(program_spec(path, 40), {});
  levels_of(*unbroken, 4);
  // Message 2 + 2 i is the question for level i.
  for (int at = 1; at <= 82; ++at) {
    INFO(at);
    const auto flag = folder / "flag";
    std::ofstream(flag) << at << '\n';
    const auto broken = written_program(
        folder / "q",
        shell_procedure("[ -e flag ] && read -r at <flag && [ $n = $at ] && { rm flag; kill -9 $$; }"));
    const auto procedure = programs.procedure(program_spec(broken, 40), {});
    int failures = 0;
    std::vector<double> levels;
    for (;;) try {
        const auto proposal = procedure->next();
        if (!proposal) break;
        levels.push_back(proposal->level);
        const auto i = static_cast<int>(levels.size());
        procedure->record(i % 13 == 0 ? Answer::none : i % 4 == 0 ? Answer::zero : Answer::one);
      } catch (const core::ProgramFailed& failed) {
        CHECK_THAT(failed.what(), ContainsSubstring("killed by signal 9"));
        REQUIRE(++failures == 1);
      }
    CHECK(failures == 1);
    CHECK(levels == whole);
    CHECK(procedure->state_hash() == unbroken->state_hash());
    CHECK(procedure->estimates().at("threshold").mean == unbroken->estimates().at("threshold").mean);
  }
}

TEST_CASE("whatever else a program does is refused with its reason", "[programs]") {
  struct Case {
    const char *before, *says;
  };
  const auto [before, says] = GENERATE(
      Case{"[ $n = 4 ] && { echo broken >&2; exit 3; }", "ended with status 3: \"broken\""},
      Case{"[ $n = 1 ] && exit 0", "ended with status 0"},
      Case{"[ $n = 1 ] && echo '{\"id\":2,\"type\":\"level\",\"level\":-5}'",
           "did not begin with the message \"hello\""},
      Case{"[ $n = 1 ] && echo "
           "'{\"type\":\"hello\",\"format\":\"turnpoint-program/2\",\"program\":\"a\",\"version\":\"1\"}'",
           "speaks \"turnpoint-program/2\"; this version of turnpoint speaks \"turnpoint-program/1\""},
      Case{"[ $n = 1 ] && echo '{\"type\":\"hello\",\"format\":\"turnpoint-program/1\",\"program\":\"a\"}'",
           "\"version\" must be a text"},
      Case{"[ $n = 4 ] && echo garbage", "wrote \"garbage\", which is not a JSON object with a \"type\""},
      Case{"[ $n = 4 ] && echo '[1, 2]'", "which is not a JSON object"},
      Case{"[ $n = 4 ] && printf '\\377\\n'", "which is not a JSON object"},
      Case{"[ $n = 4 ] && echo '{\"id\":2,\"type\":\"leval\",\"level\":-5}'",
           "replied \"leval\" to \"next\""},
      Case{"[ $n = 4 ] && echo '{\"id\":2,\"type\":\"level\"}'", "\"level\" must be a finite number"},
      Case{"[ $n = 4 ] && echo '{\"id\":2,\"type\":\"level\",\"level\":\"-5\"}'",
           "\"level\" must be a finite number"},
      Case{"[ $n = 4 ] && echo '{\"id\":2,\"type\":\"level\",\"level\":1e999}'", "not a JSON object"},
      Case{"[ $n = 4 ] && echo '{\"id\":2,\"type\":\"level\",\"level\":-31}'",
           "gives level -31; the protocol allows -30 to -3"},
      Case{"[ $n = 4 ] && echo '{\"id\":2,\"type\":\"level\",\"level\":-5,\"estimates\":{\"threshold\":-5}}'",
           "each of \"estimates\" must be an object"},
      Case{"[ $n = 4 ] && echo "
           "'{\"id\":2,\"type\":\"level\",\"level\":-5,\"estimates\":{\"t\":{\"mean\":1,\"sd\":-1}}}'",
           "\"sd\" must not be negative"},
      Case{"[ $n = 4 ] && echo '{\"type\":\"error\",\"message\":\"no start\"}'", "reports \"no start\""},
      Case{"[ $n = 4 ] && { head -c 70000 /dev/zero | tr '\\0' x; echo; }",
           "wrote a line of more than 65536 bytes"},
      Case{"[ $n = 4 ] && { head -c 3000000 /dev/zero | tr '\\0' x; }",
           "wrote a line of more than 65536 bytes"},
      Case{"[ $n = 4 ] && { exec >/dev/null; sleep 1000; }", "closed its standard output"});
  INFO(before);
  const TemporaryFolder folder;
  session::Programs programs(folder / "protocol.toml");
  const auto procedure =
      programs.procedure(program_spec(written_program(folder / "p", shell_procedure(before)), 40), {});
  CHECK_THROWS_WITH(levels_of(*procedure, 4), ContainsSubstring(says) && ContainsSubstring(folder / "p"));
}

TEST_CASE("a reply to another question is refused", "[programs]") {
  const TemporaryFolder folder;
  session::Programs programs(folder / "protocol.toml");
  // It replies to its second question twice.
  const auto path = written_program(
      folder / "p", shell_procedure("[ $n = 4 ] && echo '{\"id\":2,\"type\":\"level\",\"level\":-5}'"));
  const auto procedure = programs.procedure(program_spec(path, 40), {});
  CHECK_THROWS_WITH(levels_of(*procedure, 4),
                    ContainsSubstring("to question 3; \"id\" must be that of the question"));
  const auto without = written_program(
      folder / "q", shell_procedure("[ $n = 4 ] && echo '{\"type\":\"level\",\"level\":-5}'"));
  CHECK_THROWS_WITH(levels_of(*programs.procedure(program_spec(without, 40), {}), 4),
                    ContainsSubstring("\"id\" must be a finite number"));
}

TEST_CASE("a program that is late is refused with the limit of the protocol", "[programs]") {
  const TemporaryFolder folder;
  session::Programs programs(folder / "protocol.toml");
  const auto path = written_program(folder / "p", shell_procedure("[ $n = 2 ] && sleep 1000"));
  const auto procedure = programs.procedure(program_spec(path, 40, 0.05), {});
  CHECK_FALSE(procedure->ready());
  CHECK_THROWS_WITH(procedure->next(), ContainsSubstring("did not reply within 0.05 s"));
}

TEST_CASE("a program that gives other levels when it is started again is refused", "[programs]") {
  const TemporaryFolder folder;
  session::Programs programs(folder / "protocol.toml");
  // It counts its starts in a file, and its second self begins with another level.
  const auto path = written_program(
      folder / "p", shell_procedure("[ $n = 1 ] && { echo >> starts; right=$(($(wc -l < starts) - 1)); }\n"
                                    "  [ $n = 8 ] && [ $(wc -l < starts) = 1 ] && exit 1"));
  const auto procedure = programs.procedure(program_spec(path, 40), {});
  CHECK_THROWS_WITH(levels_of(*procedure, 4), ContainsSubstring("ended with status 1"));
  CHECK_THROWS_WITH(
      procedure->next(),
      ContainsSubstring("was started again and now gives level -6 in trial 1, in which it gave level -5"));
}

TEST_CASE("the problems of a protocol's programs stand at their places", "[programs]") {
  const auto source = replaced(core::read_file(kSource + "/protocols/friction-program.toml"), "limit_s = 2.0",
                               "limit_s = 60.0");
  const auto good = protocol::parse(source, kSource + "/protocols/p.toml");
  CHECK(session::problems_of(good).empty());
  const auto missing = protocol::parse(source, "/nowhere/p.toml");
  const auto problems = session::problems_of(missing);
  REQUIRE(problems.size() == 1);
  CHECK(
      problems[0].place.line ==
      1 + std::count(source.begin(), source.begin() + static_cast<long>(source.find("program = \"")), '\n'));
  CHECK_THAT(core::format(problems[0]),
             ContainsSubstring("/nowhere/programs/one_up_two_down.py: there is no such file"));
  const auto wrong =
      protocol::parse(replaced(source, "start = -5.0", "begin = -5.0"), kSource + "/protocols/p.toml");
  REQUIRE(session::problems_of(wrong).size() == 1);
  CHECK_THAT(core::format(session::problems_of(wrong)[0]), ContainsSubstring("KeyError: 'start'"));
}

TEST_CASE("without somebody who starts programs, a program cannot be a procedure", "[programs]") {
  CHECK_THROWS_AS(procedure::make_procedure(program_spec("p", 3), {}, {}), std::logic_error);
  procedure::StandIns stand_ins;
  procedure::Context context;
  context.programs = &stand_ins;
  const auto levels = levels_of(*procedure::make_procedure(program_spec("p", 50), context, {}), 4);
  CHECK(levels.size() == 50);
  CHECK(*std::ranges::min_element(levels) == -30);
  CHECK(*std::ranges::max_element(levels) == -3);
}

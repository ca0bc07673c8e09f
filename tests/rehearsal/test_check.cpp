#include "station/rehearsal/check.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "station/core/read_file.hpp"
#include "station/rehearsal/parallel.hpp"
#include "station/rehearsal/rehearsal.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;

namespace {

std::vector<rehearsal::SessionLength> lengths(const protocol::Protocol& protocol, std::uint64_t first_seed,
                                              int sessions) {
  std::vector<rehearsal::SessionLength> all(static_cast<std::size_t>(sessions));
  rehearsal::in_parallel(sessions, rehearsal::processors(), {}, [&](int i) {
    all[static_cast<std::size_t>(i)] =
        rehearsal::session_length(protocol, first_seed + static_cast<std::uint64_t>(i));
  });
  return all;
}

std::vector<double> values_of(const std::vector<rehearsal::SessionLength>& lengths,
                              double rehearsal::SessionLength::*what) {
  std::vector<double> values;
  for (const auto& length : lengths) values.push_back(length.*what);
  return values;
}

}  // namespace

TEST_CASE("the duration estimated by check is that of a rehearsed session plus the time that people need",
          "[check]") {
  const std::string root = TURNPOINT_SOURCE_DIR;
  const auto path = root + "/protocols/friction-2ifc.toml";
  const auto check = rehearsal::check(path, root + "/tests/support/thin_plate.toml", {1});
  const auto protocol = protocol::load(path);
  const auto rehearsal = rehearsal::rehearse(
      protocol, 0, 0, rehearsal::rehearser(simulation::Observer(simulation::Parameters{})));
  REQUIRE(check.simulated_sessions == 1);
  CHECK(check.trials.median == rehearsal.trials);
  // In a task with two intervals nobody explores the surface. So the estimate adds only instructions and
  // breaks to the time of the trials.
  const auto order = protocol::block_order(protocol, 0);
  double beside_s = 0;
  for (const auto& [start, trials] : rehearsal.blocks) {
    beside_s += 12;
    if (const auto& rest = order[static_cast<std::size_t>(start.block_index)].break_after)
      beside_s +=
          rest->min_s * static_cast<double>((trials.size() - 1) / static_cast<std::size_t>(rest->trials));
  }
  CHECK(check.duration_s.median == Approx(rehearsal.duration_s + beside_s));
}

TEST_CASE("the blocks of a session take the time of the session together, each its own share", "[check]") {
  const std::string root = TURNPOINT_SOURCE_DIR;
  const auto check = rehearsal::session_lengths(protocol::load(root + "/protocols/speed-accuracy.toml"), 1);
  double sum_s = 0, fast_s = 0, careful_s = 0;
  for (const auto& block : check.blocks) {
    CHECK(block.duration_s.median > block.trials.median);  // a trial takes more than a second
    sum_s += block.duration_s.median;
    (block.instruction == "speed" ? fast_s : careful_s) += block.duration_s.median;
  }
  CHECK(sum_s == Approx(check.duration_s.median));
  CHECK(fast_s < careful_s);
}

TEST_CASE("a procedure that continues has fewer trials on the second day, and check says how many",
          "[check]") {
  const std::string root = TURNPOINT_SOURCE_DIR;
  TemporaryFolder folder;
  auto text = core::read_file(root + "/protocols/friction-time-limit.toml");
  const auto training = text.find("name = \"training\"");
  REQUIRE(training != std::string::npos);
  const auto stop = text.find("stop = ", training), end = text.find('\n', stop);
  text.replace(stop, end - stop, "stop = { trials = 40 }");
  const std::string path = folder / "a.toml";
  std::ofstream(path) << text;
  const auto check = rehearsal::check(path, root + "/tests/support/thin_plate.toml", {2});
  REQUIRE(check.problems.empty());
  std::map<int, double> trained;
  for (const auto& block : check.blocks)
    if (block.name == "training") trained[block.session] = block.trials.median;
  CHECK(trained.at(1) == 30);
  CHECK(trained.at(2) == 10);
}

TEST_CASE("a protocol that nobody can answer in time does not end, and check says so", "[check]") {
  const std::string root = TURNPOINT_SOURCE_DIR;
  TemporaryFolder folder;
  auto text = core::read_file(root + "/protocols/friction-rating.toml");
  const auto deadline = text.find("deadline_s"), end = text.find('\n', deadline);
  REQUIRE(deadline != std::string::npos);
  text.replace(deadline, end - deadline, "deadline_s = 0.05");
  const std::string path = folder / "a.toml";
  std::ofstream(path) << text;
  const auto check = rehearsal::check(path, root + "/tests/support/thin_plate.toml", {1});
  REQUIRE(check.problems.size() == 1);
  CHECK(core::say(check.problems[0].what, "en").find("does not end") != std::string::npos);
  CHECK(core::say(check.problems[0].what, "en").find("a.toml") == std::string::npos);
}

namespace {

/// Checks a protocol that comes with the program, in which the first `from` is replaced.
rehearsal::Check checked_with(const std::string& name, const std::string& from, const std::string& to) {
  const std::string root = TURNPOINT_SOURCE_DIR;
  auto text = core::read_file(root + "/protocols/" + name + ".toml");
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  text.replace(at, from.size(), to);
  const TemporaryFolder folder;
  const std::string path = folder / "a.toml";
  std::ofstream(path) << text;
  return rehearsal::check(path, root + "/tests/support/thin_plate.toml", {3});
}

/// What the notes say of the simulated observer, each with its line.
std::vector<std::string> of_observer(const rehearsal::Check& check) {
  std::vector<std::string> all;
  for (const auto& note : check.notes)
    if (core::say(note.what, "en").find("the simulated observer") != std::string::npos)
      all.push_back(std::to_string(note.place.line) + ": " + core::say(core::phrase_of(note), "en"));
  return all;
}

}  // namespace

TEST_CASE("times that do not suit the simulated observer are facts about the observer, and no bad protocol",
          "[check]") {
  const auto usual = checked_with("friction-rating", "deadline_s = 4.0", "deadline_s = 4.0");
  CHECK(of_observer(usual).empty());
  const struct {
    const char *usual, *times, *said;
  } cases[] = {
      {"deadline_s = 4.0", "deadline_s = 0.3",
       "needs 0.5 s outside its decision (its residual and travel), so a deadline of "
       "0.3 s leaves it no time to decide"},
      {"deadline_s = 4.0", "deadline_s = 0.5", "a deadline of 0.5 s leaves it no time"},
      {"deadline_s = 4.0", "deadline_s = 0.55", "a deadline of 0.55 s leaves it only 0.05 s to decide"},
      {"deadline_s = 4.0", "deadline_s = 0.6", nullptr},
      {"anticipation_s = 0.0", "anticipation_s = 0.5", nullptr},
      {"anticipation_s = 0.0", "anticipation_s = 0.9",
       "may answer after 0.5 s (its residual and travel), and answers before 0.9 s count as too early"}};
  for (const auto& [before, times, said] : cases) {
    INFO(times);
    const auto check = checked_with("friction-rating", before, times);
    CHECK(check.problems.empty());
    CHECK(check.trials.median < 1.1 * usual.trials.median);
    CHECK(check.trials.median > 0.9 * usual.trials.median);
    const auto notes = of_observer(check);
    REQUIRE(notes.size() == (said == nullptr ? 0 : 1));
    if (said == nullptr) continue;
    INFO(notes[0]);
    CHECK(notes[0].find(said) != std::string::npos);
    CHECK(notes[0].find("--observer sim:residual=...,travel=...") != std::string::npos);
    CHECK(notes[0].substr(0, 2) != "0:");
  }
  // the deadline of an instruction; that of the other instruction suits the observer
  const auto instructed = checked_with("speed-accuracy", "deadline_s = 0.8", "deadline_s = 0.5");
  REQUIRE(of_observer(instructed).size() == 1);
  CHECK(of_observer(instructed)[0].find("a deadline of 0.5 s") != std::string::npos);
  CHECK(of_observer(checked_with("speed-accuracy", "deadline_s = 0.8", "deadline_s = 0.8")).empty());
  // answers are not taken before 1.5 s, so that none is too early
  const std::string times = "\ndeadline_s = 3.0\niti_s = { uniform = [0.8, 1.2] }\nanticipation_s = ";
  for (const auto& [early, notes] : {std::pair{"0.9", 0}, {"1.6", 1}})
    CHECK(of_observer(checked_with("friction-2ifc", "response_zero = \"interval_off\"" + times + "0.0",
                                   "response_zero = \"go_cue\"" + times + early))
              .size() == static_cast<std::size_t>(notes));
  // answers are not taken before the deadline
  for (const std::string zero : {"go_cue", "first_contact"}) {
    const auto closed = checked_with("friction-2ifc", "response_zero = \"interval_off\"\ndeadline_s = 3.0",
                                     "response_zero = \"" + zero + "\"\ndeadline_s = 0.4");
    REQUIRE(of_observer(closed).size() == 1);
    CHECK(of_observer(closed)[0].find("can answer only when the last interval has ended") !=
          std::string::npos);
    CHECK(std::any_of(closed.warnings.begin(), closed.warnings.end(), [](const auto& warning) {
      return core::say(warning.what, "en").find("answers are accepted when the last interval") !=
             std::string::npos;
    }));
  }
  // after a signal the observer is as quick as it has to be
  CHECK(of_observer(checked_with("response-signal", "window_s = 0.4", "window_s = 0.2")).empty());
}

TEST_CASE("check says in which languages the station's own words are, and refuses what cannot be drawn",
          "[check]") {
  const std::string root = TURNPOINT_SOURCE_DIR, rig = root + "/tests/support/thin_plate.toml";
  const auto [language, note] =
      GENERATE(std::pair("ko", "the station does not speak \"ko\""),
               std::pair("zh", "no native speaker has read the station's own words in \"zh\""));
  const TemporaryFolder folder;
  const auto path = folder / "study.toml";
  auto text = core::read_file(root + "/protocols/friction-2ifc.toml");
  const auto replace = [&text](const std::string& from, const std::string& to) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
  };
  replace("\"de\"", std::string("\"") + language + "\"");
  replace("de = \"", std::string(language) + " = \"\u6211");
  std::ofstream(path) << text;
  rehearsal::CheckOptions options;
  options.sessions = 0;
  const auto check = rehearsal::check(path, rig, options);
  REQUIRE(check.problems.empty());
  REQUIRE(check.notes.size() == 1);
  CHECK(core::say(check.notes[0].what, "en").find(note) == 0);

  options.drawable = [](char32_t c) { return c < 0x3000; };
  const auto warned = rehearsal::check(path, rig, options);
  CHECK(warned.problems.empty());
  CHECK(std::find(warned.languages.begin(), warned.languages.end(), language) == warned.languages.end());
  CHECK_FALSE(warned.languages.empty());
  int told = 0;
  for (const auto& warning : warned.warnings)
    if (warning.place.file == path && core::format(warning).find("U+6211") != std::string::npos) {
      CHECK(warning.place.line > 0);
      ++told;
    }
  CHECK(told == 1);
}

TEST_CASE("check lists what comes before and after the blocks, in the order of the session", "[check]") {
  const std::string root = TURNPOINT_SOURCE_DIR;
  const auto check =
      rehearsal::check(root + "/protocols/boundary-visit.toml", root + "/deploy/rigs/simulated.toml", {1});
  REQUIRE(check.blocks.size() == 2);
  using Kind = protocol::InterludeKind;
  const auto& first = check.blocks.front().before;
  REQUIRE(first.size() > 1);
  CHECK(first.back().kind == Kind::explanation);
  CHECK(first.back().pages == 2);
  REQUIRE(check.blocks.back().before.size() == 1);
  CHECK(check.blocks.back().before.front().kind == Kind::screening);
  REQUIRE(check.blocks.back().after.size() == 1);
  CHECK(check.blocks.back().after.front().name == "afterwards");
  CHECK(check.blocks.front().after.empty());
}

TEST_CASE("the duration estimated by check includes time to set a slider", "[check]") {
  const std::string root = TURNPOINT_SOURCE_DIR;
  const auto path = root + "/protocols/boundary-adjustment.toml";
  const auto check = rehearsal::check(path, root + "/tests/support/thin_plate.toml", {1});
  const auto protocol = protocol::load(path);
  const double longest_s = protocol.timing.explore_s.value();
  const double setting_s = longest_s < 15 ? longest_s : 15;
  CHECK(check.duration_s.median > check.trials.median * setting_s);
  CHECK(check.duration_s.median < check.trials.median * (setting_s + 5) + 60);
}

TEST_CASE("check adds sessions until the length is known to 3 %, and other sessions have this length",
          "[check]") {
  int missed = 0, told = 0;
  for (const char* name :
       {"friction-staircase", "friction-time-limit", "limits-boundary", "friction-training"}) {
    INFO(name);
    const auto protocol = protocol::load(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/" + name + ".toml");
    const auto check = rehearsal::session_lengths(protocol);
    const bool enough = check.duration_s.error <= rehearsal::kLengthPrecision * check.duration_s.median &&
                        check.trials.error <= rehearsal::kLengthPrecision * check.trials.median;
    CHECK((enough || check.simulated_sessions > 900));
    if (!check.blocks.empty() && !check.blocks.front().visit.empty()) continue;
    const auto others = lengths(protocol, 2000, 600);
    const auto spread = rehearsal::spread_of(values_of(others, &rehearsal::SessionLength::duration_s));
    for (const auto what : {&rehearsal::Spread::low, &rehearsal::Spread::median, &rehearsal::Spread::high}) {
      const double apart = std::abs(check.duration_s.*what - spread.*what);
      CHECK(apart <= 2 * (check.duration_s.error + spread.error));
      missed += apart > check.duration_s.error + spread.error, ++told;
    }
    // a smaller stated error would not hold
    const auto few = rehearsal::session_lengths(protocol, 2);
    CHECK(few.duration_s.error < check.duration_s.high - check.duration_s.low);
  }
  CHECK(told >= 6);
  CHECK(missed <= 1);
}

TEST_CASE("the error of a range holds the ranges of 95 % of other samples", "[check]") {
  std::uint64_t state = 1;
  const auto draw = [&state] {
    double sum = 0;
    for (int i = 0; i < 12; ++i) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      sum += static_cast<double>(state >> 11) * 0x1p-53;
    }
    return sum - 6;
  };
  int held = 0, halves = 0;
  constexpr int samples = 1000;
  for (int i = 0; i < samples; ++i) {
    std::vector<double> values(40);
    for (auto& value : values) value = draw();
    const auto spread = rehearsal::spread_of(values);
    const double apart =
        std::max({std::abs(spread.low + 1.645), std::abs(spread.median), std::abs(spread.high - 1.645)});
    held += apart <= spread.error, halves += apart <= 0.5 * spread.error;
  }
  CHECK(held > 0.95 * samples);
  CHECK(halves < 0.9 * samples);
}

TEST_CASE(
    "response times from the finger's contact or lift-off, and tasks whose answers wait, can be simulated",
    "[check]") {
  const std::string root = TURNPOINT_SOURCE_DIR;
  const auto text = core::read_file(root + "/protocols/friction-2ifc.toml");
  const std::string key = "response_zero = \"interval_off\"";
  REQUIRE(text.find(key) != std::string::npos);
  const TemporaryFolder folder;
  for (const std::string zero : {"first_contact", "lift_off", "go_cue", "interval_off"}) {
    INFO(zero);
    auto changed = text;
    changed.replace(changed.find(key), key.size(), "response_zero = \"" + zero + "\"");
    const auto path = folder / (zero + ".toml");
    std::ofstream(path) << changed;
    int trials = 0, answered = 0;
    for (const auto& block :
         rehearsal::rehearse(protocol::load(path), 0, 0,
                             rehearsal::rehearser(simulation::Observer(simulation::Parameters{})))
             .blocks)
      for (const auto& row : block.trials) {
        ++trials, answered += row.outcome == core::Outcome::answered;
        if (zero != "first_contact") continue;
        // the finger leaves the surface before the answer, for the time that it needs to reach the button
        CHECK(row.timing.decision_time_s.has_value() == (row.outcome == core::Outcome::answered));
      }
    CHECK(answered > 0.95 * trials);
  }
}

TEST_CASE("simulated settings are around the place where the two scenes of the interval are equal",
          "[check]") {
  const std::string root = TURNPOINT_SOURCE_DIR;
  const TemporaryFolder folder;
  const auto mean_of = [&](const std::string& standard, const std::string& intervals, const std::string& zero,
                           const std::string& times = "explore_s = 28.0\ndeadline_s = 30.0\n") {
    const auto path = folder / "settings.toml";
    std::ofstream(path) << R"(format = "friction-protocol/1"
protocol = { id = "settings", version = "1.0.0", title = "Settings", languages = ["en"] }
factor = [ { name = "strength", range = [0.4, 1.6] } ]
procedure = [ { name = "settings", kind = "adjustment", level = "strength", start = [0.5, 1.5], repeats = 20 } ]
block = [ { name = "main", procedures = ["settings"] } ]
[scene.standard]
boundary_mm = 158.0
edge = "p50"
displacement_um = )" << standard
                        << R"(
[scene.strip]
base = "standard"
displacement_um = "strength"
[timing]
response_zero = ")" << zero
                        << "\"\n"
                        << times << R"(iti_s = 2.0
[task]
kind = "adjustment"
adjusts = "strength"
step = 0.02
device = "touch"
question = { en = "?" }
choices = [ { id = "done", label = { en = "Done" } } ]
)" << intervals;
    std::vector<double> settings;
    for (const auto& block :
         rehearsal::rehearse(
             protocol::load(path), 0, 3,
             rehearsal::rehearser(simulation::Observer(simulation::parse("sim:threshold=0.02,lapse=0"))))
             .blocks)
      for (const auto& row : block.trials) {
        CHECK(row.outcome == core::Outcome::answered);
        settings.push_back(std::stod(row.given.response.value()));
      }
    double sum = 0;
    for (const double setting : settings) sum += setting;
    return sum / static_cast<double>(settings.size());
  };
  const std::string two =
      "intervals = [[\"standard\", \"strip\"]]\nforeperiod_s = { uniform = [1.0, 1.5] }\ntransition_ms = "
      "50\n";
  CHECK(mean_of("0.7", two, "change") == Approx(0.7).margin(0.03));
  CHECK(mean_of("1.3", two, "go_cue") == Approx(1.3).margin(0.03));
  CHECK(mean_of("0.7", "intervals = [\"strip\"]\n", "first_contact") == Approx(1.0).margin(0.03));
  CHECK(mean_of("0.7", "intervals = [\"strip\"]\n", "interval_off") == Approx(1.0).margin(0.03));
  // the observer hurries if there is little time
  CHECK(mean_of("0.7", two, "change", "explore_s = 4.0\ndeadline_s = 30.0\n") == Approx(0.7).margin(0.03));
  CHECK(mean_of("0.7", two, "change", "explore_s = 8.0\ndeadline_s = 3.0\n") == Approx(0.7).margin(0.03));
  CHECK(mean_of("1.3", two, "go_cue", "explore_s = 3.0\ndeadline_s = 2.5\n") == Approx(1.3).margin(0.03));
  for (const std::string zero : {"interval_off", "lift_off"})
    CHECK(mean_of("0.7", two, zero, "explore_s = 3.0\ndeadline_s = 0.4\n") == Approx(0.7).margin(0.03));
  CHECK(mean_of("0.7", two, "go_cue", "explore_s = 20.0\ndeadline_s = 25.0\nanticipation_s = 9.5\n") ==
        Approx(0.7).margin(0.03));
}

TEST_CASE("protocols that follow the finger are checked with their cues, and what is deeper moves more",
          "[check]") {
  const std::string root = TURNPOINT_SOURCE_DIR;
  rehearsal::CheckOptions options;
  options.sessions = 1;
  const auto path = root + "/deploy/rigs/simulated-following.toml";
  const auto check = rehearsal::check(root + "/protocols/grating-periods.toml", path, options);
  for (const auto& problem : check.problems) UNSCOPED_INFO(format(problem));
  for (const auto& problem : check.warnings) UNSCOPED_INFO(format(problem));
  CHECK(check.problems.empty());
  CHECK(check.warnings.empty());
  CHECK(check.trials.median >= 66);  // 6 practice and 60, some of which nobody answers
  const auto accuracy = [](const rehearsal::Check& of, const std::string& cue) {
    for (const auto& report : of.cues.reports)
      if (report.cue == cue) return report.accuracy;
    return -1.0;
  };
  CHECK(accuracy(check, "pitch") == Approx(0.5).margin(0.01));
  // A comparison that is also deeper needs more vibration everywhere.
  const auto source = core::read_file(root + "/protocols/grating-periods.toml");
  const TemporaryFolder folder;
  const auto deeper = folder / "deeper.toml";
  std::ofstream(deeper) << [&] {
    auto text = source;
    const auto at = text.rfind("from = 0.4");
    return text.replace(at, 10, "from = 0.25");
  }();
  const auto told = rehearsal::check(deeper, path, options);
  for (const auto& problem : told.problems) UNSCOPED_INFO(format(problem));
  CHECK(told.problems.empty());
  CHECK(accuracy(told, "amplitude at the wide end") > 0.95);
}

TEST_CASE("friction that differs before a fall keeps the highest vibration from telling whether it fell",
          "[check]") {
  const std::string root = TURNPOINT_SOURCE_DIR;
  rehearsal::CheckOptions options;
  options.sessions = 1;
  const auto vibration = [&](const std::string& path) {
    const auto check = rehearsal::check(path, root + "/deploy/rigs/simulated-following.toml", options);
    for (const auto& problem : check.problems) UNSCOPED_INFO(format(problem));
    CHECK(check.problems.empty());
    CHECK(check.warnings.empty());
    for (const auto& report : check.cues.reports)
      if (report.cue == "amplitude at the wide end") return report.accuracy;
    return -1.0;
  };
  const auto shipped = root + "/protocols/change-while-pressing.toml";
  CHECK(vibration(shipped) == Approx(0.75).margin(0.01));
  const TemporaryFolder folder;
  const auto fixed = folder / "fixed.toml";
  std::ofstream(fixed) << [&] {
    auto text = core::read_file(shipped);
    const std::string drawn = "levels = [0.7, 0.75, 0.8, 0.85]";
    return text.replace(text.find(drawn), drawn.size(), "levels = [0.8]");
  }();
  CHECK(vibration(fixed) == Approx(1.0).margin(0.01));
}

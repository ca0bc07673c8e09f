// Tests what `check` prints about the cue guard: the chance level of each cue, and the precision of simulated
// figures.
#include <fstream>

#include "station/core/read_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/child.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

const std::string source = TURNPOINT_SOURCE_DIR;

std::string with(std::string text, const std::vector<std::pair<std::string, std::string>>& changes) {
  for (const auto& [from, to] : changes) {
    auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    for (; at != std::string::npos; at = text.find(from, at + to.size())) text.replace(at, from.size(), to);
  }
  return text;
}

std::string cues_of(const std::string& protocol) {
  const TemporaryFolder folder;
  const auto path = folder / "p.toml";
  std::ofstream(path) << protocol;
  Child child({TURNPOINT, "check", path, "--rig", source + "/tests/support/thin_plate.toml"});
  REQUIRE(child.ends_within(60'000));
  INFO(child.said());
  CHECK(child.outcome() == 0);
  return child.said();
}

}  // namespace

TEST_CASE("check states the precision of accuracies that come from simulated sessions", "[cli]") {
  // Even with roving, the amplitude reveals something about the answer. It reveals more at the easier levels
  // of the staircase.
  const auto text = with(turnpoint::core::read_file(source + "/protocols/friction-staircase.toml"),
                         {{"tolerance = { level_dB = 0.1 }", "rove_dB = 2.5"},
                          {"-3.0", "-9.0"},
                          {"-5.0", "-9.0"},
                          {"-8.0", "-12.0"}});
  const auto said = cues_of(text);
  INFO(said);
  CHECK(said.find("amplitude at the wide end: 78 % right +- 1 % (chance 50 %)") != std::string::npos);
}

TEST_CASE("check compares each cue with its own chance", "[cli]") {
  // In three of four trials "right" is correct, so always pressing that key reaches 75 % without any cue. So
  // the accuracy of an observer who uses the amplitude as a cue must be compared with 75 %.
  const auto text =
      with(turnpoint::core::read_file(source + "/protocols/boundary-constant.toml"),
           {{"values = [-28.0, -16.0, -8.0, -3.0, 3.0, 8.0, 16.0, 28.0]", "values = [-3.0, 3.0, 8.0, 16.0]"},
            {"levels = [152.0, 158.0, 164.0]", "levels = [158.0]"}});
  const auto said = cues_of(text);
  INFO(said);
  CHECK(said.find("always the same key: 75 % right (chance 50 %)") != std::string::npos);
  CHECK(said.find("strip width: 100 % right (chance 75 %)") != std::string::npos);
}

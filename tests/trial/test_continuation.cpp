#include <string>
#include <vector>

#include "station/trial/director.hpp"
#include "station/trial/earlier_trials.hpp"
#include "station/trial/rows.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/quick_rig.hpp"

using namespace turnpoint;
using Catch::Matchers::ContainsSubstring;

namespace {

/// A study of `sessions` sessions, each with `trials` trials of a staircase and a QUEST+ that are
/// interleaved.
protocol::Protocol study(int sessions, int trials, const std::string& changes = "step = [3.0, 1.5]") {
  auto source = core::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/friction-training.toml");
  source = replaced(source, "count = 3", "count = " + std::to_string(std::max(2, sessions)));
  source.resize(source.find("[[procedure]]"));
  return protocol::parse(source + R"(
[[procedure]]
name = "quest"
kind = "quest-plus"
with = { phase = "before" }
function = "weibull"
level = "contrast_dB"
stimuli = { from = -30.0, to = -3.0, step = 1.0 }
grid.threshold = { from = -30.0, to = -3.0, step = 1.0 }
grid.slope = { values = [1.0, 2.0] }
grid.guess = { values = [0.5] }
grid.lapse = { values = [0.02] }
stop = { trials = 1000 }
continues = true

[[procedure]]
name = "stairs"
kind = "up-down"
with = { phase = "before" }
level = "contrast_dB"
start = -6.0
min = -30.0
max = -3.0
)" + changes + R"(
n_down = 2
stop = { trials = 1000 }
continues = true

[[block]]
name = "main"
procedures = ["quest", "stairs"]
interleave = "alternate"
trials = )" + std::to_string(trials) +
                             "\n",
                         "study.toml");
}

struct Day {
  std::vector<core::BlockRecord> blocks;
  std::vector<double> levels;
  std::vector<std::string> estimates;
};

/// Runs a session in which answer number i (counted over all sessions) is wrong if i * i % 7 is 2, and
/// missing if i % 17 is 5.
Day run(const protocol::Protocol& protocol, int number, const procedure::EarlierTrials& earlier,
        int& answers) {
  trial::Director director(protocol, {0, number}, static_cast<std::uint64_t>(number), nullptr, earlier);
  Day day;
  auto& block = day.blocks.emplace_back();
  block.start = trial::block_start(*director.block(), director.block_index(), director.attempt());
  while (const auto spec = director.next()) {
    auto row = trial::row_of(*spec, protocol, static_cast<int>(day.levels.size()));
    day.levels.push_back(*spec->level);
    trial::TrialEnd end;
    const int i = answers++;
    if (i % 17 == 5) {
      end.outcome = core::Outcome::timeout;
    } else {
      end.correct = i * i % 7 != 2;
      end.response = *end.correct ? *spec->correct : 1 - *spec->correct;
      row.given.response = protocol.task.choices[static_cast<std::size_t>(*end.response)].id;
    }
    row.outcome = end.outcome, row.given.correct = end.correct;
    block.trials.push_back(row);
    director.record(end);
  }
  for (const auto& estimate : director.estimates())
    day.estimates.push_back(estimate.procedure + " " + estimate.parameter + " " + trial::in_words(estimate));
  return day;
}

}  // namespace

TEST_CASE("procedures that continue take two days as one long session", "[session][continuation]") {
  int of_long = 0, of_days = 0;
  const auto whole = run(study(2, 120), 1, {}, of_long);
  const auto days = study(2, 60);
  procedure::EarlierTrials earlier;
  const auto first = run(days, 1, earlier, of_days);
  trial::add_earlier_trials(days, first.blocks, earlier);
  CHECK(earlier.at("quest").size() == 30);
  CHECK(earlier.at("stairs").size() == 30);
  const auto second = run(days, 2, earlier, of_days);
  auto levels = first.levels;
  levels.insert(levels.end(), second.levels.begin(), second.levels.end());
  CHECK(levels == whole.levels);
  CHECK(second.estimates.size() >= 2);
  CHECK(second.estimates == whole.estimates);
  CHECK(second.levels.front() != first.levels.front());

  int again = 60;
  const auto anew = run(days, 2, {}, again);  // without the first day, it begins anew
  CHECK(anew.levels.front() == first.levels.front());
  CHECK(anew.levels != second.levels);
}

TEST_CASE("only trials that count are continued", "[session][continuation]") {
  int answers = 0;
  const auto protocol = study(2, 20);
  auto blocks = run(protocol, 1, {}, answers).blocks;
  procedure::EarlierTrials all;
  trial::add_earlier_trials(protocol, blocks, all);
  auto disturbed = blocks;
  auto extra = disturbed[0].trials[3];
  extra.outcome = core::Outcome::fault;
  disturbed[0].trials.insert(disturbed[0].trials.begin() + 3, extra);
  extra = disturbed[0].trials[0], extra.type = core::TrialType::warmup;
  disturbed[0].trials.push_back(extra);
  extra.type = core::TrialType::catch_trial;
  disturbed[0].trials.push_back(extra);
  auto attempt = blocks[0];  // an attempt that was begun and repeated
  attempt.trials.resize(7);
  disturbed[0].start.attempt = 1;
  disturbed.insert(disturbed.begin(), attempt);
  procedure::EarlierTrials same;
  trial::add_earlier_trials(protocol, disturbed, same);
  REQUIRE(same.at("quest").size() == all.at("quest").size());
  REQUIRE(same.at("stairs").size() == all.at("stairs").size());
  for (const auto* name : {"quest", "stairs"})
    for (std::size_t i = 0; i < all.at(name).size(); ++i) {
      CHECK(same.at(name)[i].level == all.at(name)[i].level);
      CHECK(same.at(name)[i].answer == all.at(name)[i].answer);
    }
}

TEST_CASE("a procedure that would not have presented the earlier levels cannot continue",
          "[session][continuation]") {
  int answers = 0;
  procedure::EarlierTrials earlier;
  const auto before = study(2, 60);
  trial::add_earlier_trials(before, run(before, 1, earlier, answers).blocks, earlier);
  const auto changed = study(2, 60, "step = [2.0]");
  CHECK_THROWS_WITH(
      trial::Director(changed, {0, 2}, 2, nullptr, earlier),
      ContainsSubstring("procedure \"stairs\" cannot continue") && ContainsSubstring("is stored"));
}

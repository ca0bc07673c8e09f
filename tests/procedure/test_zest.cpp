#include <cmath>
#include <fstream>
#include <sstream>

#include "station/procedure/trace.hpp"
#include "tests/procedure/watson.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::procedure;

namespace {

Spec at_threshold(Kind kind) {
  Spec spec = watson_1();
  spec.kind = kind;
  spec.stimuli.values = spec.threshold.values = range(-40, 0, 0.5);
  spec.slope.values = {3.5}, spec.guess.values = {0.5}, spec.lapse.values = {0.02};
  spec.prior_threshold = {};
  if (kind == Kind::zest) spec.prior_threshold.normal = {-15, 8};
  spec.stop = {};
  spec.stop.trials = 100;
  return spec;
}

/// Gives the procedure the answers of each row of zest.csv, which make_zest.py wrote. Returns the number of
/// rows whose next level and estimate the procedure reproduces.
int agreeing(Kind kind, const Spec& spec, int& rows) {
  std::ifstream table(std::string(ZEST_TABLES) + "/zest.csv");
  REQUIRE(table);
  int agree = 0;
  rows = 0;
  for (std::string line; std::getline(table, line);) {
    if (!line.starts_with(std::string(name(kind)) + ",")) continue;
    std::vector<std::string> words;
    std::istringstream parts(line);
    for (std::string word; std::getline(parts, word, ',');) words.push_back(word);
    const auto result = trace(spec, {}, words[1]);
    const auto& threshold = result.estimates.at("threshold");
    ++rows;
    agree += std::fabs(*result.next - std::stod(words[2])) < 1e-9 &&
             std::fabs(threshold.mean - std::stod(words[3])) < 1e-6 &&
             std::fabs(*threshold.sd - std::stod(words[4])) < 1e-6;
  }
  return agree;
}

}  // namespace

TEST_CASE("ZEST and best PEST present the levels that an independent posterior gives", "[procedure]") {
  const auto kind = GENERATE(Kind::zest, Kind::best_pest);
  INFO(name(kind));
  int rows = 0;
  const int agree = agreeing(kind, at_threshold(kind), rows);
  CHECK(rows == 29);
  CHECK(agree == rows);
}

TEST_CASE("negative control: with another slope or the other rule, the levels differ", "[procedure]") {
  int rows = 0;
  auto flat = at_threshold(Kind::zest);
  flat.slope.values = {3.4};
  CHECK(agreeing(Kind::zest, flat, rows) < 14);
  CHECK(agreeing(Kind::zest, at_threshold(Kind::best_pest), rows) < 14);
}

TEST_CASE("best PEST begins in the middle, and then in the middle of the equally likely thresholds",
          "[procedure]") {
  const auto spec = at_threshold(Kind::best_pest);
  const auto result = trace(spec, {}, "1");
  CHECK(result.levels[0] == -20);
  // a right answer at -20 makes levels from -40 to -28 equally likely; the next level is their middle
  CHECK(*result.next == -34);
}

TEST_CASE("a procedure ends with 8 of the last 10 answers right, and not before", "[procedure]") {
  Spec list;
  list.name = "training", list.level = "level", list.kind = Kind::constant_stimuli;
  list.values = {1, 2}, list.repeats = 20;
  list.stop.right = 8, list.stop.of_last = 10;
  Spec track = list;
  track.kind = Kind::up_down, track.start = 5, track.min = 0, track.max = 10, track.step = {1};
  track.step_down = track.step_up = {1};
  auto zest = at_threshold(Kind::zest);
  zest.stop = list.stop;
  for (const auto& spec : {list, track, zest}) {
    INFO(name(spec.kind));
    CHECK(trace(spec, {}, "111111110").next);         // 8 right answers, but of 9 and not of 10
    CHECK_FALSE(trace(spec, {}, "1111111100").next);  // 8 right answers of 10: the procedure has ended
    CHECK(trace(spec, {}, "0001111111").next);        // only 7 right answers of 10
    // 8 right answers among the last 10: the procedure has ended
    CHECK_FALSE(trace(spec, {}, "00011111111").next);
    CHECK(trace(spec, {}, "01010101011111").next);
    CHECK_FALSE(trace(spec, {}, "010101010111111").next);
  }
}

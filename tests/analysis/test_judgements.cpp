#include "station/analysis/judgements.hpp"

#include <cmath>

#include "tests/support/catch.hpp"

using namespace turnpoint;
using analysis::Judged;

namespace {

analysis::TrialRecord judged(double level, double value) {
  analysis::TrialRecord trial;
  trial.level = level;
  trial.setting = value;
  return trial;
}

}  // namespace

TEST_CASE("numbers of an exact power law give its exponent and geometric means", "[analysis]") {
  std::vector<analysis::TrialRecord> trials;
  for (const double level : {0.1, 0.4, 1.6})
    for (const double factor : {0.5, 1.0, 2.0})
      trials.push_back(judged(level, 10 * factor * std::pow(level, 0.6)));
  const auto all = analysis::judgements(trials, {}, Judged::magnitudes);
  REQUIRE(all.size() == 1);
  REQUIRE(all[0].levels.size() == 3);
  CHECK(all[0].levels[1].mean->value == Approx(10 * std::pow(0.4, 0.6)));
  // The logarithms of the answers differ from their mean by -0.30103, 0 and 0.30103, so their SD is 0.30103.
  // The 97.5 % point of t(2) is 4.302653.
  const double half = 4.302653 * 0.30103 / std::sqrt(3.0);
  CHECK(all[0].levels[1].mean->interval.high / all[0].levels[1].mean->value ==
        Approx(std::pow(10, half)).epsilon(1e-5));
  REQUIRE(all[0].exponent);
  CHECK(all[0].exponent->value == Approx(0.6));
  // Standard error of the slope: the squared residuals sum to 6 * 0.30103^2 with 7 degrees of freedom, and
  // the squared log levels (about their mean) to 3 * 2 * log10(4)^2. The 97.5 % point of t(7) is 2.364624.
  const double error = std::sqrt(6 * 0.30103 * 0.30103 / 7 / (6 * std::pow(std::log10(4.0), 2)));
  CHECK(all[0].exponent->interval.high == Approx(0.6 + 2.364624 * error).epsilon(1e-5));
}

TEST_CASE("levels in dB are logarithms already", "[analysis]") {
  std::vector<analysis::TrialRecord> trials;
  for (const double level : {-20.0, -10.0, 0.0})
    trials.push_back(judged(level, std::pow(10, 0.5 * level / 20)));
  CHECK(analysis::judgements(trials, {}, Judged::magnitudes_dB)[0].exponent->value == Approx(0.5));
}

TEST_CASE("numbers without a logarithm are left out of magnitudes, and a statement says so", "[analysis]") {
  std::vector<analysis::TrialRecord> trials;
  for (const double value : {0.0, 1.0, 2.0, 4.0})
    trials.push_back(judged(1, value)), trials.push_back(judged(2, value));
  auto zero = analysis::judgements(trials, {}, Judged::magnitudes)[0];
  CHECK(zero.levels[0].values.size() == 3);
  CHECK(zero.exponent);
  REQUIRE(zero.statements.size() == 1);
  CHECK(zero.statements[0].code == "zero-magnitudes");
  trials.push_back(judged(0, 1));
  zero = analysis::judgements(trials, {}, Judged::magnitudes)[0];
  CHECK_FALSE(zero.exponent);
  CHECK(zero.statements.back().code == "no-logarithm");
}

TEST_CASE("ratings have means and medians by condition and level, practice left out", "[analysis]") {
  std::vector<analysis::TrialRecord> trials{judged(1, 2), judged(1, 3), judged(1, 7), judged(2, 5)};
  trials.push_back(judged(1, 1));
  trials.back().type = analysis::TrialType::practice;
  trials.push_back(judged(1, 4));
  trials.back().instruction = "wet";
  const auto all = analysis::judgements(trials, {"wet"}, Judged::ratings);
  REQUIRE(all.size() == 2);
  CHECK(all[0].condition == "wet");
  CHECK(all[1].levels[0].mean->value == Approx(4));
  CHECK(all[1].levels[0].median == 3);
  CHECK_FALSE(all[1].levels[1].mean);  // no mean, because a single answer gives no interval
  CHECK_FALSE(all[1].exponent);
}

TEST_CASE("judgements without an answer say why they are empty", "[analysis]") {
  for (const auto kind : {Judged::ratings, Judged::magnitudes}) {
    auto unanswered = judged(0.1, 1);
    unanswered.setting.reset();
    const auto all = analysis::judgements({unanswered}, {}, kind);
    REQUIRE(all.size() == 1);
    CHECK(all[0].levels.empty());
    REQUIRE(all[0].statements.size() == 1);
    CHECK(all[0].statements[0].code == "no-trials");
    CHECK(analysis::judgements({judged(0.1, 1)}, {}, kind)[0].levels.size() == 1);
  }
}

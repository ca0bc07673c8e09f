#include <cmath>

#include "station/analysis/quantile.hpp"
#include "station/analysis/trade.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/diffusion.hpp"

using namespace turnpoint::analysis;
using turnpoint::tests::sample_decision;
namespace rnd = turnpoint::core;

namespace {

bool says(const std::vector<Statement>& statements, const std::string& code) {
  for (const auto& statement : statements)
    if (statement.code == code) return true;
  return false;
}

/// Simulated diffusion trials with three difficulties; boundary and non-decision time (Ter) depend on the
/// instruction.
std::vector<TrialRecord> session(double speed_boundary, double accuracy_boundary, int per_cell, int run) {
  rnd::Draws draws({5, rnd::Stream::observer, run, 0, 0});
  std::vector<TrialRecord> trials;
  for (const auto& [name, boundary] : {std::pair{"speed", speed_boundary}, {"accuracy", accuracy_boundary}})
    for (const double level : {0.1, 0.2, 0.4})
      for (int i = 0; i < per_cell; ++i) {
        TrialRecord trial;
        trial.trial_index = static_cast<int>(trials.size());
        trial.instruction = name;
        trial.level = i % 2 ? level : -level;
        trial.difficulty = level;
        const auto decision = sample_decision({0.5 * level, boundary, 0.3}, draws);
        trial.correct = decision.correct;
        trial.response_time_s = decision.time_s;
        trials.push_back(trial);
      }
  return trials;
}

bool holds(const Estimate& estimate, double value) {
  return estimate.interval.low <= value && value <= estimate.interval.high;
}

}  // namespace

TEST_CASE("For equal instructions, the interval of the difference seldom excludes 0", "[analysis]") {
  TradeOptions options;
  options.replicates = 100;
  const int sessions = 20;
  int outside = 0, measured = 0;
  for (int run = 0; run < sessions; ++run)
    for (const auto& difference : trade(session(0.12, 0.12, 60, run), options).differences) {
      REQUIRE(difference.estimate);
      ++measured;
      outside += !holds(*difference.estimate, 0);
    }
  CHECK(measured == (7 + 5) * sessions);  // five bins of time
  CHECK(outside <= 0.15 * measured);
}

TEST_CASE("LISAS, inverse efficiency and BIS follow their definitions", "[analysis]") {
  CHECK(lisas(0.65, 0.08, 0.12, 0.27) == Approx(0.685556).margin(5e-7));
  CHECK(lisas(0.65, 0, 0.12, 0) == 0.65);
  CHECK(*inverse_efficiency(0.6, 0.8) == Approx(0.75));
  CHECK_FALSE(inverse_efficiency(0.6, 0).has_value());
  const auto scores = balanced_integration({0.7, 0.8, 0.9}, {0.5, 0.6, 0.7});
  REQUIRE(scores);
  for (const double score : *scores) CHECK(score == Approx(0).margin(1e-12));
  CHECK((*balanced_integration({0.7, 0.8, 0.9}, {0.7, 0.6, 0.5}))[2] == Approx(2 * std::sqrt(1.5)));
  CHECK_FALSE(balanced_integration({0.7, 0.8}, {0.5, 0.6}).has_value());
  CHECK_FALSE(balanced_integration({0.8, 0.8, 0.8}, {0.5, 0.6, 0.7}).has_value());
}

TEST_CASE("The conditional accuracy function has bins of equal counts", "[analysis]") {
  std::vector<double> times;
  std::vector<bool> correct;
  for (int i = 0; i < 102; ++i) {
    times.push_back(1.02 - 0.01 * i);
    correct.push_back(i < 51);  // slow answers are right, and fast ones are wrong
  }
  const auto bins = conditional_accuracy(times, correct, 5);
  REQUIRE(bins.size() == 5);
  int total = 0;
  for (const auto& bin : bins) {
    CHECK(bin.trials >= 20);
    CHECK(bin.trials <= 21);
    total += bin.trials;
  }
  CHECK(total == 102);
  CHECK(bins.front().correct == 0);
  CHECK(bins.back().correct == bins.back().trials);
  CHECK(bins.front().high_s < bins.back().low_s);
  CHECK(conditional_accuracy({0.1, 0.2}, {true, false}, 4).empty());
  CHECK_THROWS_AS(conditional_accuracy(times, correct, 9), std::invalid_argument);
}

TEST_CASE("Response times are excluded below a limit and beyond a number of median absolute deviations",
          "[analysis]") {
  const std::vector<double> times{0.02, 0.50, 0.52, 0.55, 0.58, 0.60, 5.0};
  const auto kept = keep_times(times, {0.15, 3.5});
  CHECK(kept == std::vector<bool>{false, true, true, true, true, true, false});
  CHECK(keep_times({0.5, 0.5, 0.5, 0.9}, {0, 3.5}) == std::vector<bool>{true, true, true, true});
  const auto summary = describe_times({0.5, 0.7, 0.6});
  CHECK(summary->median_s == Approx(0.6));
  CHECK(summary->mad_s == Approx(0.1));
  CHECK(summary->sd_s == Approx(0.1));
  CHECK_FALSE(describe_times({}).has_value());
}

TEST_CASE("A session of timeouts, or of five trials, gives only statements", "[analysis]") {
  std::vector<TrialRecord> trials(5);
  for (auto& trial : trials) trial.outcome = Outcome::timeout;
  TradeOptions options;
  options.replicates = 50;
  const auto late = trade(trials, options);
  REQUIRE(late.instructions.size() == 1);
  CHECK(late.instructions[0].timeouts == 5);
  auto with_void = trials;
  with_void.resize(7);
  with_void[5].outcome = Outcome::fault, with_void[6].outcome = Outcome::aborted;
  CHECK(trade(with_void, options).instructions[0].presented == 5);
  CHECK_FALSE(late.instructions[0].proportion_correct.has_value());
  CHECK_FALSE(late.instructions[0].boundary.has_value());
  CHECK(says(late.instructions[0].statements, "timeouts"));
  for (auto& trial : trials) {
    trial.outcome = Outcome::answered;
    trial.correct = true;
    trial.response_time_s = 0.5;
  }
  const auto few = trade(trials, options);
  CHECK_FALSE(few.instructions[0].boundary.has_value());
  CHECK(says(few.instructions[0].statements, "diffusion-too-few"));
  CHECK(trade({}, options).instructions.empty());
}

TEST_CASE(
    "Differences are given for all pairs of conditions, in an order that does not depend on the order of "
    "presentation",
    "[analysis]") {
  const auto measured = [](bool turned) {
    auto trials = session(0.08, 0.14, 30, 3);
    auto other = session(0.11, 0.11, 30, 4);
    for (auto& trial : other) trial.instruction = "middle";
    trials.insert(turned ? trials.begin() : trials.end(), other.begin(), other.end());
    TradeOptions options;
    options.replicates = 40;
    options.order = {"accuracy", "middle", "speed"};
    return trade(trials, options);
  };
  const auto one = measured(false), two = measured(true);
  REQUIRE(one.instructions.size() == 3);
  CHECK(one.instructions[0].instruction == "accuracy");
  const std::size_t bins = one.instructions[0].caf.size(), pair = 7 + bins;
  REQUIRE(bins == 5);
  REQUIRE(one.differences.size() == 3 * pair);
  REQUIRE(two.differences.size() == one.differences.size());
  for (std::size_t i = 0; i < one.differences.size(); ++i) {
    const auto &a = one.differences[i], &b = two.differences[i];
    CHECK((a.first == b.first && a.second == b.second && a.measure == b.measure));
    CHECK(!a.unit.empty());
    REQUIRE(a.estimate.has_value() == b.estimate.has_value());
    if (!a.estimate) continue;
    CHECK(a.estimate->value == b.estimate->value);
    CHECK((*a.estimate->p > 0 && *a.estimate->p <= 1));
    // the p value of a difference of proportions is that of the interval that ends at 0
    const auto& interval = a.estimate->interval;
    if (a.unit == "proportion") CHECK((*a.estimate->p < 0.05) == (interval.low > 0 || interval.high < 0));
  }
  const auto in_bins = one.differences[7];
  CHECK(in_bins.measure == "proportion correct in time bin 1 of 5");
  const auto &first = one.instructions[0].caf[0], &second = one.instructions[1].caf[0];
  CHECK(in_bins.estimate->value ==
        Approx(static_cast<double>(second.correct) / second.trials -
               static_cast<double>(first.correct) / first.trials));
  CHECK(one.differences[2 * pair].first == "middle");
  CHECK(one.differences[2 * pair].second == "speed");
  CHECK(one.differences[0].estimate->value == Approx(one.instructions[1].proportion_correct->value -
                                                     one.instructions[0].proportion_correct->value));
}

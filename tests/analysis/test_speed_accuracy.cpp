#include <cmath>

#include "station/analysis/quantile.hpp"
#include "station/analysis/trade.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/diffusion.hpp"

using namespace turnpoint::analysis;
using turnpoint::tests::sample_decision;
namespace rnd = turnpoint::random;

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

TEST_CASE("EZ-diffusion reproduces the example of its paper", "[analysis]") {
  const auto ez = ez_diffusion({0.802, 0.112, 0.723, 100}).parameters;
  REQUIRE(ez);
  CHECK(ez->drift == Approx(0.0999385).margin(5e-8));
  CHECK(ez->boundary == Approx(0.1399702).margin(5e-8));
  CHECK(ez->nondecision_s == Approx(0.3000300).margin(5e-8));
}

TEST_CASE("EZ-diffusion is continuous at chance performance, and its drift changes sign there",
          "[analysis]") {
  const auto at = [](double p) { return *ez_diffusion({p, 0.1, 0.9, 100}).parameters; };
  CHECK(at(0.5).drift == 0);
  CHECK(at(0.5).boundary == Approx(0.1 * std::pow(2.4, 0.25)));
  CHECK(at(0.5 + 0.99e-3).boundary == Approx(at(0.5 + 1.01e-3).boundary).epsilon(1e-5));
  CHECK(at(0.5 + 0.999e-3).drift == Approx(at(0.5 + 1.001e-3).drift).epsilon(3e-3));
  CHECK(at(0.3).drift == Approx(-at(0.7).drift));
  CHECK(at(0.3).boundary == Approx(at(0.7).boundary));
}

TEST_CASE("EZ-diffusion gives a statement instead of a number for what it cannot identify", "[analysis]") {
  CHECK(says(ez_diffusion({0, 0.1, 0.7, 50}).statements, "ez-proportion"));
  CHECK(says(ez_diffusion({1.2, 0.1, 0.7, 50}).statements, "ez-proportion"));
  CHECK(says(ez_diffusion({0.8, 0, 0.7, 50}).statements, "ez-variance"));
  CHECK(says(ez_diffusion({0.8, 1.0, 0.3, 50}).statements, "ez-nondecision"));
  CHECK_FALSE(ez_diffusion({0.8, 1.0, 0.3, 50}).parameters.has_value());
  const auto perfect = ez_diffusion({1, 0.05, 0.7, 50}).parameters,
             edge = ez_diffusion({0.99, 0.05, 0.7, 50}).parameters;
  REQUIRE(perfect);
  CHECK(perfect->drift == edge->drift);
  CHECK(says(shared_ez_diffusion({{0.8, 0.05, 0.6, 9}}).statements, "ez-too-few"));
}

TEST_CASE(
    "The shared fit of one condition equals plain EZ, and that of exact moments returns the true parameters",
    "[analysis]") {
  const EzMoments example{0.802, 0.112, 0.723, 100};
  const auto one = shared_ez_diffusion({example}).parameters;
  REQUIRE(one);
  CHECK(one->boundary == Approx(0.1399702).margin(1e-7));
  CHECK(one->drift[0] == Approx(0.0999385).margin(1e-7));
  CHECK(one->nondecision_s == Approx(0.30003).margin(1e-6));
  // Exact moments for boundary a = .12 and Ter = .3, from equations 3, 5 and 9 of Wagenmakers et al. (2007).
  std::vector<EzMoments> exact;
  for (const double v : {0.02, 0.1, 0.25}) {
    const double a = 0.12, s2 = 0.01, y = -v * a / s2, e = std::exp(y);
    exact.push_back({1 / (1 + e), a * s2 / (2 * v * v * v) * (2 * y * e - e * e + 1) / ((e + 1) * (e + 1)),
                     a / (2 * v) * (1 - e) / (1 + e) + 0.3, 200});
  }
  const auto shared = shared_ez_diffusion(exact).parameters;
  REQUIRE(shared);
  CHECK(shared->boundary == Approx(0.12).epsilon(1e-9));
  CHECK(shared->nondecision_s == Approx(0.3).epsilon(1e-9));
  CHECK(shared->drift[2] == Approx(0.25).epsilon(1e-9));
  // A single right answer has no variance of its times, but below chance the drift is below 0.
  exact.push_back({0.25, 0, 0.7, 4});
  const double below = shared_ez_diffusion(exact).parameters->drift[3];
  CHECK(below == Approx(0.01 * std::log(0.25 / 0.75) / 0.12).epsilon(1e-9));
  // at a logit of 0.02, the Taylor series and the closed form give the same boundary
  const auto near_chance = [](double p) {
    return shared_ez_diffusion({{p, 0.05, 0.7, 200}}).parameters->boundary;
  };
  CHECK(near_chance(0.504999) == Approx(near_chance(0.505001)).epsilon(1e-6));
}

TEST_CASE("The intervals of the boundary and of the non-decision time contain the true values",
          "[analysis]") {
  TradeOptions options;
  options.replicates = 200;
  // In a longer run of 600 sessions, the intervals contained the true value in these shares of sessions: .95
  // for boundaries, .93 for Ter, .96 for differences of boundaries.
  const int sessions = 300;
  double sum_a = 0, sum_t = 0;
  int boundary = 0, nondecision = 0, separated = 0, drift = 0, gap = 0, without = 0;
  for (int run = 0; run < sessions; ++run) {
    const auto result = trade(session(0.08, 0.14, 60, run), options);
    REQUIRE(result.instructions.size() == 2);
    const auto& speed = result.instructions[0];
    const auto& accuracy = result.instructions[1];
    // In about one of several hundred sessions, too many bootstrap replicates cannot be fitted. Such a
    // session has no interval.
    if (!speed.boundary || !accuracy.boundary || !result.differences[2].estimate) {
      ++without;
      continue;
    }
    boundary += holds(*speed.boundary, 0.08) + holds(*accuracy.boundary, 0.14);
    nondecision += holds(*speed.nondecision_s, 0.3) + holds(*accuracy.nondecision_s, 0.3);
    gap += holds(*result.differences[2].estimate, 0.06);
    separated += result.differences[2].estimate->interval.low > 0;
    sum_a += accuracy.boundary->value;
    sum_t += accuracy.nondecision_s->value;
    drift += std::abs(*accuracy.cells[1].drift - 0.1) < 0.05;
  }
  const int fitted = sessions - without;
  INFO("covered of " << 2 * fitted << ": boundary " << boundary << ", Ter " << nondecision << ", gap "
                     << gap);
  CHECK(without <= 0.01 * sessions);
  CHECK(boundary >= 0.93 * 2 * fitted);
  CHECK(boundary <= 0.98 * 2 * fitted);
  CHECK(gap >= 0.92 * fitted);
  CHECK(gap < fitted);
  CHECK(nondecision >= 0.91 * 2 * fitted);
  CHECK(sum_a / fitted == Approx(0.14).epsilon(0.02));
  CHECK(sum_t / fitted == Approx(0.3).epsilon(0.03));
  CHECK(separated == fitted);
  CHECK(drift >= 0.95 * fitted);
}

TEST_CASE("Pooling easy and hard trials biases the estimated boundary, but the shared fit does not",
          "[analysis]") {
  // The boundary is the same under both instructions, but one instruction has harder levels.
  rnd::Draws draws({8, rnd::Stream::observer, 0, 0, 0});
  const auto moments = [&](double v, int n) {
    std::vector<double> times;
    for (int i = 0; i < n; ++i)
      if (const auto d = sample_decision({v, 0.12, 0.3}, draws); d.correct) times.push_back(d.time_s);
    return std::pair{EzMoments{double(times.size()) / n, variance(times), mean(times), n}, times};
  };
  const auto [hard, hard_times] = moments(0.0, 4000);
  const auto [easy, easy_times] = moments(0.4, 4000);
  auto all = hard_times;
  all.insert(all.end(), easy_times.begin(), easy_times.end());
  const auto pooled =
      ez_diffusion({(hard.proportion_correct + easy.proportion_correct) / 2, variance(all), mean(all), 8000});
  const auto shared = shared_ez_diffusion({hard, easy});
  CHECK(shared.parameters->boundary == Approx(0.12).epsilon(0.03));
  CHECK(std::abs(pooled.parameters->boundary - 0.12) > 2 * std::abs(shared.parameters->boundary - 0.12));
}

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
  CHECK(measured == 7 * sessions);
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
  CHECK((*balanced_integration({0.7, 0.8, 0.9}, {0.7, 0.6, 0.5}))[2] == Approx(2));
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
  CHECK(says(few.instructions[0].statements, "ez-too-few"));
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
  REQUIRE(one.differences.size() == 3 * 7);
  REQUIRE(two.differences.size() == one.differences.size());
  for (std::size_t i = 0; i < one.differences.size(); ++i) {
    const auto &a = one.differences[i], &b = two.differences[i];
    CHECK((a.first == b.first && a.second == b.second && a.measure == b.measure));
    CHECK(!a.unit.empty());
    REQUIRE(a.estimate.has_value() == b.estimate.has_value());
    if (a.estimate) CHECK(a.estimate->value == b.estimate->value);
  }
  CHECK(one.differences[14].first == "middle");
  CHECK(one.differences[14].second == "speed");
  CHECK(one.differences[0].estimate->value == Approx(one.instructions[1].proportion_correct->value -
                                                     one.instructions[0].proportion_correct->value));
}

TEST_CASE("A single condition has no balanced integration score", "[analysis]") {
  auto trials = session(0.1, 0.1, 40, 6);
  TradeOptions options;
  options.replicates = 40;
  CHECK(trade(trials, options).instructions[0].balanced);
  for (auto& trial : trials) trial.instruction = "";
  const auto alone = trade(trials, options);
  REQUIRE(alone.instructions.size() == 1);
  CHECK(alone.instructions[0].boundary);
  CHECK_FALSE(alone.instructions[0].balanced);
}

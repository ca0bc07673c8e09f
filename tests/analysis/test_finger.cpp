#include "station/analysis/finger.hpp"

#include <cmath>

#include "tests/support/catch.hpp"

using namespace turnpoint::analysis;

namespace {

FingerTrial felt(int index, const std::string& condition, double planned_mm, double shift_mm) {
  FingerTrial trial;
  trial.trial_index = index;
  trial.condition = condition;
  trial.measured = true;
  trial.normal_N = 0.5 + 0.01 * index;
  trial.speed_mm_s = 80;
  trial.mu_low = 0.4;
  trial.mu_high = 0.8;
  trial.planned_mm = planned_mm;
  trial.felt_mm = planned_mm + shift_mm;
  trial.felt_se_mm = 0.5;
  return trial;
}

}  // namespace

TEST_CASE("without force cells there is nothing about the finger", "[analysis]") {
  CHECK_FALSE(finger({}, {"speed"}));
}

TEST_CASE("force and speed are averaged over the trials of each condition, in the given order",
          "[analysis]") {
  std::vector<FingerTrial> trials;
  for (int i = 0; i < 4; ++i) trials.push_back(felt(i, "accuracy", 150, 0.1 * i));
  for (int i = 4; i < 6; ++i) trials.push_back(felt(i, "speed", 150, 0));
  trials.push_back({6, "speed", false, {}, {}, {}, {}, 150.0, {}, {}});
  const auto result = finger(trials, {"speed", "accuracy", "unused"});
  REQUIRE(result);
  REQUIRE(result->conditions.size() == 2);
  const auto& [speed, accuracy] = std::tie(result->conditions[0], result->conditions[1]);
  CHECK(speed.condition == "speed");
  CHECK(speed.trials == 3);
  CHECK(speed.measured == 2);
  CHECK(speed.felt == 2);
  CHECK_FALSE(speed.normal_N);  // two trials are too few for an interval
  REQUIRE(accuracy.normal_N);
  CHECK(accuracy.normal_N->value == Approx(0.515));
  // the SD of 0, 1, 2, 3 is 1.290994, and the 97.5 % point of t(3) is 3.182446
  CHECK(accuracy.normal_N->interval.high == Approx(0.515 + 0.01 * 3.182446 * 1.290994 / 2).epsilon(1e-6));
  CHECK(accuracy.shift_mm->value == Approx(0.15));
  CHECK(accuracy.mu_high->value == Approx(0.8));
  CHECK(result->statements.empty());
}

TEST_CASE("at a planned boundary, three trials give their mean, and fewer are shown one by one",
          "[analysis]") {
  std::vector<FingerTrial> trials;
  for (const double shift : {-1.0, 0.0, 2.0}) trials.push_back(felt(0, "", 160, shift));
  for (const double shift : {0.5, 1.5}) trials.push_back(felt(0, "", 140.02, shift));
  const auto at = finger(trials, {})->boundaries;
  REQUIRE(at.shift_mm.size() == 3);
  CHECK(at.shift_mm[0].planned_mm == 140);
  CHECK(at.shift_mm[0].trials == 1);
  CHECK(at.shift_mm[0].value == Approx(0.5));
  CHECK(at.shift_mm[1].interval->high == Approx(1.5 + 1.96 * 0.5));
  CHECK(at.shift_mm[2].planned_mm == 160);
  CHECK(at.shift_mm[2].trials == 3);
  CHECK(at.shift_mm[2].value == Approx(1 / 3.0));
  // the three shifts have an SD of 1.527525, and the 97.5 % point of t(2) is 4.302653
  CHECK(at.shift_mm[2].interval->low == Approx(1 / 3.0 - 4.302653 * 1.527525 / std::sqrt(3.0)).epsilon(1e-6));
  REQUIRE(at.mu_low.size() == 3);
  CHECK_FALSE(at.mu_low[0].interval);
  CHECK(at.mu_low[2].value == Approx(0.4));
}

TEST_CASE("if no step of friction was felt, the analysis says why", "[analysis]") {
  auto trial = felt(0, "", 150, 0);
  trial.felt_mm.reset();
  trial.felt_se_mm.reset();
  const auto result = finger({trial}, {});
  REQUIRE(result);
  CHECK(result->boundaries.shift_mm.empty());
  REQUIRE(result->statements.size() == 1);
  CHECK(result->statements[0].code == "no-felt-boundary");
}

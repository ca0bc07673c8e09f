#include "station/analysis/forced_choice.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <random>

#include "tests/analysis/forced_choice_table.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::analysis;

namespace {

std::vector<TrialRecord> scored(int right, int trials, double level = 1) {
  std::vector<TrialRecord> all;
  for (int i = 0; i < trials; ++i) {
    TrialRecord trial;
    trial.correct = i < right, trial.level = level;
    all.push_back(trial);
  }
  return all;
}

}  // namespace

TEST_CASE("the proportion correct of each model equals numerical integration, and d' is its inverse",
          "[analysis]") {
  for (const auto& row : kForcedChoice) {
    const double d = row[0];
    INFO("d' = " << d);
    for (const int m : {2, 3, 4}) {
      CHECK(proportion_correct(Deciding::largest, d, m) == Approx(row[m - 1]).margin(1e-9));
      CHECK(d_prime(Deciding::largest, row[m - 1], m) == Approx(d).margin(1e-7));
    }
    CHECK(proportion_correct(Deciding::independent, d, 0) == Approx(row[4]).margin(1e-9));
    CHECK(proportion_correct(Deciding::differencing, d, 0) == Approx(row[5]).margin(1e-9));
    // Near d' = 0 both curves are flat, so the rounding of the proportion in the table matters more.
    CHECK(d_prime(Deciding::independent, row[4], 0) == Approx(d).margin(1e-5));
    CHECK(d_prime(Deciding::differencing, row[5], 0) == Approx(d).margin(1e-5));
  }
  CHECK(d_prime(Deciding::largest, 0.2, 3) < 0);
  CHECK(d_prime(Deciding::differencing, 0.4, 2) == 0);
  CHECK(std::isinf(d_prime(Deciding::independent, 1, 2)));
  CHECK_THROWS_AS(d_prime(Deciding::largest, 1.1, 3), std::invalid_argument);
}

TEST_CASE("simulated observers with noisy observations reach the proportion correct of their model",
          "[analysis]") {
  constexpr int trials = 200'000;
  constexpr double d = 1.7;
  std::mt19937_64 random(20261123);
  std::normal_distribution<> noise;
  int largest = 0, independent = 0, differencing = 0;
  for (int i = 0; i < trials; ++i) {
    const double signal = d + noise(random);
    largest += signal > std::max({noise(random), noise(random), noise(random)});
    // The noisy observations of an ABX trial: A has the mean 0, B the mean d, and X is the same as A.
    const double a = noise(random), b = d + noise(random), x = noise(random);
    independent += (a < b) == (x < d / 2);
    differencing += std::fabs(x - a) < std::fabs(x - b);
  }
  const auto check = [](int right, Deciding model) {
    const double p = proportion_correct(model, d, 4);
    CHECK(static_cast<double>(right) / trials == Approx(p).margin(4 * std::sqrt(p * (1 - p) / trials)));
  };
  check(largest, Deciding::largest);
  check(independent, Deciding::independent);
  check(differencing, Deciding::differencing);
}

TEST_CASE("the intervals of d' contain the true value in 95 % of all sessions or more", "[analysis]") {
  const auto coverage = [](Deciding model, int m, double d, int trials) {
    const boost::math::binomial law(trials, proportion_correct(model, d, m));
    double held = 0;
    for (int right = 0; right <= trials; ++right) {
      const auto found = discriminate(scored(right, trials), {}, {model}, m).back().d_primes.at(0).second;
      CHECK(found.value >= found.interval.low);
      CHECK(found.value <= found.interval.high);
      if (d >= found.interval.low && d <= found.interval.high) held += boost::math::pdf(law, right);
    }
    return held;
  };
  for (const int trials : {20, 60})
    for (const double d : {0.3, 1.0, 2.5}) {
      INFO("d' = " << d << ", " << trials << " trials");
      for (const double held :
           {coverage(Deciding::largest, 3, d, trials), coverage(Deciding::largest, 4, d, trials),
            coverage(Deciding::independent, 2, d, trials), coverage(Deciding::differencing, 2, d, trials)}) {
        CHECK(held >= 0.95);
        CHECK(held < 0.9999);
      }
    }
}

TEST_CASE("d' is given by level, and for all levels together", "[analysis]") {
  auto trials = scored(9, 10, -6);
  for (auto& trial : scored(5, 10, -12)) trials.push_back(trial);
  trials.push_back(scored(1, 1).front());
  trials.back().type = TrialType::catch_trial;
  const auto found = discriminate(trials, {}, {Deciding::independent, Deciding::differencing}, 2);
  REQUIRE(found.size() == 3);
  CHECK(found[0].level == -12.0);
  CHECK(found[1].right.right == 9);
  CHECK_FALSE(found[2].level);
  CHECK(found[2].right.trials == 20);
  REQUIRE(found[1].d_primes.size() == 2);
  // The proportion correct with the log-linear correction is 9.5 / 11. For the same proportion, differencing
  // needs a larger d'.
  CHECK(proportion_correct(Deciding::independent, found[1].d_primes[0].second.value, 2) == Approx(9.5 / 11));
  CHECK(found[1].d_primes[1].second.value > found[1].d_primes[0].second.value);
  CHECK(discriminate(trials, {}, {Deciding::largest}, 3, 1).size() == 1);
}

#include "station/analysis/response_signal.hpp"

#include <cmath>

#include "station/analysis/proportion.hpp"
#include "station/random/draws.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::analysis;
using turnpoint::random::Draws;

namespace {

constexpr double kLags_s[] = {0.1, 0.2, 0.35, 0.6, 1.0, 1.6};
constexpr double kLatency_s = 0.25;

struct Truth {
  double asymptote, rate_per_s, intercept_s;
};

/// Returns the answers of a participant with this curve, whose criterion changes from lag to lag.
std::vector<TrialRecord> session(const Truth& truth, int per_lag, Draws& draws) {
  std::vector<TrialRecord> trials;
  double criterion = -0.3;
  for (const double lag_s : kLags_s) {
    criterion += 0.1;
    const double time_s = lag_s + kLatency_s;
    const double d =
        truth.asymptote * (1 - std::exp(-truth.rate_per_s * std::max(0.0, time_s - truth.intercept_s)));
    for (int i = 0; i < per_lag; ++i) {
      TrialRecord trial;
      trial.right_choice = i % 2;
      trial.level = i % 2 == 1 ? 0.25 : -0.25;
      trial.response = draws.normal() + (i % 2 == 1 ? d / 2 : -d / 2) > criterion;
      trial.correct = trial.response == trial.right_choice;
      trial.response_time_s = time_s;
      trial.signal_s = lag_s;
      trials.push_back(trial);
    }
  }
  return trials;
}

bool holds(const std::optional<Estimate>& estimate, double value) {
  return estimate && estimate->interval.low <= value && value <= estimate->interval.high;
}

}  // namespace

TEST_CASE("the curve of sensitivity over time is found again, and the answers at each lag are counted",
          "[analysis]") {
  Draws draws({3, turnpoint::random::Stream::observer, 0, 0, 0});
  const auto curves = response_signal(session({2.5, 4, 0.3}, 4000, draws), {}, Detecting::sides, 1);
  REQUIRE(curves.size() == 1);
  const auto& curve = curves.front();
  REQUIRE(curve.points.size() == 6);
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(curve.points[i].lag_s == kLags_s[i]);
    CHECK(curve.points[i].time_s == Approx(kLags_s[i] + kLatency_s));
    const auto& n = curve.points[i].counts;
    CHECK(n.hits + n.misses == 2000);
    CHECK(n.false_alarms + n.correct_rejections == 2000);
    CHECK(holds(curve.points[i].d_prime, d_prime_at(2.5, 4, 0.3, kLags_s[i] + kLatency_s)));
  }
  CHECK(curve.asymptote->value == Approx(2.5).margin(0.1));
  CHECK(curve.rate_per_s->value == Approx(4).epsilon(0.12));
  CHECK(curve.intercept_s->value == Approx(0.3).margin(0.03));
  CHECK(curve.statements.empty());
}

TEST_CASE("the curve's intervals hold the truth as often as they say", "[analysis]") {
  // The true values are drawn from a part of the prior, so that about 95 % is expected, not exactly 95 %.
  constexpr int n = 200;
  int asymptote = 0, rate = 0, intercept = 0, fitted = 0;
  for (int i = 0; i < n; ++i) {
    Draws draws({static_cast<std::uint64_t>(i), turnpoint::random::Stream::observer, 0, 0, 0});
    const Truth truth{draws.uniform(1.2, 3.5), std::exp(draws.uniform(std::log(1.5), std::log(12.0))),
                      draws.uniform(0.2, 0.45)};
    const auto curve = response_signal(session(truth, 56, draws), {}, Detecting::sides, 1).front();
    asymptote += holds(curve.asymptote, truth.asymptote);
    fitted += curve.rate_per_s && curve.intercept_s;
    rate += !curve.rate_per_s || holds(curve.rate_per_s, truth.rate_per_s);
    intercept += !curve.intercept_s || holds(curve.intercept_s, truth.intercept_s);
  }
  UNSCOPED_INFO(asymptote << " " << rate << " " << intercept << " of " << n << ", fitted " << fitted);
  CHECK(asymptote >= 0.91 * n);
  CHECK(rate >= 0.91 * n);
  CHECK(intercept >= 0.91 * n);
  CHECK(asymptote <= 0.99 * n);
  CHECK(fitted >= 0.7 * n);
}

TEST_CASE("a curve that the answers do not support is not reported", "[analysis]") {
  Draws draws({5, turnpoint::random::Stream::observer, 0, 0, 0});
  const auto guessed = response_signal(session({0, 4, 0.3}, 60, draws), {}, Detecting::sides, 1).front();
  CHECK_FALSE(guessed.rate_per_s);
  REQUIRE(guessed.statements.size() == 1);
  CHECK(guessed.statements.front().code == "curve-undetermined");
  auto two_lags = session({2, 4, 0.3}, 60, draws);
  std::erase_if(two_lags, [](const auto& trial) { return *trial.signal_s > 0.3; });
  const auto few = response_signal(two_lags, {}, Detecting::sides, 1).front();
  CHECK(few.points.size() == 2);
  CHECK_FALSE(few.asymptote);
  CHECK(few.statements.front().code == "lags-too-few");
  auto without = session({2, 4, 0.3}, 60, draws);
  for (auto& trial : without) trial.signal_s.reset();
  CHECK(response_signal(without, {}, Detecting::sides, 1).empty());
}

TEST_CASE("medians and intervals of the curve agree with an independent computation", "[analysis]") {
  const double times_s[] = {0.42, 0.52, 0.67, 0.92, 1.32, 1.92};
  const int hits[] = {19, 23, 21, 17, 21, 22}, false_alarms[] = {7, 7, 9, 5, 5, 4};
  std::vector<TrialRecord> trials;
  for (std::size_t lag = 0; lag < 6; ++lag)
    for (int i = 0; i < 56; ++i) {
      TrialRecord trial;
      trial.right_choice = i < 28;
      trial.response = i < 28 ? i < hits[lag] : i - 28 < false_alarms[lag];
      trial.level = i < 28 ? 0.1 : -0.1;
      trial.response_time_s = times_s[lag];
      trial.signal_s = times_s[lag] - 0.32;
      trials.push_back(trial);
    }
  const auto curve = response_signal(trials, {}, Detecting::sides, 1).front();
  // expected numbers from make_response_signal.py
  const auto agrees = [](const Estimate& estimate, double low, double median, double high, double scale) {
    CHECK(estimate.interval.low == Approx(low).margin(0.02 * scale));
    CHECK(estimate.value == Approx(median).margin(0.02 * scale));
    CHECK(estimate.interval.high == Approx(high).margin(0.02 * scale));
  };
  agrees(*curve.asymptote, 1.175, 1.537, 2.737, 1.5);
  agrees(*curve.rate_per_s, 0.871, 8.275, 36.883, 15);
  agrees(*curve.intercept_s, 0.0064, 0.1477, 0.3712, 0.5);
}

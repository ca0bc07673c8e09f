#include <algorithm>
#include <cmath>

#include "station/analysis/psychometric_posterior.hpp"
#include "station/core/draws.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/reference_posterior.hpp"

using namespace turnpoint::analysis;
namespace rnd = turnpoint::core;

namespace {

/// Simulates a two-down-one-up staircase that starts at -5 dB, with steps of 2 dB and then 1 dB. Returns the
/// counts of answers per level.
std::vector<LevelCount> staircase(const Psychometric& truth, int trials, int run) {
  rnd::Draws draws({5, rnd::Stream::observer, run, 0, 0});
  std::vector<LevelCount> data;
  double level = -5;
  int right = 0;
  for (int i = 0; i < trials; ++i) {
    const bool one = draws.uniform() < probability(Function::weibull, Scale::linear, truth, level);
    data.push_back({level, 1, one});
    const double step = i < 20 ? 2 : 1;
    if (!one) level = std::min(level + step, -3.0), right = 0;
    if (one && ++right == 2) level = std::max(level - step, -30.0), right = 0;
  }
  return data;
}

/// Simulates a weighted staircase towards 75 % of a person who admits every guess. Answers that a forced
/// person would have guessed are counted as `admitted`, or as guesses that were made if `forced`.
std::vector<LevelCount> unforced(const Psychometric& truth, int trials, int run, bool forced = false) {
  rnd::Draws draws({8, rnd::Stream::observer, run, 0, 0});
  std::vector<LevelCount> data;
  double level = -5;
  bool lucky = false;
  for (int i = 0; i < trials; ++i) {
    const double p = probability(Function::weibull, Scale::linear, truth, level);
    const bool knows = draws.uniform() < 2 * p - 1;
    if (!knows) lucky = !lucky;  // exactly half of the guesses are right: their mean, without its own scatter
    data.push_back({level, 1, knows || (forced && lucky), knows || forced ? 0 : 0.5});
    const double step = i < 20 ? 2 : 1;
    level = std::clamp(level + (knows ? -step : step), -30.0, -3.0);
  }
  return data;
}

std::vector<LevelCount> fixed_levels(const FitOptions& options, const Psychometric& truth, int trials) {
  rnd::Draws draws({6, rnd::Stream::observer, 0, 0, 0});
  std::vector<LevelCount> data;
  for (const double level : {-20.0, -12.0, -6.0, -2.0, 2.0, 6.0, 12.0, 20.0})
    for (int i = 0; i < trials; ++i)
      data.push_back(
          {level, 1, draws.uniform() < probability(options.function, options.scale, truth, level)});
  return data;
}

bool says(const PosteriorFit& fit, const std::string& code) {
  const auto in = [&](const std::vector<Statement>& statements) {
    return std::any_of(statements.begin(), statements.end(), [&](const auto& s) { return s.code == code; });
  };
  return in(fit.fit.statements) || in(fit.intervals.statements);
}

reference::Samples sampled(const PosteriorFit& fit) {
  const auto& o = fit.fit.options;
  const auto& prior = *fit.intervals.prior;
  std::vector<reference::Level> data;
  for (const auto& point : fit.fit.data) data.push_back({point.level, point.trials, point.positive});
  reference::Prior same{prior.threshold_low, prior.threshold_high, prior.slope_low, prior.slope_high,
                        o.lapse_low,         o.lapse_high,         o.guess_value,   o.guess_value};
  if (o.guess == Guess::fitted) same.guess_low = o.guess_low, same.guess_high = o.guess_high;
  same.falling_share = prior.falling_share;
  same.guess_is_lapse = o.guess == Guess::tied_to_lapse;
  return reference::sample(
      o.function == Function::weibull ? reference::Shape::weibull_dB : reference::Shape::normal, data, same,
      1'500'000, 3);
}

/// Checks that 2.5 % of the samples lie below the interval, 2.5 % above it, and half of them below the
/// estimate, within sampling error.
void check_interval(const std::vector<double>& samples, double estimate, const ParameterInterval& found) {
  CHECK(reference::share_inside(samples, -1e300, estimate) == Approx(0.5).margin(0.03));
  CHECK(reference::share_inside(samples, -1e300, found.interval.low) == Approx(0.025).margin(0.01));
  CHECK(reference::share_inside(samples, found.interval.high, 1e300) == Approx(0.025).margin(0.01));
  const double width = found.interval.high - found.interval.low;
  CHECK(width < 1.1 * (reference::quantile(samples, 0.975) - reference::quantile(samples, 0.025)));
}

/// Negative control: the checks above must reject an interval that is a tenth narrower.
bool too_narrow_is_seen(const std::vector<double>& samples, const Interval& found) {
  const double cut = 0.05 * (found.high - found.low);
  return reference::share_inside(samples, found.low + cut, found.high - cut) < 0.94;
}

void check_all(const PosteriorFit& fit) {
  REQUIRE((fit.fit.parameters && fit.intervals.slope && fit.intervals.interval_75));
  const auto samples = sampled(fit);
  check_interval(samples.threshold, fit.fit.parameters->threshold, *fit.intervals.threshold);
  check_interval(samples.slope, fit.fit.parameters->slope, *fit.intervals.slope);
  check_interval(samples.level_75, *fit.intervals.level_75, *fit.intervals.interval_75);
  CHECK(too_narrow_is_seen(samples.threshold, fit.intervals.threshold->interval));
  if (fit.intervals.guess) check_interval(samples.guess, fit.fit.parameters->guess, *fit.intervals.guess);
}

const Prior kContrast = prior_around(Function::weibull, Scale::linear, {-30, -3}, std::nullopt);

}  // namespace

TEST_CASE("Posterior intervals agree with those of an independent sampler", "[analysis]") {
  for (const auto& [truth, trials] : {std::pair{Psychometric{-20, 2, 0.5, 0.02}, 200},
                                      {Psychometric{-9, 6, 0.5, 0.01}, 96},
                                      {Psychometric{-24, 1, 0.5, 0.05}, 200}})
    check_all(fit_posterior(staircase(truth, trials, 1), {}, kContrast, 0));
  FitOptions signed_sides;
  signed_sides.function = Function::normal;
  signed_sides.guess = Guess::tied_to_lapse;
  const auto prior = prior_around(Function::normal, Scale::linear, {-24, 24}, std::nullopt);
  check_all(fit_posterior(fixed_levels(signed_sides, {2, 5, 0.01, 0.01}, 12), signed_sides, prior, 0));
  FitOptions false_alarms;
  false_alarms.function = Function::normal;
  false_alarms.guess = Guess::fitted;
  check_all(fit_posterior(fixed_levels(false_alarms, {1, 4, 0.2, 0.02}, 20), false_alarms, prior, 0));
}

TEST_CASE("Posterior intervals agree with a dense grid in NumPy", "[analysis]") {
  // Computed with NumPy 2 on 1200 x 900 x 61 points (threshold, ln slope, lapse; trapezoidal rule) with the
  // prior below. The data are those of the reference fit in test_psychometric_fit.cpp.
  const std::vector<LevelCount> data = {{-30, 40, 20}, {-26, 40, 22}, {-22, 40, 27},
                                        {-18, 40, 34}, {-14, 40, 38}, {-10, 40, 39}};
  const auto fit = fit_posterior(data, {}, {-37, 4, 0.25, 15}, 0);
  REQUIRE((fit.fit.parameters && fit.intervals.slope && fit.intervals.interval_75));
  const auto near = [](const Interval& found, double low, double high) {
    CHECK(found.low == Approx(low).epsilon(0.005));
    CHECK(found.high == Approx(high).epsilon(0.005));
  };
  CHECK(fit.fit.parameters->threshold == Approx(-18.9222).epsilon(0.002));
  CHECK(fit.fit.parameters->slope == Approx(2.41142).epsilon(0.005));
  near(fit.intervals.threshold->interval, -21.1918, -16.6948);
  near(fit.intervals.slope->interval, 1.24920, 7.45432);
  near(fit.intervals.interval_75->interval, -22.1878, -17.8629);
}

TEST_CASE("Intervals of unforced choice contain the 75 % point as often as they claim, and no more often",
          "[analysis]") {
  const Psychometric truth{-17, 1.5, 0.5, 0};
  const double level_75 = -17 + 20 / 1.5 * std::log10(std::log(2.0));
  struct Held {
    int inside = 0, runs = 0;
    double width = 0;
    void add(const PosteriorFit& fit, double value) {
      if (!fit.intervals.interval_75) return;
      const auto found = fit.intervals.interval_75->interval;
      inside += found.low <= value && value <= found.high, ++runs, width += found.high - found.low;
    }
  };
  Held weighted, plain;
  for (int run = 0; run < 200; ++run) {
    const auto fit = fit_posterior(unforced(truth, 80, run), {}, kContrast, 0);
    CHECK(fit.fit.weight > 1.2);
    weighted.add(fit, level_75);
    // Negative control: if the same answers have the likelihood of forced ones, their intervals are too wide.
    const auto forced = fit_posterior(unforced(truth, 80, run, true), {}, kContrast, 0);
    CHECK(forced.fit.weight == 1);
    plain.add(forced, level_75);
  }
  const auto share = [](const Held& held) { return static_cast<double>(held.inside) / held.runs; };
  CHECK(weighted.runs > 190);
  INFO(share(weighted) << " " << share(plain) << " " << weighted.width / weighted.runs << " "
                       << plain.width / plain.runs);
  CHECK(share(weighted) > 0.92);
  CHECK(share(weighted) < 0.99);
  CHECK(share(plain) > 0.99);
  CHECK(weighted.width / weighted.runs < 0.85 * plain.width / plain.runs);
}

TEST_CASE("The grid resolves a posterior that is a thousand times narrower than its prior", "[analysis]") {
  FitOptions options;
  options.function = Function::normal;
  options.guess = Guess::tied_to_lapse;
  const auto data = fixed_levels(options, {2, 5, 0.01, 0.01}, 2000);
  const auto narrow = fit_posterior(data, options, {1, 3, 4, 6}, 0);
  const auto wide = fit_posterior(data, options, {-500, 500, 0.01, 1000}, 0);
  const auto a = narrow.intervals.threshold->interval, b = wide.intervals.threshold->interval;
  CHECK(b.low == Approx(a.low).margin(0.03 * (a.high - a.low)));
  CHECK(b.high == Approx(a.high).margin(0.03 * (a.high - a.low)));
  const auto maximum = fit_psychometric(data, options);
  CHECK(wide.fit.parameters->threshold == Approx(maximum.parameters->threshold).margin(0.02));
  CHECK(wide.fit.parameters->slope == Approx(maximum.parameters->slope).margin(0.05));
}

TEST_CASE("If the data limit a parameter on neither side, the posterior says so and gives no interval",
          "[analysis]") {
  const auto short_session = fit_posterior(staircase({-20, 2, 0.5, 0.02}, 16, 1), {}, kContrast, 61);
  CHECK_FALSE(short_session.intervals.slope);
  CHECK(says(short_session, "slope-undetermined"));
  const auto guessing =
      fit_posterior({{-20, 20, 12}, {-10, 20, 12}, {-3, 20, 13}}, {}, {-40, 4, 0.25, 15}, 61);
  CHECK(says(guessing, "interval-threshold"));
  CHECK(guessing.intervals.threshold->touches_high);
  CHECK_FALSE(guessing.intervals.threshold->touches_low);
  const auto sixteen_trials = fit_posterior({{-20, 8, 7}, {-3, 8, 7}}, {}, {-22, -8, 0.25, 15}, 61);
  CHECK_FALSE(sixteen_trials.fit.parameters);
  CHECK_FALSE(sixteen_trials.intervals.threshold);
  CHECK(says(sixteen_trials, "threshold-undetermined"));
}

TEST_CASE("If all answers are right, the threshold gets only an upper limit, and no estimate is made up",
          "[analysis]") {
  const auto fit = fit_posterior({{-20, 20, 20}, {-15, 20, 20}, {-10, 20, 20}}, {}, kContrast, 61);
  REQUIRE(fit.intervals.threshold);
  CHECK(fit.intervals.threshold->touches_low);
  CHECK_FALSE(fit.intervals.threshold->touches_high);
  CHECK(fit.intervals.interval_75->touches_low);
  CHECK(says(fit, "extrapolated"));
}

TEST_CASE("The posterior points out an estimate outside the middle half of the prior", "[analysis]") {
  const auto inside = fit_posterior(staircase({-20, 2, 0.5, 0.02}, 200, 1), {}, kContrast, 0);
  CHECK_FALSE(says(inside, "threshold-off-centre"));
  CHECK_FALSE(says(inside, "slope-off-centre"));
  const auto low = fit_posterior(staircase({-29, 2, 0.5, 0.02}, 200, 1), {}, kContrast, 0);
  CHECK(low.fit.parameters->threshold < -26.625);
  CHECK(says(low, "threshold-off-centre"));
  const auto steep = fit_posterior(staircase({-15, 9, 0.5, 0.02}, 400, 1), {}, kContrast, 0);
  CHECK(steep.fit.parameters->slope > 5.5);
  CHECK(says(steep, "slope-off-centre"));
  CHECK_FALSE(says(steep, "threshold-off-centre"));
}

TEST_CASE(
    "A prior that falls towards its ends has less weight there, and gives no estimate where a flat prior "
    "gives none",
    "[analysis]") {
  const auto data = staircase({-9, 0.5, 0.5, 0.01}, 48, 3);
  auto flat = kContrast;
  flat.falling_share = 0;
  const auto with = fit_posterior(data, {}, kContrast, 0), without = fit_posterior(data, {}, flat, 0);
  REQUIRE((with.intervals.threshold && without.intervals.threshold));
  CHECK(with.intervals.threshold->interval.low > without.intervals.threshold->interval.low);
  CHECK(with.intervals.slope.has_value() == without.intervals.slope.has_value());
  CHECK(with.intervals.threshold->touches_high == without.intervals.threshold->touches_high);
  CHECK_THROWS_AS(fit_posterior(data, {}, {-40, 4, 0.25, 15, 0.6}, 0), std::invalid_argument);
}

TEST_CASE("Posteriors refuse reversed data, too few trials and impossible options", "[analysis]") {
  CHECK(says(fit_posterior({{-20, 40, 38}, {-15, 40, 30}, {-10, 40, 21}}, {}, kContrast, 0), "reversed"));
  CHECK(says(fit_posterior({{-20, 4, 2}, {-15, 4, 4}}, {}, kContrast, 0), "too-few-trials"));
  CHECK(says(fit_posterior({}, {}, kContrast, 0), "no-trials"));
  CHECK_THROWS_AS(fit_posterior({{-20, 40, 41}}, {}, kContrast, 0), std::invalid_argument);
  CHECK_THROWS_AS(fit_posterior({{-20, 40, 30}}, {}, {4, -40, 0.25, 15}, 0), std::invalid_argument);
  CHECK_THROWS_AS(fit_posterior({{-20, 40, 30}}, {}, {-40, 4, 0, 15}, 0), std::invalid_argument);
  CHECK_THROWS_AS(prior_around(Function::weibull, Scale::log10, {0, 3}, std::nullopt), std::invalid_argument);
  CHECK_THROWS_AS(prior_around(Function::weibull, Scale::linear, {3, 3}, std::nullopt),
                  std::invalid_argument);
}

TEST_CASE("Every small table of answers has a finite posterior, or a statement why it has none",
          "[analysis]") {
  for (const auto function : {Function::weibull, Function::normal, Function::logistic})
    for (const auto guess : {Guess::fixed, Guess::fitted, Guess::tied_to_lapse})
      for (int code = 0; code < 216; code += guess == Guess::fitted ? 7 : 1) {
        FitOptions options;
        options.function = function;
        options.guess = guess;
        const auto fit = fit_posterior({{1, 5, code % 6}, {2, 5, code / 6 % 6}, {4, 5, code / 36}}, options,
                                       {0, 5, 0.1, 20}, 5);
        CHECK(fit.fit.parameters.has_value() + !fit.fit.statements.empty() >= 1);
        if (!fit.fit.parameters) continue;
        const auto& found = fit.intervals;
        for (const auto* interval : {&found.threshold, &found.slope, &found.interval_75, &found.lapse})
          if (*interval) {
            CHECK(std::isfinite((*interval)->interval.low));
            CHECK((*interval)->interval.low <= (*interval)->interval.high);
          }
        CHECK(found.threshold->interval.low <= fit.fit.parameters->threshold);
        CHECK(found.threshold->interval.high >= fit.fit.parameters->threshold);
        for (std::size_t i = 0; i < found.band_low.size(); ++i) {
          CHECK(found.band_low[i] >= 0);
          CHECK(found.band_low[i] <= found.band_high[i]);
          CHECK(found.band_high[i] <= 1);
        }
      }
}

TEST_CASE("A prior follows from the levels that a design can present, and from stated slopes", "[analysis]") {
  CHECK(kContrast.threshold_low == Approx(-36.75));
  CHECK(kContrast.threshold_high == Approx(3.75));
  CHECK(kContrast.slope_low == Approx(0.75 / 27 * 20 / std::log(10.0)));
  CHECK(kContrast.slope_high == Approx(48.0 / 27 * 20 / std::log(10.0)));
  const auto stated = prior_around(Function::weibull, Scale::linear, {-30, -3}, Range{0.2, 3});
  const auto flat = flat_part(Function::weibull, Scale::linear, stated);
  CHECK(flat.slope_low == Approx(0.2));
  CHECK(flat.slope_high == Approx(kContrast.slope_high / 2));
  CHECK(stated.slope_low == Approx(0.2 / std::pow(flat.slope_high / 0.2, 0.25)));
  const auto spread = prior_around(Function::normal, Scale::linear, {-24, 24}, Range{2, 15});
  CHECK(spread.slope_low == Approx(1));
  CHECK(spread.slope_high == Approx(64));
  const auto ratio = prior_around(Function::weibull, Scale::log10, {1, 16}, std::nullopt);
  CHECK(ratio.threshold_low == Approx(0.5));
  CHECK(ratio.threshold_high == Approx(32));
}

#include <algorithm>
#include <array>
#include <cmath>

#include "station/analysis/psychometric_fit.hpp"
#include "station/analysis/psychometric_posterior.hpp"
#include "station/core/draws.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::analysis;
namespace rnd = turnpoint::core;

namespace {

const std::vector<LevelCount> kReference = {{-30, 40, 20}, {-26, 40, 22}, {-22, 40, 27},
                                            {-18, 40, 34}, {-14, 40, 38}, {-10, 40, 39}};

bool says(const std::vector<Statement>& statements, const std::string& code) {
  for (const auto& statement : statements)
    if (statement.code == code) return true;
  return false;
}

std::vector<LevelCount> simulate(const FitOptions& o, const Psychometric& truth, std::vector<double> levels,
                                 int n, int run) {
  rnd::Draws draws({99, rnd::Stream::observer, run, 0, 0});
  std::vector<LevelCount> data;
  for (const double level : levels) {
    LevelCount point{level, n, 0};
    for (int i = 0; i < n; ++i)
      point.positive += draws.uniform() < probability(o.function, o.scale, truth, level);
    data.push_back(point);
  }
  return data;
}

}  // namespace

TEST_CASE("The maximum-likelihood fit of the reference data gives the known parameters", "[analysis]") {
  const auto fit = fit_psychometric(kReference, {});
  REQUIRE(fit.parameters);
  CHECK(fit.parameters->threshold == Approx(-18.9716).margin(5e-5));
  CHECK(fit.parameters->slope == Approx(2.3483).margin(5e-5));
  CHECK(fit.parameters->lapse == Approx(0.0306).margin(5e-5));
  CHECK(fit.negative_log_likelihood == Approx(110.14156).margin(5e-6));
  CHECK(fit.deviance == Approx(0.2833).margin(5e-5));
  CHECK(fit.free_parameters == 3);
  CHECK(fit.statements.empty());
}

TEST_CASE("An unsure answer counts as the share of a right one that a guess would be", "[analysis]") {
  std::vector<TrialRecord> trials(6);
  for (auto& trial : trials) trial.level = -10;
  trials[0].correct = true, trials[1].correct = false;
  trials[2].unsure = trials[3].unsure = true;
  trials[4].outcome = Outcome::timeout;
  trials[5].unsure = true, trials[5].type = TrialType::practice;
  const auto two = count_correct(trials), three = count_correct(trials, 3);
  REQUIRE(two.size() == 1);
  CHECK(two[0].trials == 4);
  CHECK(two[0].sum() == 2);
  CHECK(two[0].positive == 1);
  CHECK(three[0].sum() == Approx(1 + 2.0 / 3));

  // An observer who admits all guesses gives the same fit as one who makes them, with less scatter.
  const Psychometric truth{-18, 2, 0.5, 0};
  double guessed = 0, admitted = 0;
  const int runs = 40;
  for (int run = 0; run < runs; ++run) {
    rnd::Draws draws({7, rnd::Stream::observer, run, 0, 0});
    std::vector<LevelCount> forced, unforced;
    for (const double level : {-30.0, -25.0, -21.0, -18.0, -15.0, -11.0}) {
      const double knows = 2 * probability(Function::weibull, Scale::linear, truth, level) - 1;
      LevelCount a{level, 30, 0}, b{level, 30, 0};
      for (int i = 0; i < 30; ++i) {
        const bool known = draws.uniform() < knows, lucky = draws.uniform() < 0.5;
        a.positive += known || lucky ? 1 : 0;
        b.positive += known ? 1 : 0;
        b.admitted += known ? 0 : 0.5;
      }
      forced.push_back(a), unforced.push_back(b);
    }
    const auto one = fit_psychometric(forced, {}), other = fit_psychometric(unforced, {});
    REQUIRE((one.parameters && other.parameters));
    guessed += one.parameters->threshold / runs;
    admitted += other.parameters->threshold / runs;
  }
  CHECK(guessed == Approx(truth.threshold).margin(0.7));
  CHECK(admitted == Approx(truth.threshold).margin(0.4));
}

TEST_CASE("Degenerate data give a statement instead of a number", "[analysis]") {
  const auto refused = [](std::vector<LevelCount> data, const std::string& code) {
    const auto fit = fit_psychometric(data, {});
    CHECK_FALSE(fit.parameters.has_value());
    CHECK(says(fit.statements, code));
    const auto drawn = bootstrap(fit, {});
    CHECK_FALSE(drawn.threshold.has_value());
    CHECK(drawn.replicates == 0);
    CHECK(says(drawn.statements, "no-fit"));
  };
  SECTION("nothing answered") { refused({{-10, 0, 0}}, "no-trials"); }
  SECTION("one level") { refused({{-10, 40, 30}, {-10, 40, 35}}, "too-few-levels"); }
  SECTION("five trials") { refused({{-20, 1, 0}, {-15, 1, 1}, {-10, 1, 1}, {-5, 2, 2}}, "too-few-trials"); }
  SECTION("all right") { refused({{-20, 40, 40}, {-15, 40, 40}, {-10, 40, 40}}, "all-positive"); }
  SECTION("all wrong") { refused({{-20, 40, 0}, {-15, 40, 0}, {-10, 40, 0}}, "none-positive"); }
  SECTION("reversed") { refused({{-20, 40, 38}, {-15, 40, 30}, {-10, 40, 21}}, "reversed"); }
  SECTION("flat") { refused({{-20, 40, 21}, {-15, 40, 20}, {-10, 40, 21}}, "flat"); }
}

TEST_CASE("For data that form a step, the fit states a limit of the slope instead of an estimate",
          "[analysis]") {
  FitOptions options;
  options.function = Function::normal;
  options.guess = Guess::tied_to_lapse;
  const auto fit = fit_psychometric({{-20, 20, 0}, {-10, 20, 0}, {10, 20, 20}, {20, 20, 20}}, options);
  REQUIRE(fit.parameters);
  CHECK(says(fit.statements, "step"));
  CHECK(fit.at_bound.slope_low);
  CHECK(fit.parameters->threshold > -10);
  CHECK(fit.parameters->threshold < 10);
  const auto drawn = bootstrap(fit, {});
  CHECK(drawn.slope->touches_low);
  CHECK(says(drawn.statements, "interval-slope"));
}

TEST_CASE("The fit reports a lapse rate at its bound and an extrapolated threshold", "[analysis]") {
  const auto sleepy = fit_psychometric({{-30, 40, 20}, {-20, 40, 33}, {-10, 40, 34}, {-5, 40, 34}}, {});
  CHECK(sleepy.at_bound.lapse_high);
  CHECK(says(sleepy.statements, "lapse-bound"));
  const auto hard = fit_psychometric({{-30, 60, 31}, {-26, 60, 33}, {-22, 60, 36}, {-18, 60, 41}}, {});
  REQUIRE(hard.parameters);
  CHECK(hard.parameters->threshold > -18);
  CHECK(says(hard.statements, "extrapolated"));
}

TEST_CASE("Every small table of answers gives either finite numbers or no numbers", "[analysis]") {
  for (const auto function : {Function::weibull, Function::normal, Function::logistic})
    for (const auto guess : {Guess::fixed, Guess::fitted, Guess::tied_to_lapse})
      for (int code = 0; code < 216; ++code) {
        FitOptions options;
        options.function = function;
        options.guess = guess;
        const auto fit =
            fit_psychometric({{1, 5, code % 6}, {2, 5, code / 6 % 6}, {4, 5, code / 36}}, options);
        CHECK(fit.parameters.has_value() + !fit.statements.empty() >= 1);
        if (!fit.parameters) continue;
        CHECK(std::isfinite(fit.parameters->threshold));
        CHECK(fit.parameters->slope > 0);
        CHECK(std::isfinite(fit.parameters->slope));
        CHECK(fit.deviance >= 0);
        CHECK(fit.negative_log_likelihood < 30);
      }
}

TEST_CASE("No neighbouring parameters are more likely than the fitted ones", "[analysis]") {
  for (const auto function : {Function::weibull, Function::normal, Function::logistic}) {
    FitOptions options;
    options.function = function;
    const auto fit = fit_psychometric(kReference, options);
    REQUIRE(fit.parameters);
    const auto cost = [&](const Psychometric& at) {
      double sum = 0;
      for (const auto& d : kReference) {
        const double p = probability(function, Scale::linear, at, d.level);
        sum -= d.positive * std::log(p) + (d.trials - d.positive) * std::log(1 - p);
      }
      return sum;
    };
    const double best = cost(*fit.parameters);
    CHECK(best == Approx(fit.negative_log_likelihood).epsilon(1e-12));
    for (const double step : {-1e-2, -1e-3, 1e-3, 1e-2}) {
      auto moved = *fit.parameters;
      moved.threshold += step;
      CHECK(cost(moved) >= best);
      moved = *fit.parameters;
      moved.slope *= 1 + step;
      CHECK(cost(moved) >= best);
      moved = *fit.parameters;
      moved.lapse = std::clamp(moved.lapse + step, 0.0, 0.06);
      CHECK(cost(moved) >= best);
    }
  }
}

TEST_CASE("A Weibull function on a log10 scale equals the Weibull function in dB at the same levels",
          "[analysis]") {
  auto ratio = kReference;
  for (auto& point : ratio) point.level = std::pow(10.0, point.level / 20);
  FitOptions options;
  options.scale = Scale::log10;
  const auto in_dB = fit_psychometric(kReference, {}), in_ratio = fit_psychometric(ratio, options);
  REQUIRE(in_ratio.parameters);
  CHECK(20 * std::log10(in_ratio.parameters->threshold) == Approx(in_dB.parameters->threshold).epsilon(1e-7));
  CHECK(in_ratio.parameters->slope == Approx(in_dB.parameters->slope).epsilon(1e-6));
  CHECK(probability(Function::weibull, Scale::log10, {2, 3, 0.5, 0}, 4) ==
        Approx(1 - 0.5 * std::exp(-8.0)).epsilon(1e-14));
  CHECK_THROWS_AS(fit_psychometric({{0, 20, 9}, {1, 20, 15}, {2, 20, 19}}, options), std::invalid_argument);
}

TEST_CASE("The 75 % point takes guess and lapse into account", "[analysis]") {
  const Psychometric p{-19, 2.3, 0.5, 0.02};
  const auto level = level_at(Function::weibull, Scale::linear, p, 0.75);
  REQUIRE(level);
  CHECK(probability(Function::weibull, Scale::linear, p, *level) == Approx(0.75).epsilon(1e-12));
  CHECK_FALSE(level_at(Function::weibull, Scale::linear, p, 0.99).has_value());
  CHECK_FALSE(level_at(Function::weibull, Scale::linear, p, 0.5).has_value());
}

TEST_CASE("The fit recovers the PSE and spread of a biased observer, and refuses data with reversed sides",
          "[analysis]") {
  FitOptions options;
  options.function = Function::normal;
  options.guess = Guess::tied_to_lapse;
  const std::vector<double> levels{-30, -18, -9, -3, 3, 9, 18, 30};
  const auto data = simulate(options, {4, 8, 0.01, 0.01}, levels, 400, 1);
  const auto fit = fit_psychometric(data, options);
  REQUIRE(fit.parameters);
  CHECK(fit.parameters->threshold == Approx(4).margin(0.7));
  CHECK(fit.parameters->slope == Approx(8).margin(1));
  CHECK(fit.parameters->guess == fit.parameters->lapse);
  auto swapped = data;
  for (auto& point : swapped) point.positive = point.trials - point.positive;
  CHECK(says(fit_psychometric(swapped, options).statements, "reversed"));
}

TEST_CASE("A bootstrap depends only on its seed and stream", "[analysis]") {
  const auto fit = fit_psychometric(kReference, {});
  const auto one = bootstrap(fit, {}), again = bootstrap(fit, {}),
             other = bootstrap(fit, {1000, 0.95, 2, 0, 0});
  CHECK(one.threshold->interval.low == again.threshold->interval.low);
  CHECK(one.slope->interval.high == again.slope->interval.high);
  CHECK(one.threshold->interval.low != other.threshold->interval.low);
  CHECK(one.threshold->interval.low == Approx(other.threshold->interval.low).margin(0.5));
  REQUIRE(one.band_level.size() == 61);
  for (std::size_t i = 0; i < one.band_level.size(); ++i) {
    const double p = probability(Function::weibull, Scale::linear, *fit.parameters, one.band_level[i]);
    CHECK(one.band_low[i] <= p);
    CHECK(one.band_high[i] >= p);
  }
  CHECK(*one.deviance_p > 0.5);
  CHECK_THROWS_AS(bootstrap(fit, {10, 0.95, 1, 0, 0}), std::invalid_argument);
}

namespace {

/// -ln likelihood, written apart from the fit. With `p75`, the threshold is the level of three quarters.
double cost(const FitOptions& options, const std::vector<LevelCount>& data, double threshold, double slope,
            double lapse, double guess, bool p75) {
  if (options.guess == Guess::fixed) guess = options.guess_value;
  double sum = 0;
  for (const auto& point : data) {
    double p = guess;
    if (point.level != kNoise) {
      double turns = std::pow(point.level / threshold, slope);
      if (p75) {
        const double inside = (0.75 - guess) / (1 - guess - lapse);
        if (!(inside > 0 && inside < 1)) return 1e9;
        turns *= -std::log(1 - inside);
      }
      p += (1 - guess - lapse) * (1 - std::exp(-turns));
    }
    p = std::min(std::max(p, 1e-12), 1 - 1e-12);
    sum -= point.positive * std::log(p) + (point.trials - point.positive) * std::log(1 - p);
  }
  return sum;
}

/// The lowest cost with this threshold: over a grid, then by halved steps from its ten best points.
double lowest(const FitOptions& options, const std::vector<LevelCount>& data, double threshold, bool p75) {
  double first = 1e9, last = 0;
  for (const auto& point : data)
    if (point.level != kNoise) first = std::min(first, point.level), last = std::max(last, point.level);
  const double range_dB = 20 * std::log10(last / first), dB = std::log(10) / 20;
  const std::array<double, 3> low{std::log(0.1 / range_dB / dB), 0, 0},
      high{std::log(80 / range_dB / dB), options.lapse_high, options.guess_high};
  const auto at = [&](const std::array<double, 3>& x) {
    return cost(options, data, threshold, std::exp(x[0]), x[1], x[2], p75);
  };
  std::vector<std::pair<double, std::array<double, 3>>> grid;
  const bool free = options.guess == Guess::fitted;
  for (int s = 0; s <= 60; ++s)
    for (int l = 0; l <= 2; ++l)
      for (int g = 0; g <= (free ? 30 : 0); ++g) {
        const std::array<double, 3> x{low[0] + s * (high[0] - low[0]) / 60, l * high[1] / 2,
                                      g * high[2] / 30};
        grid.push_back({at(x), x});
      }
  std::partial_sort(grid.begin(), grid.begin() + 10, grid.end());
  double best = grid[0].first;
  for (int i = 0; i < 10; ++i) {
    auto [here, x] = grid[i];
    for (double step = 0.05; step > 1e-6;) {
      bool moved = false;
      for (std::size_t k = 0; k < (free ? 3u : 2u); ++k)
        for (const double side : {-1.0, 1.0}) {
          auto next = x;
          next[k] = std::clamp(x[k] + side * step * (high[k] - low[k]), low[k], high[k]);
          if (const double value = at(next); value < here - 1e-12) here = value, x = next, moved = true;
        }
      if (!moved) step /= 2;
    }
    best = std::min(best, here);
  }
  return best;
}

}  // namespace

TEST_CASE("An interval ends where functions with that threshold stop being likely enough, at both ends alike",
          "[analysis]") {
  // With the threshold held, a steep and a shallow function can each be a maximum; the likelihood can fall
  // quickly where the threshold passes a level, and rise again beyond.
  FitOptions three, detection, two;
  two.scale = three.scale = detection.scale = Scale::log10;
  three.guess_value = 1.0 / 3;
  detection.guess = Guess::fitted, detection.guess_high = 0.9;
  const std::vector<std::pair<FitOptions, std::vector<LevelCount>>> sessions{
      {three,
       {{0.049, 18, 7}, {0.089, 18, 6}, {0.137, 18, 14}, {0.253, 18, 14}, {0.421, 18, 16}, {0.708, 18, 18}}},
      {detection, {{kNoise, 24, 6}, {0.048, 12, 4}, {0.115, 12, 3}, {0.283, 12, 9}, {0.699, 12, 12}}},
      {detection, {{kNoise, 42, 9}, {0.051, 11, 6}, {0.124, 11, 4}, {0.302, 11, 11}, {0.733, 9, 9}}},
      {detection, {{kNoise, 18, 5}, {0.05, 18, 5}, {0.126, 18, 7}, {0.3175, 18, 9}, {0.8, 18, 17}}},
      {detection, {{kNoise, 25, 0}, {0.05, 25, 0}, {0.2, 25, 1}, {0.8, 25, 23}}},
      {detection, {{kNoise, 21, 7}, {0.05, 21, 9}, {0.126, 21, 19}, {0.3175, 21, 21}, {0.8, 21, 21}}},
      {two, {{0.05, 12, 6}, {0.1, 12, 5}, {0.2, 12, 12}, {0.4, 12, 12}, {0.8, 12, 12}}},
      {three,
       {{0.05, 27, 5},
        {0.0794, 27, 8},
        {0.126, 27, 9},
        {0.2, 27, 13},
        {0.3175, 27, 25},
        {0.504, 27, 26},
        {0.8, 27, 27}}},
      {three, {{0.05, 8, 1}, {0.1, 8, 5}, {0.2, 8, 6}, {0.4, 8, 8}, {0.8, 8, 8}}}};
  for (std::size_t i = 0; i < sessions.size(); ++i)
    for (const bool p75 : {false, true}) {
      INFO("session " << i << (p75 ? ", level of 75 %" : ", threshold"));
      const auto& [options, data] = sessions[i];
      const auto fit = fit_psychometric(data, options);
      REQUIRE(fit.parameters);
      const auto drawn = bootstrap(fit, {100, 0.95, 3, 0, 0});
      const auto found = p75 ? drawn.interval_75 : drawn.threshold;
      REQUIRE(found);
      const auto ratio = [&, &opts = options, &counts = data](double level) {
        return 2 * (lowest(opts, counts, level, p75) - fit.negative_log_likelihood);
      };
      const double low = found->interval.low, high = found->interval.high, past = std::pow(high / low, 0.005);
      // the ratio rises from below the critical value to above it within a hundredth of the interval
      double least = 1e9, most = 0;
      if (!found->touches_low)
        least = std::min(least, ratio(low / past)), most = std::max(most, ratio(low * past));
      if (!found->touches_high)
        least = std::min(least, ratio(high * past)), most = std::max(most, ratio(high / past));
      INFO("from " << low << " to " << high << ": inside " << most << ", outside " << least);
      CHECK(least > 3.84);
      CHECK(most < least);
    }
}

TEST_CASE("The fit agrees with psignifit 4.3 on the same data", "[analysis]") {
  // Results of psignifit 4.3 (Python) for 2AFC with the sigmoids weibull and norm, default priors and the
  // maximum a posteriori. `threshold` is the 50 % point and `width` the 5-95 % range of the sigmoid; `low`
  // and `high` are the ends of the threshold's 95 % interval.
  struct Row {
    Function function;
    double threshold, width, low, high;
  };
  for (const auto& row : {Row{Function::weibull, -20.2060, 15.8910, -23.757, -18.151},
                          Row{Function::normal, -20.4433, 14.9262, -23.919, -18.466},
                          Row{Function::logistic, -20.3786, 16.0479, -23.824, -18.447}}) {
    FitOptions options;
    options.function = row.function;
    options.lapse_high = 0.1;
    const auto fit = fit_psychometric(kReference, options);
    REQUIRE(fit.parameters);
    const double rate = rate_from_slope(row.function, fit.parameters->slope);
    const double half = fit.parameters->threshold + sigmoid_inverse(row.function, 0.5) / rate;
    const double width = (sigmoid_inverse(row.function, 0.95) - sigmoid_inverse(row.function, 0.05)) / rate;
    CHECK(half == Approx(row.threshold).margin(0.25));
    CHECK(width == Approx(row.width).epsilon(0.1));  // psignifit's prior makes the width larger
    const auto drawn = bootstrap(fit, {});
    const double shift = half - fit.parameters->threshold;
    CHECK(drawn.threshold->interval.low + shift == Approx(row.low).margin(1.2));
    CHECK(drawn.threshold->interval.high + shift == Approx(row.high).margin(1.2));
  }
}

TEST_CASE("Bootstrap intervals contain the true value about as often as they claim", "[analysis]") {
  // A longer run (400 sessions with 300 replicates) measured how often the intervals of threshold, slope and
  // 75 % point contain the true value. Weibull, 6 levels x 40 trials: .95, .93, .94. Normal with the guess
  // rate tied to the lapse rate, 8 levels x 20: .95, .94, .94. Normal without lapse, 8 levels x 10: .97, .94,
  // .94. With the fewer sessions of this test, two standard errors are .04.
  struct Design {
    FitOptions options;
    Psychometric truth;
    std::vector<double> levels;
    int trials;
  };
  FitOptions signed_sides;
  signed_sides.function = Function::normal;
  signed_sides.guess = Guess::tied_to_lapse;
  signed_sides.lapse_high = 0.04;
  const int sessions = 120;
  for (const auto& design :
       {Design{{}, {-19, 2.3, 0.5, 0.02}, {-30, -26, -22, -18, -14, -10}, 40},
        Design{signed_sides, {2, 8, 0.01, 0.01}, {-30, -18, -9, -3, 3, 9, 18, 30}, 10}}) {
    int threshold = 0, slope = 0, narrow = 0;
    for (int run = 0; run < sessions; ++run) {
      const auto data = simulate(design.options, design.truth, design.levels, design.trials, run);
      const auto fit = fit_psychometric(data, design.options);
      REQUIRE(fit.parameters);
      const auto drawn = bootstrap(fit, {100, 0.95, 7, run, 0});
      const auto inside = [](double low, double high, double value) { return low <= value && value <= high; };
      const auto t = drawn.threshold->interval, s = drawn.slope->interval;
      threshold += inside(t.low, t.high, design.truth.threshold);
      slope += inside(s.low, s.high, design.truth.slope);
      const double quarter = (t.high - t.low) / 4, middle = (t.high + t.low) / 2;
      narrow += inside(middle - quarter, middle + quarter, design.truth.threshold);
    }
    CHECK(threshold >= 0.91 * sessions);
    CHECK(slope >= 0.90 * sessions);
    // Negative control: intervals of half the width contain the true threshold too rarely.
    CHECK(narrow < 0.85 * sessions);
  }
}

TEST_CASE("Trials without a signal determine the rate of false alarms", "[analysis]") {
  // The data are the expected counts for P = .2 + .78 (1 - exp(-(x/4)^2)), so the fit must return these
  // parameters.
  FitOptions options;
  options.scale = Scale::log10;
  options.guess = Guess::fitted;
  options.guess_high = 0.9;
  const int n = 100'000;
  std::vector<LevelCount> data{{kNoise, n, 20'000}};
  for (const double level : {1.0, 2.0, 4.0, 8.0, 16.0})
    data.push_back(
        {level, n, static_cast<int>(std::lround(n * (0.2 + 0.78 * (1 - std::exp(-level * level / 16)))))});
  const auto fit = fit_psychometric(data, options);
  REQUIRE(fit.parameters);
  CHECK(fit.parameters->threshold == Approx(4).epsilon(1e-3));
  CHECK(fit.parameters->slope == Approx(2).epsilon(3e-3));
  CHECK(fit.parameters->guess == Approx(0.2).margin(1e-3));
  CHECK(fit.parameters->lapse == Approx(0.02).margin(1e-3));
  // Many trials without a signal determine the guess rate, even if there are few trials at the other levels.
  for (auto& point : data) point.trials /= 1000, point.positive /= 1000;
  data[0] = {kNoise, 400, 160};
  const auto found = bootstrap(fit_psychometric(data, options), {100, 0.95, 1, 0, 5});
  REQUIRE(found.guess);
  CHECK(found.guess->interval.low > 0.3);
  CHECK(found.guess->interval.high < 0.5);
  CHECK(found.band_level.front() > 0.5);  // the band covers only levels with a signal
  const auto posterior = fit_posterior(data, options, {0.5, 30, 0.3, 10}, 5);
  REQUIRE(posterior.intervals.guess);
  CHECK(posterior.intervals.guess->interval.low > 0.3);
  CHECK(posterior.intervals.guess->interval.high < 0.5);
}

TEST_CASE(
    "an interval that ends at a bound says so, even if the best curve at the bound itself is hard to find",
    "[analysis]") {
  FitOptions options;
  options.function = Function::weibull;
  options.scale = Scale::log10;
  const auto fit = fit_psychometric(
      {{0.051, 19, 4}, {0.087, 19, 14}, {0.137, 19, 11}, {0.243, 19, 16}, {0.432, 19, 19}, {0.68, 19, 18}},
      options);
  const auto drawn = bootstrap(fit, {});
  // with this steep a slope the likelihood is still only 0.6 below its maximum
  REQUIRE(drawn.slope);
  CHECK(drawn.slope->interval.high > 30);
  CHECK(drawn.slope->touches_high);
  CHECK_FALSE(drawn.slope->touches_low);
}

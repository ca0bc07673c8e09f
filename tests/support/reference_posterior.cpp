#include "tests/support/reference_posterior.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "station/core/draws.hpp"

namespace reference {

namespace {

namespace rnd = turnpoint::core;

constexpr int kKeptOneIn = 5;

using Point = std::array<double, 4>;  // the parameters: threshold, ln slope, lapse, guess

double guess_of(const Prior& prior, const Point& at) { return prior.guess_is_lapse ? at[2] : at[3]; }

double probability(Shape shape, double guess, const Point& at, double x) {
  const double slope = std::exp(at[1]);
  const double f = shape == Shape::weibull_dB ? 1 - std::exp(-std::pow(10, slope * (x - at[0]) / 20))
                                              : std::erfc((at[0] - x) / slope / std::numbers::sqrt2) / 2;
  return guess + (1 - guess - at[2]) * f;
}

/// Returns the logarithm of the prior density of threshold or ln slope, at this fraction of the parameter's
/// range.
double log_prior(double at, double falling_share) {
  const double nearest = std::min(at, 1 - at);
  return nearest < falling_share ? std::log(nearest / falling_share) : 0;
}

double log_posterior(Shape shape, const std::vector<Level>& data, const Prior& prior, const Point& at) {
  double sum = 0;
  if (prior.falling_share > 0)
    sum += log_prior((at[0] - prior.threshold_low) / (prior.threshold_high - prior.threshold_low),
                     prior.falling_share) +
           log_prior((at[1] - std::log(prior.slope_low)) / std::log(prior.slope_high / prior.slope_low),
                     prior.falling_share);
  for (const auto& point : data) {
    const double p = std::clamp(probability(shape, guess_of(prior, at), at, point.level), 1e-12, 1 - 1e-12);
    sum += point.positive * std::log(p) + (point.trials - point.positive) * std::log(1 - p);
  }
  return sum;
}

/// Finds the 75 % level by bisection, because the psychometric function is increasing.
double level_75(Shape shape, const Prior& prior, const Point& at) {
  const double guess = guess_of(prior, at);
  if (!(guess < 0.75 && 1 - at[2] > 0.75)) return std::nan("");
  const double slope = std::exp(at[1]), reach = shape == Shape::weibull_dB ? 200 / slope : 10 * slope;
  double low = at[0] - reach, high = at[0] + reach;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (probability(shape, guess, at, middle) < 0.75 ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

std::vector<Level> merged(std::vector<Level> levels) {
  std::sort(levels.begin(), levels.end(), [](const Level& a, const Level& b) { return a.level < b.level; });
  std::vector<Level> result;
  for (const auto& one : levels) {
    if (result.empty() || result.back().level < one.level) result.push_back({one.level, 0, 0});
    result.back().trials += one.trials, result.back().positive += one.positive;
  }
  return result;
}

Samples sample(Shape shape, const std::vector<Level>& data, const Prior& prior, int steps,
               std::uint64_t seed) {
  rnd::Draws draws({seed, rnd::Stream::observer, 1, 0, 0});
  const Point low{prior.threshold_low, std::log(prior.slope_low), prior.lapse_low, prior.guess_low};
  const Point high{prior.threshold_high, std::log(prior.slope_high), prior.lapse_high, prior.guess_high};
  Point here{};
  double value = -1e300;
  for (int i = 0; i < 500; ++i) {
    Point start;
    for (std::size_t k = 0; k < 4; ++k) start[k] = draws.uniform(low[k], high[k]);
    const double found = log_posterior(shape, data, prior, start);
    if (found > value) value = found, here = start;
  }
  Samples samples;
  for (int i = -steps / 10; i < steps; ++i) {
    Point next = here;
    const double scale = std::pow(10, draws.uniform(-3, 0));
    bool inside = true;
    for (std::size_t k = 0; k < 4; ++k) {
      next[k] += scale * (high[k] - low[k]) * draws.normal();
      inside = inside && next[k] >= low[k] && next[k] <= high[k];
    }
    if (inside) {
      const double found = log_posterior(shape, data, prior, next);
      if (found >= value || draws.uniform() < std::exp(found - value)) here = next, value = found;
    }
    if (i < 0 || i % kKeptOneIn != 0) continue;
    samples.threshold.push_back(here[0]), samples.slope.push_back(std::exp(here[1]));
    samples.lapse.push_back(here[2]), samples.guess.push_back(guess_of(prior, here));
    samples.level_75.push_back(level_75(shape, prior, here));
  }
  return samples;
}

double quantile(std::vector<double> values, double p) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return std::isnan(v); }),
               values.end());
  const auto at = values.begin() + static_cast<long>(p * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double share_inside(const std::vector<double>& values, double low, double high) {
  const auto inside =
      std::count_if(values.begin(), values.end(), [&](double v) { return v >= low && v <= high; });
  return static_cast<double>(inside) / static_cast<double>(values.size());
}

}  // namespace reference

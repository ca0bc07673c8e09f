#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "station/analysis/fit_bounds.hpp"
#include "station/analysis/proportion.hpp"
#include "station/analysis/psychometric_fit.hpp"
#include "station/analysis/quantile.hpp"
#include "station/core/draws.hpp"

namespace turnpoint::analysis {

namespace {

/// A quantity for which an interval is computed: the element of theta with the index `parameter`. With an
/// `anchor`, theta[0] is the level at which the probability is `anchor`; without one, it is the threshold.
struct Quantity {
  int parameter;
  std::optional<double> anchor;
};

/// Holds everything that is needed to repeat a fit on resampled counts.
struct Replicator {
  FitOptions options;
  AxisCounts counts;
  ThetaBounds bounds;
  Theta best{};
  std::vector<double> model;  ///< fitted probability at each level

  Likelihood likelihood(const AxisCounts& of, const ThetaBounds& within,
                        std::optional<double> anchor = std::nullopt) const {
    return {options.function, options.guess, of, within, anchor};
  }

  AxisCounts draw(const core::DrawKey& key) const {
    core::Draws draws(key);
    AxisCounts drawn = counts;
    for (std::size_t i = 0; i < drawn.u.size(); ++i) {
      drawn.positive[i] = 0;
      drawn.trials[i] = std::max(1.0, std::round(counts.trials[i]));  // whole, unless answers are weighted
      for (int n = 0; n < static_cast<int>(drawn.trials[i]); ++n)
        drawn.positive[i] += draws.uniform() < model[i] ? 1 : 0;
    }
    return drawn;
  }

  Likelihood::Maximum fit(const AxisCounts& drawn) const {
    const auto of = likelihood(drawn, bounds);
    const auto first = of.climb(best);
    // Climb also from the middle of the allowed thresholds and lapses, because the first climb can end in a
    // local maximum with the lapse on its bound.
    Theta other = best;
    other[0] = (bounds.low[0] + bounds.high[0]) / 2;
    other[2] = (bounds.low[2] + bounds.high[2]) / 2;
    const auto second = of.climb(other);
    return second.negative_log < first.negative_log - 1e-9 ? second : first;
  }

  /// Returns the maximum of the likelihood with `quantity` fixed at a value. The climb begins at `start`.
  Likelihood::Maximum held(const AxisCounts& of, const Quantity& quantity, double value, Theta start) const {
    const ThetaBounds narrowed = with(quantity, value);
    start[quantity.parameter] = value;
    return likelihood(of, narrowed, quantity.anchor).climb(start);
  }

  /// The same for the counts of the session, searched for from other starts as well: with the threshold held,
  /// a steep and a shallow function can each be a maximum.
  Likelihood::Maximum highest(const Quantity& quantity, double value, const Theta& start) const {
    const ThetaBounds narrowed = with(quantity, value);
    const auto near = held(counts, quantity, value, start);
    const auto other = likelihood(counts, narrowed, quantity.anchor).search();
    return other.negative_log < near.negative_log ? other : near;
  }

  ThetaBounds with(const Quantity& quantity, double value) const {
    ThetaBounds narrowed = bounds;
    narrowed.low[quantity.parameter] = narrowed.high[quantity.parameter] = value;
    return narrowed;
  }
};

double saturated(const AxisCounts& counts) {
  double sum = 0;
  for (std::size_t i = 0; i < counts.u.size(); ++i) {
    const double k = counts.positive[i], n = counts.trials[i];
    if (k > 0) sum -= k * std::log(k / n);
    if (k < n) sum -= (n - k) * std::log((n - k) / n);
  }
  return sum;
}

Replicator replicator(const PsychometricFit& fit) {
  Replicator result;
  result.options = fit.options;
  result.counts = axis_counts(fit.data, fit.options.function, fit.options.scale, fit.weight);
  result.bounds = theta_bounds(result.counts, fit.options);
  const auto& p = *fit.parameters;
  result.best = {axis_position(fit.options.function, fit.options.scale, p.threshold),
                 std::log(rate_from_slope(fit.options.function, p.slope)), p.lapse, p.guess};
  for (const auto& point : fit.data)
    result.model.push_back(point.level == kNoise
                               ? p.guess
                               : probability(fit.options.function, fit.options.scale, p, point.level));
  return result;
}

/// Finds one end of a profile-likelihood interval: the value of the quantity, between the estimate and
/// `bound`, beyond which the likelihood ratio stays above `critical`. The ratio may rise and fall on the way:
/// of 16 values between estimate and bound, none that the data allow lies outside. Returns `bound` if the ratio there is at most `critical`.
double profile_end(const Replicator& base, const Quantity& quantity, Theta start, double bound,
                   double best_cost, double critical) {
  const double estimate = start[quantity.parameter];
  const auto allowed = [&](double value) {
    const auto found = base.highest(quantity, value, start);
    const bool inside = 2 * (found.negative_log - best_cost) <= critical;
    if (inside) start = found.theta;
    return inside;
  };
  if (allowed(bound)) return bound;
  constexpr int cells = 16;
  double inside = estimate, outside = bound;
  for (int i = 1; i < cells && inside == estimate; ++i)
    if (const double value = bound + i * (estimate - bound) / cells; allowed(value))
      inside = value;
    else
      outside = value;
  for (int i = 0; i < 40 && std::abs(outside - inside) > 1e-5 * (1 + std::abs(inside)); ++i) {
    const double middle = (inside + outside) / 2;
    (allowed(middle) ? inside : outside) = middle;
  }
  // At the bound itself the search may find a lower maximum than close to it.
  return outside == bound ? bound : (inside + outside) / 2;
}

ParameterInterval profile(const Replicator& base, const Quantity& quantity, const Theta& start,
                          double best_cost, std::vector<double> ratios, double confidence) {
  // The critical value is at least the chi-square value. If the fitted slope is too steep, the replicates
  // hardly vary, and their own critical value is too small.
  const double z = normal_quantile(0.5 + confidence / 2);
  const double critical = std::max(quantile(std::move(ratios), confidence), z * z);
  const double low = base.bounds.low[quantity.parameter], high = base.bounds.high[quantity.parameter];
  ParameterInterval result;
  result.interval = {profile_end(base, quantity, start, low, best_cost, critical),
                     profile_end(base, quantity, start, high, best_cost, critical), confidence};
  result.touches_low = result.interval.low <= low;
  result.touches_high = result.interval.high >= high;
  return result;
}

ParameterInterval percentile(std::vector<double> values, double confidence, double low, double high) {
  ParameterInterval result{percentile_interval(std::move(values), confidence), false, false};
  const double margin = 1e-6 * (high - low);
  result.touches_low = result.interval.low <= low + margin;
  result.touches_high = result.interval.high >= high - margin;
  return result;
}

/// Applies a monotone function to both ends of an interval. A decreasing function swaps the ends.
template <class Map>
ParameterInterval mapped(const ParameterInterval& from, Map map) {
  auto result = from;
  result.interval.low = map(from.interval.low);
  result.interval.high = map(from.interval.high);
  if (result.interval.low > result.interval.high) {
    std::swap(result.interval.low, result.interval.high);
    std::swap(result.touches_low, result.touches_high);
  }
  return result;
}

void add_band(PsychometricIntervals& result, const Replicator& base, const std::vector<Theta>& thetas,
              int points) {
  const double first = base.counts.lowest(), last = base.counts.u.back(), margin = 0.04 * (last - first);
  const Likelihood likelihood(base.options.function, base.options.guess, base.counts, base.bounds);
  for (int i = 0; i < points; ++i) {
    const double u = first - margin + i * (last - first + 2 * margin) / (points - 1);
    std::vector<double> values;
    for (const auto& theta : thetas) values.push_back(likelihood.probability(theta, u));
    const auto range = percentile_interval(std::move(values), result.confidence);
    result.band_level.push_back(level_from_axis(base.options.function, base.options.scale, u));
    result.band_low.push_back(range.low);
    result.band_high.push_back(range.high);
  }
}

/// The replicates of one fit: their parameters; how many of them have a deviance of at least that of the fit;
/// and, for each quantity, the likelihood ratio of the fitted value in each replicate.
struct Replicates {
  std::vector<Theta> thetas;
  std::vector<std::vector<double>> ratios;
  int beyond = 0;
};

Replicates replicate(const Replicator& base, const BootstrapOptions& options, double deviance,
                     const std::vector<Quantity>& quantities, const std::vector<Theta>& values) {
  Replicates result;
  result.ratios.resize(quantities.size());
  for (int i = 0; i < options.replicates; ++i) {
    const auto drawn = base.draw({options.seed, core::Stream::bootstrap, options.stream, 0, i});
    const auto fitted = base.fit(drawn);
    result.thetas.push_back(fitted.theta);
    result.beyond += 2 * (fitted.negative_log - saturated(drawn)) >= deviance - 1e-9 ? 1 : 0;
    for (std::size_t q = 0; q < quantities.size(); ++q) {
      const auto held = base.held(drawn, quantities[q], values[q][quantities[q].parameter], values[q]);
      result.ratios[q].push_back(std::max(0.0, 2 * (held.negative_log - fitted.negative_log)));
    }
  }
  return result;
}

}  // namespace

PsychometricIntervals bootstrap(const PsychometricFit& fit, const BootstrapOptions& options) {
  if (options.replicates < 40 || !(options.confidence > 0 && options.confidence < 1))
    throw std::invalid_argument(
        "bootstrap: there must be at least 40 replicates, and the confidence must be between 0 and 1");
  PsychometricIntervals result;
  result.confidence = options.confidence;
  if (!fit.parameters) {
    result.statements.push_back({"no-fit", core::phrase("statement.no_fit")});
    return result;
  }
  const auto function = fit.options.function;
  const auto scale = fit.options.scale;
  const auto base = replicator(fit);
  std::vector<Quantity> quantities{{0, std::nullopt}, {1, std::nullopt}};
  std::vector<Theta> values{base.best, base.best};
  result.level_75 = level_at(function, scale, *fit.parameters, 0.75);
  if (result.level_75) {
    quantities.push_back({0, 0.75});
    values.push_back(base.best);
    values[2][0] = axis_position(function, scale, *result.level_75);
  }
  const auto drawn = replicate(base, options, fit.deviance, quantities, values);
  result.method = IntervalMethod::bootstrap;
  result.replicates = options.replicates;
  const auto of = [&](int q) {
    return profile(base, quantities[q], values[q], fit.negative_log_likelihood, drawn.ratios[q],
                   options.confidence);
  };
  const auto to_level = [&](double u) { return level_from_axis(function, scale, u); };
  const auto to_slope = [&](double r) { return slope_from_rate(function, std::exp(r)); };
  result.threshold = mapped(of(0), to_level);
  if (base.bounds.low[1] < base.bounds.high[1]) result.slope = mapped(of(1), to_slope);
  if (result.level_75) result.interval_75 = mapped(of(2), to_level);
  const auto share = [&](int parameter) {
    std::vector<double> column;
    for (const auto& theta : drawn.thetas) column.push_back(theta[parameter]);
    return percentile(std::move(column), options.confidence, base.bounds.low[parameter],
                      base.bounds.high[parameter]);
  };
  if (base.bounds.low[2] < base.bounds.high[2]) result.lapse = share(2);
  if (fit.options.guess == Guess::fitted) result.guess = share(3);
  if (static_cast<int>(fit.data.size()) > fit.free_parameters)
    result.deviance_p = (drawn.beyond + 1.0) / (options.replicates + 1.0);
  if (options.band_points > 1) add_band(result, base, drawn.thetas, options.band_points);
  say_what_touches(result);
  return result;
}

}  // namespace turnpoint::analysis

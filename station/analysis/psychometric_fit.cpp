#include "station/analysis/psychometric_fit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "station/analysis/fit_bounds.hpp"
#include "station/core/number.hpp"

namespace turnpoint::analysis {

using core::phrase, core::plain;

namespace {

void check(const std::vector<LevelCount>& data, const FitOptions& options) {
  for (const auto& point : data)
    if (!(std::isfinite(point.level) || point.level == kNoise) || point.trials < 0 || point.positive < 0 ||
        point.admitted < 0 || point.sum() > point.trials)
      throw std::invalid_argument(
          "level " + core::number(point.level) + ": " + core::number(point.sum()) + " of " +
          std::to_string(point.trials) +
          " trials; the level must be finite, and there cannot be more positive answers than trials");
  const auto inside = [](double low, double high, double most) {
    return low >= 0 && low <= high && high < most + 1e-12;
  };
  if (!inside(options.lapse_low, options.lapse_high, 0.5) ||
      !inside(options.guess_low, options.guess_high, 0.9) ||
      (options.guess == Guess::fitted && options.guess_high + options.lapse_high >= 1))
    throw std::invalid_argument(
        "bounds of lapse and guess: they must meet 0 <= low <= high, with a lapse of at most 0.5, a guess of "
        "at most 0.9, and a sum below 1");
  if (options.guess != Guess::fixed &&
      std::any_of(data.begin(), data.end(), [](const auto& point) { return point.admitted > 0; }))
    throw std::invalid_argument("unsure answers need a lower asymptote that is known");
  if (options.guess == Guess::fixed && !(options.guess_value >= 0 && options.guess_value < 1))
    throw std::invalid_argument("guess " + core::number(options.guess_value) +
                                ": it must be at least 0 and below 1");
}

/// Sorts the levels, merges equal levels and removes levels without trials.
std::vector<LevelCount> merged(const std::vector<LevelCount>& data) {
  std::map<double, LevelCount> by_level;
  for (const auto& point : data) {
    if (point.trials == 0) continue;
    auto& entry = by_level[point.level];
    entry.level = point.level;
    entry.trials += point.trials;
    entry.positive += point.positive;
    entry.admitted += point.admitted;
  }
  std::vector<LevelCount> result;
  for (const auto& [level, point] : by_level) result.push_back(point);
  return result;
}

/// Returns the z statistic of a linear trend in the proportion of positive answers along the axis
/// (Cochran-Armitage). Returns 0 if all answers or all levels are the same.
double trend(AxisCounts counts) {
  // For this test, give noise trials a finite level: below the lowest signal, by the range of the signals.
  if (counts.u.front() == kNoise)
    counts.u.front() = counts.lowest() - std::max(counts.u.back() - counts.lowest(), 1.0);
  double n = 0, k = 0, sum_u = 0;
  for (std::size_t i = 0; i < counts.u.size(); ++i) {
    n += counts.trials[i];
    k += counts.positive[i];
    sum_u += counts.trials[i] * counts.u[i];
  }
  double covariance = 0, spread = 0;
  for (std::size_t i = 0; i < counts.u.size(); ++i) {
    const double du = counts.u[i] - sum_u / n;
    covariance += counts.positive[i] * du;
    spread += counts.trials[i] * du * du;
  }
  const double variance = k / n * (1 - k / n) * spread;
  return variance > 0 ? covariance / std::sqrt(variance) : 0;
}

/// Returns the reason why the likelihood has no maximum within the bounds; empty if it has one.
std::optional<Statement> refusal(const std::vector<LevelCount>& data, const FitOptions& options) {
  int trials = 0;
  double positive = 0;
  for (const auto& point : data) {
    trials += point.trials;
    positive += point.sum();
  }
  const auto levels = static_cast<int>(data.size());
  if (levels > 0 && levels < options.minimum_levels)
    return Statement{"too-few-levels",
                     phrase(levels == 1 ? "statement.one_level" : "statement.too_few_levels",
                            {plain(levels), plain(options.minimum_levels)})};
  if (auto reason = unusable(data, options)) return reason;
  if (positive == trials) return Statement{"all-positive", phrase("statement.all_positive")};
  if (positive == 0) return Statement{"none-positive", phrase("statement.none_positive")};
  if (trend(axis_counts(data, options.function, options.scale)) <= 0)
    return Statement{"flat", phrase("statement.flat")};
  return std::nullopt;
}

double deviance(const Likelihood& likelihood, const Theta& theta, const AxisCounts& counts) {
  double saturated = 0;
  for (std::size_t i = 0; i < counts.u.size(); ++i) {
    const double k = counts.positive[i], n = counts.trials[i];
    if (k > 0) saturated -= k * std::log(k / n);
    if (k < n) saturated -= (n - k) * std::log((n - k) / n);
  }
  return std::max(0.0, 2 * (likelihood.negative_log(theta) - saturated));
}

void note_bounds(PsychometricFit& fit, const Theta& theta, const ThetaBounds& bounds) {
  const auto at = [](double value, double bound) { return std::abs(value - bound) < 1e-6; };
  const bool rate_low = at(theta[1], bounds.low[1]), rate_high = at(theta[1], bounds.high[1]);
  // the slope of a normal function is a spread, which falls as the rate rises
  const bool falling = fit.options.function == Function::normal;
  fit.at_bound.slope_low = falling ? rate_high : rate_low;
  fit.at_bound.slope_high = falling ? rate_low : rate_high;
  if (bounds.low[2] < bounds.high[2]) {
    fit.at_bound.lapse_low = at(theta[2], bounds.low[2]);
    fit.at_bound.lapse_high = at(theta[2], bounds.high[2]);
  }
  fit.at_bound.guess = fit.options.guess == Guess::fitted && bounds.low[3] < bounds.high[3] &&
                       (at(theta[3], bounds.low[3]) || at(theta[3], bounds.high[3]));
  if (rate_high) fit.statements.push_back({"step", phrase("statement.step")});
  if (rate_low) fit.statements.push_back({"slope-bound", phrase("statement.shallow")});
  if (fit.at_bound.lapse_high)
    fit.statements.push_back(
        {"lapse-bound", phrase("statement.lapse_bound", {plain(core::number(bounds.high[2]))})});
}

}  // namespace

std::vector<LevelCount> checked(const std::vector<LevelCount>& data, const FitOptions& options) {
  check(data, options);
  return merged(data);
}

std::optional<Statement> unusable(const std::vector<LevelCount>& data, const FitOptions& options) {
  int trials = 0;
  for (const auto& point : data) trials += point.trials;
  if (trials == 0) return Statement{"no-trials", phrase("statement.no_trials")};
  if (trials < options.minimum_trials)
    return Statement{"too-few-trials",
                     phrase("statement.too_few_trials", {plain(trials), plain(options.minimum_trials)})};
  const double z = trend(axis_counts(data, options.function, options.scale));
  if (z < -1.645) return Statement{"reversed", phrase("statement.reversed", {plain(core::number(z, 3))})};
  return std::nullopt;
}

void say_what_touches(PsychometricIntervals& intervals) {
  const auto say = [&intervals](const std::optional<ParameterInterval>& of, const char* code,
                                const char* what) {
    if (!of || !(of->touches_low || of->touches_high)) return;
    const char* end = of->touches_low && of->touches_high ? "statement.both_ends"
                      : of->touches_low                   ? "statement.lower_end"
                                                          : "statement.upper_end";
    intervals.statements.push_back({code, phrase("statement.touches", {phrase(what), phrase(end)})});
  };
  say(intervals.threshold, "interval-threshold", "report.threshold");
  say(intervals.slope, "interval-slope", "report.slope");
  say(intervals.interval_75, "interval-75 % point", "statement.point_of_three_quarters");
}

double weight_of(const std::vector<LevelCount>& data, const FitOptions& options, const Psychometric& fitted) {
  // The rest is smallest for people who admit every guess at levels at which they only guess. An answer that
  // counts more than this often would claim to know the function from a few of them.
  constexpr double least_rest = 0.05;
  double admitted = 0, binomial = 0;
  for (const auto& point : data) {
    const double p = point.level == kNoise
                         ? fitted.guess
                         : probability(options.function, options.scale, fitted, point.level);
    admitted += point.admitted;
    binomial += point.trials * p * (1 - p);
  }
  // The square of 1, 0 or the guess rate has the mean p - P(unsure) guess (1 - guess).
  const double spared = admitted * (1 - options.guess_value);
  return spared > 0 ? 1 / std::max(1 - spared / binomial, least_rest) : 1;
}

AxisCounts axis_counts(const std::vector<LevelCount>& data, Function function, Scale scale, double weight) {
  AxisCounts counts;
  for (const auto& point : data) {
    counts.u.push_back(point.level == kNoise ? kNoise : axis_position(function, scale, point.level));
    counts.trials.push_back(weight * point.trials);
    counts.positive.push_back(weight * point.sum());
  }
  return counts;
}

ThetaBounds theta_bounds(const AxisCounts& counts, const FitOptions& options) {
  const double range = counts.u.back() - counts.lowest();
  const double rate_low = 0.1 / range, rate_high = 80 / range;
  ThetaBounds bounds;
  bounds.low = {counts.lowest() - range, std::log(rate_low), options.lapse_low, options.guess_low};
  bounds.high = {counts.u.back() + range, std::log(rate_high), options.lapse_high, options.guess_high};
  if (options.guess == Guess::fixed) bounds.low[3] = bounds.high[3] = options.guess_value;
  if (options.guess == Guess::tied_to_lapse) {
    bounds.low[3] = bounds.low[2];
    bounds.high[3] = bounds.high[2];
  }
  return bounds;
}

Psychometric from_theta(const Theta& theta, const FitOptions& options) {
  return {level_from_axis(options.function, options.scale, theta[0]),
          slope_from_rate(options.function, std::exp(theta[1])), theta[3], theta[2]};
}

PsychometricFit fit_psychometric(const std::vector<LevelCount>& data, const FitOptions& options) {
  PsychometricFit fit;
  fit.options = options;
  fit.data = checked(data, options);
  if (auto reason = refusal(fit.data, options)) {
    fit.statements.push_back(*reason);
    return fit;
  }
  const auto counts = axis_counts(fit.data, options.function, options.scale);
  const auto bounds = theta_bounds(counts, options);
  const Likelihood likelihood(options.function, options.guess, counts, bounds);
  const auto best = likelihood.search();
  const double range = bounds.high[0] - bounds.low[0];
  if (best.theta[0] < bounds.low[0] + 1e-6 * range || best.theta[0] > bounds.high[0] - 1e-6 * range) {
    fit.statements.push_back({"threshold-outside", phrase("statement.threshold_outside")});
    return fit;
  }
  fit.parameters = from_theta(best.theta, options);
  fit.weight = weight_of(fit.data, options, *fit.parameters);
  fit.negative_log_likelihood = fit.weight * best.negative_log;
  fit.deviance = fit.weight * deviance(likelihood, best.theta, counts);
  for (int i = 0; i < 4; ++i)
    if (bounds.low[i] < bounds.high[i] && !(i == 3 && options.guess == Guess::tied_to_lapse))
      ++fit.free_parameters;
  note_bounds(fit, best.theta, bounds);
  if (best.theta[0] < counts.lowest() || best.theta[0] > counts.u.back())
    fit.statements.push_back({"extrapolated", phrase("statement.extrapolated")});
  return fit;
}

namespace {

/// `positive` says whether an answer was positive; empty if it does not count. Unsure answers count as
/// `admitted`.
template <class Positive>
std::vector<LevelCount> count(const std::vector<TrialRecord>& trials, double admitted, Positive positive) {
  std::vector<LevelCount> result;
  for (const auto& trial : trials) {
    if (!counted(trial) || !trial.level) continue;
    const std::optional<bool> value = positive(trial);
    if (value)
      result.push_back({*trial.level, 1, *value ? 1 : 0});
    else if (trial.unsure && admitted > 0)
      result.push_back({*trial.level, 1, 0, admitted});
  }
  return merged(result);
}

}  // namespace

std::vector<LevelCount> count_correct(const std::vector<TrialRecord>& trials, int alternatives) {
  return count(trials, 1.0 / std::max(alternatives, 2),
               [](const TrialRecord& trial) { return trial.correct; });
}

std::vector<LevelCount> count_choice(const std::vector<TrialRecord>& trials, int positive_choice) {
  return count(trials, 0, [positive_choice](const TrialRecord& trial) -> std::optional<bool> {
    if (!trial.response) return std::nullopt;
    return *trial.response == positive_choice;
  });
}

bool falls(const std::vector<LevelCount>& counts) {
  double n = 0, k = 0, level = 0;
  for (const auto& point : counts) n += point.trials, k += point.sum(), level += point.trials * point.level;
  double covariance = 0;
  for (const auto& point : counts)
    if (n > 0) covariance += (point.sum() - point.trials * k / n) * (point.level - level / n);
  return covariance < 0;
}

}  // namespace turnpoint::analysis

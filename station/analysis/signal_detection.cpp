#include "station/analysis/signal_detection.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>

#include "physics/root.hpp"
#include "station/analysis/proportion.hpp"

namespace turnpoint::analysis {

std::optional<double> log_linear_proportion(int successes, int trials) {
  if (successes < 0 || successes > trials)
    throw std::invalid_argument(std::to_string(successes) + " of " + std::to_string(trials) +
                                ": it must be from 0 to the number of trials");
  if (trials == 0) return std::nullopt;
  return (successes + 0.5) / (trials + 1.0);
}

std::optional<YesNo> yes_no(const YesNoCounts& counts) {
  const auto hit = log_linear_proportion(counts.hits, counts.hits + counts.misses);
  const auto false_alarm =
      log_linear_proportion(counts.false_alarms, counts.false_alarms + counts.correct_rejections);
  if (!hit || !false_alarm) return std::nullopt;
  const double z_hit = normal_quantile(*hit), z_false = normal_quantile(*false_alarm);
  // With symmetric counts z(p) and z(1 - p) cancel except for their round-off, which is no criterion.
  const auto without_round_off = [](double sum) { return std::fabs(sum) < 1e-12 ? 0.0 : sum; };
  return YesNo{without_round_off(z_hit - z_false), without_round_off(-(z_hit + z_false) / 2), *hit,
               *false_alarm};
}

namespace {

YesNoCounts operator+(const YesNoCounts& a, const YesNoCounts& b) {
  return {a.hits + b.hits, a.misses + b.misses, a.false_alarms + b.false_alarms,
          a.correct_rejections + b.correct_rejections};
}

/// Returns the variance of z(p), where p is a proportion of `trials` trials, with the log-linear correction.
double variance_of_z(double p, int trials) {
  const double density = normal_density(normal_quantile(p));
  return p * (1 - p) / (trials + 1) / (density * density);
}

void estimate(Detection& detection, double scale) {
  const auto& counts = detection.counts;
  const auto found = yes_no(counts);
  if (!found) return;
  const double variance =
      variance_of_z(found->hit_rate, counts.hits + counts.misses) +
      variance_of_z(found->false_alarm_rate, counts.false_alarms + counts.correct_rejections);
  const auto around = [](double value, double half) {
    return Estimate{value, {value - half, value + half, 0.95}};
  };
  detection.d_prime = around(scale * found->d_prime, kZ95 * scale * std::sqrt(variance));
  detection.criterion = around(found->criterion, kZ95 * std::sqrt(variance) / 2);
}

struct Collected {
  YesNoCounts noise;  ///< counts of the noise trials, summed over all levels
  std::map<double, YesNoCounts> levels;
};

void collect(const TrialRecord& trial, Detecting detecting, int positive, Collected& into) {
  const bool signal = *trial.right_choice == positive, yes = *trial.response == positive;
  const bool shared = detecting == Detecting::presence && !signal;
  const double level =
      detecting == Detecting::forced_choice ? trial.level.value_or(0) : std::fabs(trial.level.value_or(0));
  auto& counts = shared ? into.noise : into.levels[level];
  ++(signal ? (yes ? counts.hits : counts.misses) : (yes ? counts.false_alarms : counts.correct_rejections));
}

}  // namespace

std::vector<Detection> detect(const std::vector<TrialRecord>& trials, const std::vector<std::string>& order,
                              Detecting detecting, int positive, std::size_t most_levels) {
  std::map<std::string, Collected> conditions;
  for (const auto& trial : trials)
    if (counted(trial) && trial.response && trial.right_choice)
      collect(trial, detecting, positive, conditions[trial.instruction]);
  const double scale = detecting == Detecting::forced_choice ? 1 / std::numbers::sqrt2 : 1;
  std::vector<Detection> result;
  for (const auto& condition : conditions_of(trials, order)) {
    const auto& collected = conditions[condition];
    Detection all{condition, std::nullopt, collected.noise, {}, {}};
    for (const auto& [level, counts] : collected.levels) {
      all.counts = all.counts + counts;
      if (collected.levels.size() > most_levels) continue;
      result.push_back({condition, level, counts + collected.noise, {}, {}});
    }
    result.push_back(all);
  }
  for (auto& detection : result) estimate(detection, scale);
  return result;
}

namespace {

/// Method 5 of Newcombe (2006): the areas from which the observed one differs by at most 1.96 standard
/// deviations, with the variance of Hanley & McNeil (1982) at each of these areas, for the mean of both
/// numbers of trials.
Interval area_interval(double area, double noise, double signal) {
  const double each = (noise + signal) / 2;
  const auto contains = [&](double at) {
    const double variance = at * (1 - at) *
                            (1 + (each - 1) * (1 - at) / (2 - at) + (each - 1) * at / (1 + at)) /
                            (noise * signal);
    return (at - area) * (at - area) <= kZ95 * kZ95 * variance;
  };
  return {physics::bisect({area, 0}, contains).middle(), physics::bisect({area, 1}, contains).middle(), 0.95};
}

}  // namespace

std::optional<Roc> roc(const std::vector<int>& noise, const std::vector<int>& signal) {
  const auto negative = [](int count) { return count < 0; };
  if (noise.size() < 2 || noise.size() != signal.size() ||
      std::any_of(noise.begin(), noise.end(), negative) ||
      std::any_of(signal.begin(), signal.end(), negative))
    throw std::invalid_argument(
        "ROC: there must be two or more ratings, the same number for noise and signal, and no negative "
        "counts");
  const double n = std::accumulate(noise.begin(), noise.end(), 0),
               s = std::accumulate(signal.begin(), signal.end(), 0);
  if (n == 0 || s == 0) return std::nullopt;
  Roc result;
  result.points.push_back({0, 0});
  double area = 0;
  for (std::size_t i = noise.size(); i-- > 0;) {
    const auto last = result.points.back();
    result.points.push_back({last.false_alarms + noise[i] / n, last.hits + signal[i] / s});
    area +=
        (result.points.back().false_alarms - last.false_alarms) * (result.points.back().hits + last.hits) / 2;
  }
  result.area = {area, area_interval(area, n, s)};
  return result;
}

namespace {

/// A trial with a rating: its number from the surest "no", and whether there was a signal.
struct Rated {
  int rating = 0;
  bool signal = false;
};

/// Computes the curves of the trials for which `rated` returns a rating below `ratings`.
template <typename Function>
std::vector<RatedDetection> curves_of(const std::vector<TrialRecord>& trials,
                                      const std::vector<std::string>& order, int ratings,
                                      std::size_t most_levels, const Function& rated) {
  const std::vector<int> none(static_cast<std::size_t>(ratings));
  std::vector<RatedDetection> result;
  const auto add = [&](RatedDetection entry) {
    const auto curve = ratings < 2 ? std::nullopt : roc(entry.noise, entry.signal);
    if (!curve) return;
    entry.roc = *curve;
    entry.equal = fit_ratings(entry.noise, entry.signal, Variances::equal);
    entry.unequal = fit_ratings(entry.noise, entry.signal, Variances::unequal);
    result.push_back(std::move(entry));
  };
  for (const auto& condition : conditions_of(trials, order)) {
    RatedDetection all{condition, std::nullopt, none, none, {}, {}, {}};
    std::map<double, std::vector<int>> levels;
    for (const auto& trial : trials) {
      if (!counted(trial) || !trial.response || trial.instruction != condition) continue;
      const std::optional<Rated> found = rated(trial);
      if (!found) continue;
      const auto at = static_cast<std::size_t>(found->rating);
      ++(found->signal ? all.signal : all.noise)[at];
      if (found->signal) ++levels.try_emplace(std::fabs(trial.level.value_or(0)), none).first->second[at];
    }
    if (levels.size() <= most_levels)
      for (const auto& [level, signal] : levels) add({condition, level, all.noise, signal, {}, {}, {}});
    add(all);
  }
  return result;
}

}  // namespace

std::vector<RatedDetection> rocs(const std::vector<TrialRecord>& trials,
                                 const std::vector<std::string>& order, int positive,
                                 std::size_t most_levels) {
  int degrees = 0;
  for (const auto& trial : trials)
    if (counted(trial) && trial.right_choice) degrees = std::max(degrees, trial.confidence.value_or(0));
  return curves_of(trials, order, 2 * degrees, most_levels, [&](const TrialRecord& trial) {
    if (!trial.right_choice || !trial.confidence) return std::optional<Rated>();
    const int rating =
        *trial.response == positive ? degrees + *trial.confidence - 1 : degrees - *trial.confidence;
    return std::optional(Rated{rating, *trial.right_choice == positive});
  });
}

std::vector<RatedDetection> rating_rocs(const std::vector<TrialRecord>& trials,
                                        const std::vector<std::string>& order, int points,
                                        std::size_t most_levels) {
  return curves_of(trials, order, points, most_levels, [&](const TrialRecord& trial) {
    const bool known = trial.present && *trial.response < points;
    return known ? std::optional(Rated{*trial.response, *trial.present}) : std::nullopt;
  });
}

}  // namespace turnpoint::analysis

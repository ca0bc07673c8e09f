#include "station/analysis/forced_choice.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>

#include "station/analysis/proportion.hpp"
#include "station/analysis/signal_detection.hpp"
#include "station/core/number.hpp"

namespace turnpoint::analysis {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLargest = 40;  // largest d' of the search; proportions there are 0 or 1 to the last digit

/// Returns the probability that the observation with the signal is the largest of m = `intervals`
/// observations: the integral over x of phi(x - d') Phi(x)^(m - 1), with the normal density phi and
/// distribution function Phi. The trapezoidal rule has an error below 1e-15 for such a smooth function that
/// vanishes at both ends.
double largest_of(double d_prime, int intervals) {
  constexpr double step = 0.125;
  double sum = 0;
  for (int i = -80; i <= 80; ++i)
    sum += normal_density(step * i) * std::pow(normal_cdf(d_prime + step * i), intervals - 1);
  return step * sum;
}

/// Returns the probability that two independent decisions are either both right or both wrong.
double both_or_neither(double first, double second) {
  return normal_cdf(first) * normal_cdf(second) + normal_cdf(-first) * normal_cdf(-second);
}

}  // namespace

const char* name(Deciding deciding) {
  switch (deciding) {
    case Deciding::largest:
      return "largest of m";
    case Deciding::independent:
      return "independent observations";
    case Deciding::differencing:
      break;
  }
  return "differencing";
}

double proportion_correct(Deciding deciding, double d_prime, int intervals) {
  switch (deciding) {
    case Deciding::largest:
      return largest_of(d_prime, intervals);
    case Deciding::independent:
      return both_or_neither(d_prime / std::numbers::sqrt2, d_prime / 2);
    case Deciding::differencing:
      break;
  }
  return both_or_neither(d_prime / std::numbers::sqrt2, d_prime / std::sqrt(6.0));
}

double d_prime(Deciding deciding, double proportion, int intervals) {
  if (!(proportion >= 0 && proportion <= 1))
    throw std::invalid_argument("proportion correct " + core::number(proportion) + ": from 0 to 1");
  if (deciding != Deciding::largest && proportion <= 0.5) return 0;
  if (proportion == 0) return -kInfinity;
  if (proportion == 1) return kInfinity;
  double low = deciding == Deciding::largest ? -kLargest : 0, high = kLargest;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (proportion_correct(deciding, middle, intervals) < proportion ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

namespace {

Discrimination discrimination(const std::string& condition, const std::optional<double>& level,
                              const std::pair<int, int>& right_of, const std::vector<Deciding>& models,
                              int intervals) {
  const auto [right, trials] = right_of;
  Discrimination result{condition, level, proportion(right, trials), {}};
  const auto& ends = result.right.interval;
  for (const auto model : models) {
    const auto at = [&](double share) { return d_prime(model, share, intervals); };
    result.d_primes.push_back(
        {model, {at(*log_linear_proportion(right, trials)), {at(ends.low), at(ends.high), 0.95}}});
  }
  return result;
}

}  // namespace

std::vector<Discrimination> discriminate(const std::vector<TrialRecord>& trials,
                                         const std::vector<std::string>& order,
                                         const std::vector<Deciding>& models, int intervals,
                                         std::size_t most_levels) {
  std::vector<Discrimination> result;
  for (const auto& condition : conditions_of(trials, order)) {
    std::map<double, std::pair<int, int>> levels;  // for each level: right answers, all trials
    std::pair<int, int> all;
    for (const auto& trial : trials) {
      if (!counted(trial) || !trial.correct || trial.instruction != condition) continue;
      for (auto* counts : {&levels[trial.level.value_or(0)], &all})
        counts->first += *trial.correct, ++counts->second;
    }
    if (all.second == 0) continue;
    if (levels.size() <= most_levels)
      for (const auto& [level, counts] : levels)
        result.push_back(discrimination(condition, level, counts, models, intervals));
    result.push_back(discrimination(condition, std::nullopt, all, models, intervals));
  }
  return result;
}

}  // namespace turnpoint::analysis

#include "station/analysis/response_signal.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "station/analysis/proportion.hpp"

namespace turnpoint::analysis {

namespace {

constexpr int kAsymptotes = 120, kRates = 60, kIntercepts = 72;
constexpr std::size_t kFewestLags = 3;
constexpr double kHighestAsymptote = 8, kLowestRate = 0.3, kHighestRate = 40;
// The priors keep the estimates of few trials from running away: with 56 trials at each of six lags, a flat
// prior gave a median asymptote of 3.1 for 2.5, and maximum likelihood 2.7.
constexpr double kAsymptoteSd = 1.8, kRateMiddle = 3, kRateSd = 1.5;
/// An interval holds the values whose best curve is less than this below the best of all, in nats. Half of
/// the 95 % quantile of chi squared is 1.92; with few trials that holds the truth a little too rarely.
constexpr double kDrop = 2.1;

double log_cdf(double z) { return std::log(std::max(normal_cdf(z), 1e-300)); }

/// Returns the log likelihood of the answers at one lag if the two stimuli are `distance` apart. The
/// criterion takes the value at which the likelihood is highest.
template <class Counts>
double log_likelihood(const Counts& n, double distance) {
  const auto at = [&](double c) {
    return n.hits * log_cdf(distance / 2 - c) + n.misses * log_cdf(c - distance / 2) +
           n.false_alarms * log_cdf(-distance / 2 - c) + n.correct_rejections * log_cdf(distance / 2 + c);
  };
  // As a function of the criterion, the log likelihood is concave, so a ternary search finds its maximum.
  double low = -5, high = 5;
  for (int i = 0; i < 40; ++i) {
    const double left = low + (high - low) / 3, right = high - (high - low) / 3;
    (at(left) < at(right) ? low : high) = at(left) < at(right) ? left : right;
  }
  return at(0.5 * (low + high));
}

/// A table of the log likelihood of the answers at one lag, over the sensitivity d'.
class LagLikelihood {
 public:
  template <class Counts>
  LagLikelihood(const Counts& counts, double scale) {
    for (int i = 0; i <= kSteps; ++i) values_.push_back(log_likelihood(counts, scale * i * kStep));
  }
  double at(double d_prime) const {
    const double x = std::min(d_prime / kStep, kSteps - 1e-9);
    const auto i = static_cast<std::size_t>(x);
    const double part = x - static_cast<double>(i);
    return (1 - part) * values_[i] + part * values_[i + 1];
  }
  /// The same by a parabola through the three nearest entries.
  double smooth_at(double d_prime) const {
    const double x = std::clamp(d_prime / kStep, 0.0, static_cast<double>(kSteps));
    const auto i = static_cast<std::size_t>(std::clamp(std::round(x), 1.0, kSteps - 1.0));
    const double part = x - static_cast<double>(i);
    return values_[i] + 0.5 * part * (values_[i + 1] - values_[i - 1]) +
           0.5 * part * part * (values_[i + 1] - 2 * values_[i] + values_[i - 1]);
  }

 private:
  static constexpr int kSteps = 320;
  static constexpr double kStep = 0.025;
  std::vector<double> values_;
};

/// Values of one parameter in equal steps, and for each of them the height of the best curve that has it.
struct Profile {
  double low = 0, high = 0;
  std::vector<double> height;

  Profile(double from, double to, int count)
      : low(from), high(to), height(static_cast<std::size_t>(count), -INFINITY) {}
  double at(double index) const {
    return low + (high - low) * (index + 0.5) / static_cast<double>(height.size());
  }
  void raise(std::size_t index, double value) { height[index] = std::max(height[index], value); }
};

enum class LowEnd { open, zero };

/// The highest point of a profile and its interval. A low end beyond the range is 0 if the parameter cannot
/// be lower, and else not determined.
std::optional<Estimate> estimate_of(const Profile& profile, LowEnd low_end) {
  const auto& y = profile.height;
  const auto best = static_cast<std::size_t>(std::max_element(y.begin(), y.end()) - y.begin());
  double place = static_cast<double>(best), top = y[best];
  if (best > 0 && best + 1 < y.size()) {  // the vertex of the parabola through three points
    const double slope = 0.5 * (y[best + 1] - y[best - 1]), bend = y[best + 1] - 2 * y[best] + y[best - 1];
    if (bend < 0) place -= slope / bend, top -= slope * slope / (2 * bend);
  }
  const double limit = top - kDrop;
  const auto crossing = [&](std::size_t outside, std::size_t inside) {
    const double part = (limit - y[outside]) / (y[inside] - y[outside]);
    return profile.at(static_cast<double>(outside) +
                      part * (static_cast<double>(inside) - static_cast<double>(outside)));
  };
  std::size_t first = 0, last = y.size() - 1;
  while (y[first] < limit) ++first;
  while (y[last] < limit) --last;
  const double low = first > 0 ? crossing(first - 1, first) : low_end == LowEnd::zero ? 0 : -INFINITY;
  const double high = last + 1 < y.size() ? crossing(last + 1, last) : INFINITY;
  if (first == 0 && std::isinf(high)) return std::nullopt;
  return Estimate{profile.at(place), {low, high, 0.95}};
}

std::optional<Estimate> exponential(std::optional<Estimate> logarithm) {
  if (!logarithm) return logarithm;
  const auto& interval = logarithm->interval;
  return Estimate{std::exp(logarithm->value),
                  {std::isinf(interval.low) ? -INFINITY : std::exp(interval.low), std::exp(interval.high),
                   interval.confidence}};
}

/// `longest_s`: the highest intercept.
void fit(SpeedAccuracyCurve& curve, double scale, double longest_s) {
  std::vector<LagLikelihood> likelihoods;
  for (const auto& point : curve.points) likelihoods.emplace_back(point.counts, scale);
  Profile asymptotes(0, kHighestAsymptote, kAsymptotes),
      rates(std::log(kLowestRate), std::log(kHighestRate), kRates), intercepts(0, longest_s, kIntercepts);
  std::vector<double> reached(likelihoods.size());
  for (std::size_t r = 0; r < rates.height.size(); ++r) {
    const double log_rate = rates.at(static_cast<double>(r)), rate = std::exp(log_rate);
    const double of_rate = (log_rate - std::log(kRateMiddle)) / kRateSd;
    for (std::size_t i = 0; i < intercepts.height.size(); ++i) {
      for (std::size_t k = 0; k < reached.size(); ++k)
        reached[k] = d_prime_at(1, rate, intercepts.at(static_cast<double>(i)), curve.points[k].time_s);
      for (std::size_t a = 0; a < asymptotes.height.size(); ++a) {
        const double asymptote = asymptotes.at(static_cast<double>(a)),
                     of_asymptote = asymptote / kAsymptoteSd;
        double sum = -0.5 * (of_rate * of_rate + of_asymptote * of_asymptote);
        for (std::size_t k = 0; k < reached.size(); ++k) sum += likelihoods[k].at(asymptote * reached[k]);
        asymptotes.raise(a, sum), rates.raise(r, sum), intercepts.raise(i, sum);
      }
    }
  }
  curve.profiles = {asymptotes.height, rates.height, intercepts.height};
  for (std::size_t i = 0; i < asymptotes.height.size(); ++i)
    curve.profiles[0][i] += 0.5 * std::pow(asymptotes.at(static_cast<double>(i)) / kAsymptoteSd, 2);
  for (std::size_t i = 0; i < rates.height.size(); ++i)
    curve.profiles[1][i] +=
        0.5 * std::pow((rates.at(static_cast<double>(i)) - std::log(kRateMiddle)) / kRateSd, 2);
  curve.asymptote = estimate_of(asymptotes, LowEnd::zero);
  curve.rate_per_s = exponential(estimate_of(rates, LowEnd::open));
  curve.intercept_s = estimate_of(intercepts, LowEnd::zero);
}

SpeedAccuracyCurve curve_of(const std::string& condition,
                            const std::map<double, std::vector<TrialRecord>>& lags, Detecting detecting,
                            int positive) {
  SpeedAccuracyCurve curve;
  curve.condition = condition;
  for (const auto& [lag_s, at_lag] : lags) {
    LagPoint point;
    point.lag_s = lag_s;
    for (const auto& trial : at_lag) {
      point.time_s += *trial.response_time_s / static_cast<double>(at_lag.size());
      auto& n = point.counts;
      const bool yes = *trial.response == positive;
      ++(*trial.right_choice == positive ? yes ? n.hits : n.misses
         : yes                           ? n.false_alarms
                                         : n.correct_rejections);
    }
    auto levels = detect(at_lag, {}, detecting, positive);
    point.d_prime = levels.back().d_prime;
    levels.pop_back();
    curve.points.push_back(point);
    curve.by_level.push_back(std::move(levels));
  }
  if (std::all_of(curve.by_level.begin(), curve.by_level.end(),
                  [](const auto& levels) { return levels.size() < 2; }))
    curve.by_level.clear();
  if (curve.points.size() < kFewestLags)
    curve.statements.push_back({"lags-too-few", core::phrase("statement.lags_too_few")});
  return curve;
}

/// Says which parameters the answers do not determine.
void name_missing(SpeedAccuracyCurve& curve) {
  core::Phrase missing;
  const auto name = [&missing](const auto& estimate, const char* what) {
    if (estimate) return;
    if (!missing.values.empty()) missing.values.push_back(core::plain(", "));
    missing.values.push_back(core::phrase(what));
  };
  name(curve.asymptote, "statement.asymptote");
  name(curve.rate_per_s, "statement.rate");
  name(curve.intercept_s, "statement.intercept");
  if (!missing.values.empty())
    curve.statements.push_back(
        {"curve-undetermined", core::phrase("statement.curve_undetermined", {missing})});
}

/// The p value of the model in which both curves share this parameter.
std::optional<double> p_of_shared(const SpeedAccuracyCurve& a, const SpeedAccuracyCurve& b,
                                  std::size_t parameter) {
  const auto &first = a.profiles[parameter], &second = b.profiles[parameter];
  if (first.empty() || second.empty()) return std::nullopt;
  double shared = -INFINITY;
  for (std::size_t i = 0; i < first.size(); ++i) shared = std::max(shared, first[i] + second[i]);
  const double own = *std::max_element(first.begin(), first.end()) +
                     *std::max_element(second.begin(), second.end());
  return std::erfc(std::sqrt(std::max(own - shared, 0.0)));  // chi squared with 1 df of 2 (own - shared)
}

}  // namespace

double d_prime_at(double asymptote, double rate_per_s, double intercept_s, double time_s) {
  return time_s > intercept_s ? -asymptote * std::expm1(-rate_per_s * (time_s - intercept_s)) : 0;
}

std::vector<SpeedAccuracyCurve> response_signal(const std::vector<TrialRecord>& trials,
                                                const std::vector<std::string>& order, Detecting detecting,
                                                int positive) {
  std::map<std::string, std::map<double, std::vector<TrialRecord>>> conditions;
  for (const auto& trial : trials)
    if (counted(trial) && trial.signal_s && trial.right_choice && trial.response && trial.response_time_s)
      conditions[trial.instruction][*trial.signal_s].push_back(trial);
  std::vector<SpeedAccuracyCurve> curves;
  for (const auto& condition : conditions_of(trials, order))
    if (conditions.count(condition))
      curves.push_back(curve_of(condition, conditions[condition], detecting, positive));
  // one range of intercepts for all conditions, so that their curves can be compared
  double longest_s = 0;
  for (const auto& curve : curves)
    for (const auto& point : curve.points) longest_s = std::max(longest_s, point.time_s);
  for (auto& curve : curves)
    if (curve.points.size() >= kFewestLags) {
      fit(curve, detecting == Detecting::forced_choice ? std::numbers::sqrt2 : 1, longest_s);
      name_missing(curve);
    }
  return curves;
}

std::optional<std::array<double, 3>> limiting_curve(const std::vector<ExpectedLag>& lags,
                                                    Detecting detecting) {
  if (lags.size() < kFewestLags) return std::nullopt;
  struct Counts {
    double hits, misses, false_alarms, correct_rejections;
  };
  std::vector<LagLikelihood> likelihoods;
  double longest_s = 0;
  for (const auto& lag : lags) {
    likelihoods.emplace_back(Counts{lag.signals * lag.yes_with, lag.signals * (1 - lag.yes_with),
                                    lag.noises * lag.yes_without, lag.noises * (1 - lag.yes_without)},
                             detecting == Detecting::forced_choice ? std::numbers::sqrt2 : 1);
    longest_s = std::max(longest_s, lag.time_s);
  }
  // asymptote, logarithm of the rate, intercept
  const auto height = [&](const std::array<double, 3>& at) -> double {
    if (at[0] < 0 || at[0] > kHighestAsymptote || at[1] < std::log(kLowestRate) ||
        at[1] > std::log(kHighestRate) || at[2] < 0 || at[2] > longest_s)
      return -INFINITY;
    double sum = 0;
    for (std::size_t k = 0; k < lags.size(); ++k)
      sum += likelihoods[k].smooth_at(d_prime_at(at[0], std::exp(at[1]), at[2], lags[k].time_s));
    return sum;
  };
  std::array<double, 3> at{2, std::log(kRateMiddle), 0.5 * lags.front().time_s}, step{0.5, 0.5, 0.1};
  double top = height(at);
  for (int round = 0; round < 200000 && step[0] > 1e-6; ++round) {
    bool better = false;
    std::array<double, 3> next = at;
    for (std::size_t k = 0; k < 3; ++k)
      for (const double side : {step[k], -step[k]}) {
        next[k] += side;
        if (const double there = height(next); there > top) {
          top = there, better = true;
          break;
        }
        next[k] -= side;
      }
    if (!better) {
      for (auto& one : step) one /= 2;
      continue;
    }
    // go on in the direction in which all three moved (Hooke & Jeeves 1961)
    std::array<double, 3> further{};
    for (std::size_t k = 0; k < 3; ++k) further[k] = 2 * next[k] - at[k];
    at = next;
    if (const double there = height(further); there > top) top = there, at = further;
  }
  return std::array{at[0], std::exp(at[1]), at[2]};
}

std::vector<CurveDifference> curve_differences(const std::vector<SpeedAccuracyCurve>& curves) {
  const auto of = [](const std::optional<Estimate>& a, const std::optional<Estimate>& b) {
    return a && b ? std::optional(difference_of(*a, *b)) : std::nullopt;
  };
  const auto logarithm = [](std::optional<Estimate> rate) {
    if (rate)
      rate = Estimate{std::log(rate->value),
                      {rate->interval.low > 0 ? std::log(rate->interval.low) : -INFINITY,
                       std::log(rate->interval.high), rate->interval.confidence}};
    return rate;
  };
  std::vector<CurveDifference> all;
  for (std::size_t i = 0; i < curves.size(); ++i)
    for (std::size_t j = i + 1; j < curves.size(); ++j) {
      const auto &a = curves[i], &b = curves[j];
      all.push_back({a.condition, b.condition, of(a.asymptote, b.asymptote), of(a.intercept_s, b.intercept_s),
                     exponential(of(logarithm(a.rate_per_s), logarithm(b.rate_per_s))),
                     {p_of_shared(a, b, 0), p_of_shared(a, b, 1), p_of_shared(a, b, 2)}});
    }
  return all;
}

}  // namespace turnpoint::analysis

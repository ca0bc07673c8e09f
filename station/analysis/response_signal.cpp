#include "station/analysis/response_signal.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "station/analysis/marginal.hpp"
#include "station/analysis/proportion.hpp"

namespace turnpoint::analysis {

namespace {

constexpr Cells kAsymptotes{0, 6, 90};
constexpr int kRates = 60, kIntercepts = 60;
constexpr double kLowest_rate = 0.3, kHighest_rate = 40;
/// A parameter is not reported if its interval covers more than this share of its prior.
constexpr double kWidest = 0.8;

double log_cdf(double z) { return std::log(std::max(normal_cdf(z), 1e-300)); }

/// Returns the log likelihood of the answers at one lag if the two stimuli are `distance` apart. The
/// criterion takes the value at which the likelihood is highest.
double log_likelihood(const YesNoCounts& n, double distance) {
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
  LagLikelihood(const YesNoCounts& counts, double scale) {
    for (int i = 0; i <= kSteps; ++i) values_.push_back(log_likelihood(counts, scale * i * kStep));
  }
  double at(double d_prime) const {
    const double x = std::min(d_prime / kStep, kSteps - 1e-9);
    const auto i = static_cast<std::size_t>(x);
    const double part = x - static_cast<double>(i);
    return (1 - part) * values_[i] + part * values_[i + 1];
  }

 private:
  static constexpr int kSteps = 240;
  static constexpr double kStep = 0.025;
  std::vector<double> values_;
};

std::optional<Estimate> estimate_of(const Marginal& marginal, bool logarithm) {
  const auto of = [&](double p) { return marginal.quantile(p); };
  const double low = of(0.025), high = of(0.975);
  if (high - low > kWidest * (marginal.cells().high - marginal.cells().low)) return std::nullopt;
  const auto back = [&](double value) { return logarithm ? std::exp(value) : value; };
  return Estimate{back(of(0.5)), {back(low), back(high), 0.95}};
}

void fit(SpeedAccuracyCurve& curve, double scale) {
  std::vector<LagLikelihood> likelihoods;
  double longest_s = 0;
  for (const auto& point : curve.points) {
    likelihoods.emplace_back(point.counts, scale);
    longest_s = std::max(longest_s, point.time_s);
  }
  const Cells rates{std::log(kLowest_rate), std::log(kHighest_rate), kRates},
      intercepts{0, longest_s, kIntercepts};
  std::vector<double> cells;
  cells.reserve(static_cast<std::size_t>(kAsymptotes.count * kRates * kIntercepts));
  for (int a = 0; a < kAsymptotes.count; ++a)
    for (int r = 0; r < kRates; ++r)
      for (int i = 0; i < kIntercepts; ++i) {
        double sum = 0;
        for (std::size_t k = 0; k < likelihoods.size(); ++k)
          sum += likelihoods[k].at(d_prime_at(kAsymptotes.centre(a), std::exp(rates.centre(r)),
                                              intercepts.centre(i), curve.points[k].time_s));
        cells.push_back(sum);
      }
  const double most = *std::max_element(cells.begin(), cells.end());
  std::vector<double> of_asymptote(static_cast<std::size_t>(kAsymptotes.count)), of_rate(kRates),
      of_intercept(kIntercepts);
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    const double mass = std::exp(cells[cell] - most);
    of_asymptote[cell / (kRates * kIntercepts)] += mass;
    of_rate[cell / kIntercepts % kRates] += mass;
    of_intercept[cell % kIntercepts] += mass;
  }
  curve.asymptote = estimate_of(Marginal(kAsymptotes, of_asymptote), false);
  curve.rate_per_s = estimate_of(Marginal(rates, of_rate), true);
  curve.intercept_s = estimate_of(Marginal(intercepts, of_intercept), false);
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
    point.d_prime = detect(at_lag, {}, detecting, positive, 0).front().d_prime;
    curve.points.push_back(point);
  }
  if (curve.points.size() < 3) {
    curve.statements.push_back({"lags-too-few", texts::phrase("statement.lags_too_few")});
    return curve;
  }
  fit(curve, detecting == Detecting::forced_choice ? std::numbers::sqrt2 : 1);
  texts::Phrase missing;
  const auto name = [&missing](const auto& estimate, const char* what) {
    if (estimate) return;
    if (!missing.values.empty()) missing.values.push_back(texts::plain(", "));
    missing.values.push_back(texts::phrase(what));
  };
  name(curve.asymptote, "statement.asymptote");
  name(curve.rate_per_s, "statement.rate");
  name(curve.intercept_s, "statement.intercept");
  if (!missing.values.empty())
    curve.statements.push_back(
        {"curve-undetermined", texts::phrase("statement.curve_undetermined", {missing})});
  return curve;
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
    if (trial.type == TrialType::experimental && trial.outcome == Outcome::answered && trial.signal_s &&
        trial.right_choice && trial.response && trial.response_time_s)
      conditions[trial.instruction][*trial.signal_s].push_back(trial);
  std::vector<SpeedAccuracyCurve> curves;
  for (const auto& condition : conditions_of(trials, order))
    if (conditions.count(condition))
      curves.push_back(curve_of(condition, conditions[condition], detecting, positive));
  return curves;
}

}  // namespace turnpoint::analysis

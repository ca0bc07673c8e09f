#include "station/analysis/signal_detection.hpp"

#include <numbers>
#include <stdexcept>
#include <string>

#include "station/analysis/proportion.hpp"

namespace turnpoint::analysis {

namespace {

std::optional<double> scaled_z(double p, double factor) {
  if (!(p >= 0 && p <= 1))
    throw std::invalid_argument("proportion correct " + std::to_string(p) + ": from 0 to 1");
  if (p == 0 || p == 1) return std::nullopt;
  return factor * normal_quantile(p);
}

}  // namespace

std::optional<double> d_prime_forced_choice(double proportion_correct) {
  return scaled_z(proportion_correct, std::numbers::sqrt2);
}

std::optional<double> d_prime_single_interval_unbiased(double proportion_correct) {
  return scaled_z(proportion_correct, 2);
}

std::optional<double> log_linear_proportion(int successes, int trials) {
  if (successes < 0 || successes > trials)
    throw std::invalid_argument(std::to_string(successes) + " of " + std::to_string(trials) +
                                ": from 0 to the number of trials");
  if (trials == 0) return std::nullopt;
  return (successes + 0.5) / (trials + 1.0);
}

std::optional<YesNo> yes_no(const YesNoCounts& counts) {
  const auto hit = log_linear_proportion(counts.hits, counts.hits + counts.misses);
  const auto false_alarm =
      log_linear_proportion(counts.false_alarms, counts.false_alarms + counts.correct_rejections);
  if (!hit || !false_alarm) return std::nullopt;
  const double z_hit = normal_quantile(*hit), z_false = normal_quantile(*false_alarm);
  return YesNo{z_hit - z_false, -(z_hit + z_false) / 2, *hit, *false_alarm};
}

}  // namespace turnpoint::analysis

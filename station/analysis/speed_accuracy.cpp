#include "station/analysis/speed_accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "station/analysis/quantile.hpp"

namespace turnpoint::analysis {

namespace {

double absolute_deviation(const std::vector<double>& times_s, double median) {
  std::vector<double> deviations;
  for (const double time : times_s) deviations.push_back(std::abs(time - median));
  return quantile(std::move(deviations), 0.5);
}

}  // namespace

double lisas(double mean_correct_s, double proportion_error, double sd_time_s, double sd_error) {
  if (!(sd_error >= 0) || !(sd_time_s >= 0) || !(proportion_error >= 0 && proportion_error <= 1))
    throw std::invalid_argument(
        "LISAS: standard deviations must not be negative, and proportions of errors must be from 0 to 1");
  return sd_error == 0 ? mean_correct_s : mean_correct_s + proportion_error * sd_time_s / sd_error;
}

std::optional<double> inverse_efficiency(double mean_correct_s, double proportion_correct) {
  if (!(proportion_correct > 0)) return std::nullopt;
  return mean_correct_s / proportion_correct;
}

std::optional<std::vector<double>> balanced_integration(const std::vector<double>& proportion_correct,
                                                        const std::vector<double>& mean_correct_s) {
  if (proportion_correct.size() != mean_correct_s.size())
    throw std::invalid_argument("balanced integration: there must be as many times as proportions");
  if (proportion_correct.size() < 3) return std::nullopt;
  const double n = static_cast<double>(proportion_correct.size()), divisor_n = (n - 1) / n;
  const double sd_accuracy = std::sqrt(divisor_n * variance(proportion_correct));
  const double sd_time = std::sqrt(divisor_n * variance(mean_correct_s));
  if (!(sd_accuracy > 1e-12) || !(sd_time > 1e-12)) return std::nullopt;
  const double accuracy = mean(proportion_correct), time = mean(mean_correct_s);
  std::vector<double> scores;
  for (std::size_t i = 0; i < proportion_correct.size(); ++i)
    scores.push_back((proportion_correct[i] - accuracy) / sd_accuracy - (mean_correct_s[i] - time) / sd_time);
  return scores;
}

std::vector<CafBin> conditional_accuracy(const std::vector<double>& times_s, const std::vector<bool>& correct,
                                         int bins) {
  if (bins < 4 || bins > 6 || times_s.size() != correct.size())
    throw std::invalid_argument(
        "conditional accuracy function: there must be 4 to 6 bins, and as many scores as times");
  const std::size_t n = times_s.size(), wanted = static_cast<std::size_t>(bins);
  if (n < 5 * wanted) return {};
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return times_s[a] < times_s[b]; });
  std::vector<CafBin> result;
  for (std::size_t bin = 0; bin < wanted; ++bin) {
    const std::size_t first = bin * n / wanted, last = (bin + 1) * n / wanted;
    CafBin entry;
    entry.low_s = times_s[order[first]];
    entry.high_s = times_s[order[last - 1]];
    for (std::size_t i = first; i < last; ++i) {
      entry.mean_time_s += times_s[order[i]] / static_cast<double>(last - first);
      entry.correct += correct[order[i]] ? 1 : 0;
    }
    entry.trials = static_cast<int>(last - first);
    result.push_back(entry);
  }
  return result;
}

std::optional<ResponseTimes> describe_times(const std::vector<double>& times_s) {
  if (times_s.empty()) return std::nullopt;
  ResponseTimes result;
  auto sorted = times_s;
  std::sort(sorted.begin(), sorted.end());
  result.count = static_cast<int>(sorted.size());
  result.mean_s = mean(sorted);
  result.sd_s = sorted.size() > 1 ? std::sqrt(variance(sorted)) : 0;
  result.median_s = sorted_quantile(sorted, 0.5);
  result.mad_s = absolute_deviation(sorted, result.median_s);
  for (int i = 1; i < 10; ++i) result.deciles_s.push_back(sorted_quantile(sorted, i / 10.0));
  return result;
}

std::vector<bool> keep_times(const std::vector<double>& times_s, const TimeExclusion& rule) {
  std::vector<double> late_enough;
  for (const double time : times_s)
    if (time >= rule.below_s) late_enough.push_back(time);
  double low = rule.below_s, high = INFINITY;
  if (rule.mad && !late_enough.empty()) {
    const double median = quantile(late_enough, 0.5);
    const double reach = *rule.mad * 1.4826 * absolute_deviation(late_enough, median);
    if (reach > 0) {
      low = std::max(low, median - reach);
      high = median + reach;
    }
  }
  std::vector<bool> kept;
  for (const double time : times_s) kept.push_back(time >= low && time <= high);
  return kept;
}

}  // namespace turnpoint::analysis

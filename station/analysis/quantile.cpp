#include "station/analysis/quantile.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace turnpoint::analysis {

double sorted_quantile(const std::vector<double>& sorted, double p) {
  if (sorted.empty() || !(p >= 0 && p <= 1))
    throw std::invalid_argument("quantile: needs at least one value and a share from 0 to 1");
  const double position = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const auto above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

double quantile(std::vector<double> values, double p) {
  std::sort(values.begin(), values.end());
  return sorted_quantile(values, p);
}

Interval percentile_interval(std::vector<double> replicates, double confidence) {
  std::sort(replicates.begin(), replicates.end());
  const double tail = (1 - confidence) / 2;
  return {sorted_quantile(replicates, tail), sorted_quantile(replicates, 1 - tail), confidence};
}

double student_t_975(int degrees) {
  if (degrees < 1) throw std::invalid_argument("student_t_975: needs one degree of freedom or more");
  if (degrees == 1) return 12.7062;
  if (degrees == 2) return 4.30265;
  // expansion around the normal quantile (Abramowitz & Stegun 26.7.5)
  const double z = 1.959964, n = degrees, q = z * z;
  const double first = z * (q + 1) / 4, second = z * (5 * q * q + 16 * q + 3) / 96;
  const double third = z * (3 * q * q * q + 19 * q * q + 17 * q - 15) / 384;
  return z + first / n + second / (n * n) + third / (n * n * n);
}

double mean(const std::vector<double>& values) {
  if (values.empty()) throw std::invalid_argument("mean: needs at least one value");
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double variance(const std::vector<double>& values) {
  if (values.size() < 2) throw std::invalid_argument("variance: needs at least two values");
  const double centre = mean(values);
  double sum = 0;
  for (const double value : values) sum += (value - centre) * (value - centre);
  return sum / static_cast<double>(values.size() - 1);
}

}  // namespace turnpoint::analysis

#include "station/sensing/onset.hpp"

#include <algorithm>
#include <cmath>

namespace turnpoint::sensing {

namespace {

// Value at index `at` of the polynomial through `points` values of y that start at index `first`.
double interpolated(std::span<const double> y, std::size_t first, std::size_t points, double at) {
  double sum = 0;
  for (std::size_t i = first; i < first + points; ++i) {
    double weight = 1;
    for (std::size_t j = first; j < first + points; ++j)
      if (j != i) weight *= (at - static_cast<double>(j)) / (static_cast<double>(i) - static_cast<double>(j));
    sum += weight * y[i];
  }
  return sum;
}

}  // namespace

std::optional<double> half_level(std::span<const double> envelope) {
  constexpr double half = 0.5;
  std::optional<std::size_t> below;
  for (std::size_t k = 0; k + 1 < envelope.size(); ++k)
    if (envelope[k] < half && envelope[k + 1] >= half) below = k;
  if (!below) return std::nullopt;
  const std::size_t points = std::min<std::size_t>(4, envelope.size());
  const std::size_t first = std::min(*below > 0 ? *below - 1 : 0, envelope.size() - points);
  for (std::size_t k = first; k < first + points; ++k)
    if (std::isnan(envelope[k])) return std::nullopt;
  auto low = static_cast<double>(*below), high = low + 1;
  while (high - low > 1e-9) {
    const double middle = (low + high) / 2;
    (interpolated(envelope, first, points, middle) < half ? low : high) = middle;
  }
  return low;
}

}  // namespace turnpoint::sensing

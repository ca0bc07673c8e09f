#include "physics/monotone_cubic.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "physics/root.hpp"

namespace turnpoint::physics {
namespace {

// The slope at an inner point is Fritsch & Butland's weighted harmonic mean of the neighbouring slopes. At an
// extremum it is zero, so that no cubic overshoots.
double inner_slope(double h0, double h1, double d0, double d1) {
  if (d0 * d1 <= 0) return 0;
  const double w0 = 2 * h1 + h0;
  const double w1 = h1 + 2 * h0;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

// The slope at an end is estimated from three points, and limited so that the first or last cubic stays
// monotone.
double end_slope(double h0, double h1, double d0, double d1) {
  const double slope = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
  if (slope * d0 <= 0) return d0 == 0 ? 0 : d0 / 3;
  if (d0 * d1 <= 0 && std::abs(slope) > 3 * std::abs(d0)) return 3 * d0;
  return std::abs(slope) > 3 * std::abs(d0) ? 3 * d0 : slope;
}

}  // namespace

MonotoneCubic::MonotoneCubic(std::span<const double> x, std::span<const double> y,
                             std::span<const double> slopes) {
  const std::size_t n = x.size();
  if (n < 2 || y.size() != n) throw std::invalid_argument("a monotone cubic needs two or more points");
  std::vector<double> h(n - 1), d(n - 1), m(n);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    h[i] = x[i + 1] - x[i];
    if (!(h[i] > 0)) {
      throw std::invalid_argument("points of a table must ascend; point " + std::to_string(i + 2) +
                                  " does not");
    }
    d[i] = (y[i + 1] - y[i]) / h[i];
  }
  for (std::size_t i = 1; i + 1 < n; ++i) m[i] = inner_slope(h[i - 1], h[i], d[i - 1], d[i]);
  m.front() = n == 2 ? d[0] : end_slope(h[0], h[1], d[0], d[1]);
  m.back() = n == 2 ? d[0] : end_slope(h[n - 2], h[n - 3], d[n - 2], d[n - 3]);
  if (!slopes.empty()) m.assign(slopes.begin(), slopes.end());
  pieces_.reserve(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    pieces_.push_back({x[i], x[i + 1], y[i], m[i], (3 * d[i] - 2 * m[i] - m[i + 1]) / h[i],
                       (m[i] + m[i + 1] - 2 * d[i]) / (h[i] * h[i])});
    const Cubic& p = pieces_.back();
    if (!std::isfinite(p.x0 + p.x1 + p.y0 + p.c1 + p.c2 + p.c3))
      throw std::invalid_argument(
          "points of a table must be finite and not closer than a number can tell; point " +
          std::to_string(i + 2) + " is not");
  }
}

const Cubic& MonotoneCubic::piece(double x) const {
  const auto after = std::upper_bound(pieces_.begin(), pieces_.end(), x,
                                      [](double value, const Cubic& piece) { return value < piece.x0; });
  return after == pieces_.begin() ? pieces_.front() : *(after - 1);
}

double MonotoneCubic::inverse(double y) const {
  const bool rising = pieces_.back().value(pieces_.back().x1) > pieces_.front().y0;
  const auto after = std::upper_bound(
      pieces_.begin(), pieces_.end(), y,
      [rising](double value, const Cubic& p) { return rising ? value < p.y0 : value > p.y0; });
  const Cubic& p = after == pieces_.begin() ? pieces_.front() : *(after - 1);
  if (y == p.y0) return p.x0;
  const Bracket bracket{rising ? p.x1 : p.x0, rising ? p.x0 : p.x1};
  const auto tangent = [&](double x) {
    const double miss = p.value(x) - y;
    return Tangent{miss, x - miss / p.slope(x)};
  };
  return newton(
      bracket, bracket.middle(), tangent, [](double next, double x) { return next == x; }, 100);
}

}  // namespace turnpoint::physics

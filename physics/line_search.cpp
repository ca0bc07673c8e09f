#include "physics/line_search.hpp"

#include <algorithm>
#include <cmath>

namespace turnpoint::physics {
namespace {

// d ln|v| / dx times |v|^2, in the units of the local scale.
double rise(const CentreLine& line, double x) {
  const Scaled v = line.value(x), slope = line.slope(x);
  return (std::conj(v.mantissa) * slope.mantissa).real();
}

}  // namespace

std::optional<double> find_last_peak(const CentreLine& line, double from_m, double spacing_m) {
  double outer = from_m;
  double f_outer = rise(line, outer);
  while (outer > 0) {
    double inner = std::max(0.0, outer - spacing_m);
    double f_inner = rise(line, inner);
    if (!(f_inner > 0 && f_outer <= 0)) {
      outer = inner;
      f_outer = f_inner;
      continue;
    }
    for (int n = 0; n < 60; ++n) {
      double x = n % 3 == 2 ? 0.5 * (inner + outer) : inner + (outer - inner) * f_inner / (f_inner - f_outer);
      if (!(x > inner && x < outer)) x = 0.5 * (inner + outer);
      if (x <= inner || x >= outer) break;
      const double f = rise(line, x);
      (f > 0 ? inner : outer) = x;
      (f > 0 ? f_inner : f_outer) = f;
      if (f == 0) return x;
    }
    return 0.5 * (inner + outer);
  }
  return std::nullopt;
}

std::optional<double> find_level(const CentreLine& line, double peak_m, double length_m, double spacing_m,
                                 double level) {
  const double target = line.value(peak_m).ln_magnitude() + std::log(level);
  double inner = peak_m, outer = peak_m;
  do {
    if (outer >= length_m) return std::nullopt;
    inner = outer;
    outer = std::min(length_m, outer + spacing_m);
  } while (line.value(outer).ln_magnitude() > target);
  double x = 0.5 * (inner + outer);
  for (int i = 0; i < 100; ++i) {
    const Scaled v = line.value(x);
    const double miss = v.ln_magnitude() - target;
    (miss > 0 ? inner : outer) = x;
    const double log_slope = v.mantissa == 0.0 ? 0 : (line.slope(x).mantissa / v.mantissa).real();
    double next = log_slope == 0 ? x : x - miss / log_slope;
    if (!(next > inner && next < outer)) next = 0.5 * (inner + outer);
    if (std::abs(next - x) <= 1e-16 * length_m) return next;
    x = next;
  }
  return x;
}

}  // namespace turnpoint::physics

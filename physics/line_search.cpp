#include "physics/line_search.hpp"

#include <algorithm>
#include <cmath>

#include "physics/root.hpp"

namespace turnpoint::physics {
namespace {

// Returns |v|^2 d ln|v| / dx, where v is divided by a local scale factor. It is positive where |v| rises with
// x.
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
    const auto never = [](const Chord&) { return false; };
    return false_position(
        {inner, f_inner, outer, f_outer}, [&](double x) { return rise(line, x); }, {3}, 0, never);
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
  const auto tangent = [&](double x) {
    const Scaled v = line.value(x);
    const double miss = v.ln_magnitude() - target;
    const double log_slope = v.mantissa == 0.0 ? 0 : (line.slope(x).mantissa / v.mantissa).real();
    return Tangent{miss, x - miss / log_slope};
  };
  const auto close = [&](double next, double x) { return std::abs(next - x) <= 1e-16 * length_m; };
  const Bracket bracket{inner, outer};
  return newton(bracket, bracket.middle(), tangent, close, 100);
}

}  // namespace turnpoint::physics

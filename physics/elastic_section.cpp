#include "physics/elastic_section.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "physics/gate.hpp"
#include "physics/root.hpp"

namespace turnpoint::physics {
namespace {

// Wavenumber times half-width, k W, of a thin clamped strip at its cut-off: the root of tan b + tanh b = 0.
constexpr double thin_root = 2.3650203724313520;
constexpr double thickest = 2, highest_poisson = 0.49;

// A row for each term in h/W, and in it one for each term in Poisson's ratio.
constexpr std::array<std::array<double, 12>, 18> table{{
#include "physics/elastic_table.inc"
}};

// Sum of coefficient[k] T_k(x), by Clenshaw's recurrence.
double chebyshev(std::span<const double> coefficient, double x) noexcept {
  double b1 = 0, b2 = 0;
  for (std::size_t k = coefficient.size() - 1; k > 0; --k) {
    const double b0 = 2 * x * b1 - b2 + coefficient[k];
    b2 = b1;
    b1 = b0;
  }
  return x * b1 - b2 + coefficient[0];
}

}  // namespace

ElasticCutOff::ElasticCutOff(double poisson)
    : kirchhoff_(thin_root * thin_root / std::sqrt(6 * (1 - poisson))) {
  require(poisson >= 0 && poisson <= highest_poisson, "poisson", poisson, "0 to 0.49");
  std::ranges::transform(table, coefficient_.begin(), [poisson](const auto& row) {
    return chebyshev(row, 2 * poisson / highest_poisson - 1);
  });
}

double ElasticCutOff::value(double t) const noexcept {
  const double at = std::min(t, thickest);
  return kirchhoff_ * at * chebyshev(coefficient_, 2 * at / thickest - 1);
}

double ElasticCutOff::thickness_per_half_width(double wanted) const noexcept {
  if (wanted >= thickest * value(thickest)) return wanted / value(thickest);
  const auto miss = [&](double t) { return t * value(t) - wanted; };
  return false_position({0, -wanted, thickest, miss(thickest)}, miss, {8, true}, 0,
                        [](const Chord& c) { return c.width() <= 1e-15 * c.right; });
}

}  // namespace turnpoint::physics

#include "physics/mindlin_plate.hpp"
#include "physics/gate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "physics/root.hpp"

namespace turnpoint::physics {
namespace {

// The functions sqrt(s) tan(sqrt(s) w), cos(sqrt(s) w) and sqrt(s) sin(sqrt(s) w). They are real for negative
// s as well.
double root_tangent(double s, double w) noexcept {
  if (s > 0) return std::sqrt(s) * std::tan(std::sqrt(s) * w);
  return -std::sqrt(-s) * std::tanh(std::sqrt(-s) * w);
}
double root_cosine(double s, double w) noexcept {
  return s > 0 ? std::cos(std::sqrt(s) * w) : std::cosh(std::sqrt(-s) * w);
}
double root_sine(double s, double w) noexcept {
  return s > 0 ? std::sqrt(s) * std::sin(std::sqrt(s) * w) : -std::sqrt(-s) * std::sinh(std::sqrt(-s) * w);
}
// Returns tan(sqrt(s) w) / sqrt(s), which is real for negative s as well.
double tangent_over_root(double s, double w) noexcept {
  return std::abs(s) * w * w < 1e-12 ? w : root_tangent(s, w) / s;
}

}  // namespace

double shear_factor(double nu) {
  require(nu >= -0.9 && nu <= 0.5, "poisson", nu, "-0.9 to 0.5");
  const double held = nu / (1 - nu);
  return 5 / (6 - nu) + 0.12 * held * held;
}

MindlinPlate::MindlinPlate(const Surface& s)
    : stiffness_N_m(bending_stiffness_N_m(s).value()),
      shear_N_per_m(shear_factor(s.poisson) * *s.modulus_Pa / (2 * (1 + s.poisson)) * s.thickness_m),
      mass_kg_per_m2(s.density_kg_m3 * s.thickness_m),
      rotary_inertia_kg(s.density_kg_m3 * s.thickness_m * s.thickness_m * s.thickness_m / 12),
      twist_N_m(0.5 * stiffness_N_m * (1 - s.poisson)) {}

MindlinPlate::Waves MindlinPlate::waves(double f) const noexcept {
  const double omega = 2 * std::numbers::pi * f, o2 = omega * omega;
  const double d = stiffness_N_m, s = shear_N_per_m, m = mass_kg_per_m2 * o2, j = rotary_inertia_kg * o2;
  const double half = 0.5 * (d * m + s * j), product = d * s * m * (j - s);
  const double larger = half + std::sqrt(half * half - product);
  Waves waves{};
  waves.bending = larger / (d * s);
  // use the product of the two roots, because computing the smaller one as a difference would lose digits
  waves.evanescent = m * (j - s) / larger;
  waves.shear = (j - s) / twist_N_m;
  waves.share_bending = 1 - m / (s * waves.bending);
  waves.share_evanescent = 1 - m / (s * waves.evanescent);
  return waves;
}

double MindlinPlate::wavenumber_per_m(double f) const noexcept { return std::sqrt(waves(f).bending); }

double MindlinPlate::frequency_Hz(double k) const noexcept {
  // Solves (J omega^2 - S - D k^2)(rho h omega^2 - S k^2) = S^2 k^2 for the smaller omega^2 (symbols as in
  // mindlin_plate.hpp).
  const double d = stiffness_N_m, s = shear_N_per_m, m = mass_kg_per_m2, j = rotary_inertia_kg, k2 = k * k;
  const double half = 0.5 * (j * s * k2 + m * (s + d * k2)), product = j * m * s * d * k2 * k2;
  return std::sqrt(s * d * k2 * k2 / (half + std::sqrt(half * half - product))) / (2 * std::numbers::pi);
}

// For pi/2 < k W < pi (k of the bending wave): returns a number that is positive below the cut-off and
// negative above it.
double MindlinPlate::below_cut_off(const Waves& w, double half_width) const noexcept {
  const double k = std::sqrt(w.bending), over = w.share_evanescent / (w.share_bending * k);
  return std::sin(k * half_width) - over * root_tangent(w.evanescent, half_width) * std::cos(k * half_width);
}

double MindlinPlate::cut_off_half_width_m(double f) const noexcept {
  const Waves w = waves(f);
  const auto value = [&](double half_width) { return below_cut_off(w, half_width); };
  const double k = std::sqrt(w.bending), low = std::numbers::pi / (2 * k), high = std::numbers::pi / k;
  return false_position({low, value(low), high, value(high)}, value, {8, true}, 0,
                        [](const Chord& c) { return c.width() <= 1e-15 * c.right; });
}

double MindlinPlate::cut_off_frequency_Hz(double half_width) const noexcept {
  const auto value = [&](double f) { return below_cut_off(waves(f), half_width); };
  const double low = frequency_Hz(std::numbers::pi / (2 * half_width));
  const double high = frequency_Hz(std::numbers::pi / half_width);
  return false_position({low, value(low), high, value(high)}, value, {8, true}, 0,
                        [](const Chord& c) { return c.width() <= 1e-15 * c.right; });
}

double MindlinPlate::characteristic(double f, double w, double along) const noexcept {
  const Waves waves_of = waves(f);
  const double s1 = waves_of.bending - along, s2 = waves_of.evanescent - along, s3 = waves_of.shear - along;
  const double a1 = waves_of.share_bending, a2 = waves_of.share_evanescent;
  return a1 * root_sine(s1, w) - a2 * root_tangent(s2, w) * root_cosine(s1, w) +
         along * (a1 - a2) * root_cosine(s1, w) * tangent_over_root(s3, w);
}

}  // namespace turnpoint::physics

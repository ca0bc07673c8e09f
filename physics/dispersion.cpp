#include "physics/dispersion.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "physics/gate.hpp"
#include "physics/root.hpp"

namespace turnpoint::physics {
namespace {

using std::numbers::pi;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Wavenumber times half-width, k W, of a clamped strip without tension at its cut-off: the root of tan b +
// tanh b = 0.
constexpr double plate_root = 2.3650203724313520;

// Returns k W of a clamped strip at its cut-off, for tau = W^2 N/D (N: line tension, D: bending stiffness).
// It is the root b in (pi/2, pi) of b sin b + g tanh(g) cos b = 0, with g^2 = b^2 + tau. This is the cut-off
// equation (see dispersion.hpp) multiplied by cos b, which removes the pole. For b below the root, the left
// side is positive.
double clamped_root(double tau) noexcept {
  const auto tangent = [tau](double b) {
    const double g = std::sqrt(b * b + tau);
    const double t = std::tanh(g);
    const double sine = std::sin(b), cosine = std::cos(b);
    const double value = b * sine + g * t * cosine;
    const double slope = sine + b * cosine + b / g * (t + g * (1 - t * t)) * cosine - g * t * sine;
    return Tangent{value, b - value / slope};
  };
  return newton({pi / 2, pi}, 2.4, tangent,
                [](double next, double b) { return std::abs(next - b) <= 2 * epsilon * b; });
}

}  // namespace

Dispersion::Dispersion(const Surface& s)
    : tension_N_per_m(line_tension_N_per_m(s)),
      mass_kg_per_m2(s.density_kg_m3 * s.thickness_m),
      speed_m_s(wave_speed_m_s(s)),
      bending(bending_modelled(s)),
      clamped(s.edges == Edges::clamped),
      theory(s.theory),
      thickness_m_(s.thickness_m) {
  if (bending) stiffness_N_m = bending_stiffness_N_m(s).value();
  if (theory == PlateTheory::kirchhoff) return;
  mindlin_ = MindlinPlate(s);
  if (theory == PlateTheory::mindlin) return;
  elastic_.emplace(s.poisson);
  const double rigidity = *s.modulus_Pa / (2 * (1 + s.poisson));
  shear_speed_m_s_ = std::sqrt(rigidity / s.density_kg_m3);
  mindlin_.shear_N_per_m = 5 / (6 - s.poisson) * rigidity * s.thickness_m;
}

double Dispersion::wavenumber_per_m(double f) const noexcept {
  const double omega = 2 * pi * f;
  if (!bending) return omega / speed_m_s;
  if (theory != PlateTheory::kirchhoff) return mindlin_.wavenumber_per_m(f);
  const double inertia = mass_kg_per_m2 * omega * omega;
  const double n = tension_N_per_m;
  return std::sqrt(2 * inertia / (n + std::sqrt(n * n + 4 * stiffness_N_m * inertia)));
}

double Dispersion::wave_quality(double f, double quality_factor) const noexcept {
  if (!bending) return quality_factor;
  if (theory != PlateTheory::kirchhoff) return 2 * quality_factor;
  const double k = wavenumber_per_m(f), bent = stiffness_N_m * k * k;
  return quality_factor * (2 * bent + tension_N_per_m) / (bent + tension_N_per_m);
}

std::complex<double> Dispersion::loss(double f, double quality_factor) const noexcept {
  // A part that no sum can show is left out: its products would be denormal numbers, which take many
  // processors a hundred times as long.
  const double part = 0.5 / wave_quality(f, quality_factor);
  constexpr double least = std::numeric_limits<double>::epsilon();
  return {1, part < least * least ? -0.0 : -part};
}

double Dispersion::frequency_Hz(double k) const noexcept {
  if (!bending) return k * speed_m_s / (2 * pi);
  if (theory != PlateTheory::kirchhoff) return mindlin_.frequency_Hz(k);
  return k * std::sqrt((stiffness_N_m * k * k + tension_N_per_m) / mass_kg_per_m2) / (2 * pi);
}

double Dispersion::cut_off_frequency_Hz(double w) const noexcept {
  if (theory == PlateTheory::mindlin) return mindlin_.cut_off_frequency_Hz(w);
  if (elastic_) return elastic_->value(thickness_m_ / w) * shear_speed_m_s_ / (2 * pi * w);
  if (!clamped_bending()) return frequency_Hz(pi / (2 * w));
  if (tension_N_per_m == 0) return frequency_Hz(plate_root / w);
  return frequency_Hz(clamped_root(w * w * tension_N_per_m / stiffness_N_m) / w);
}

double Dispersion::cut_off_half_width_m(double f) const noexcept {
  if (theory == PlateTheory::mindlin) return mindlin_.cut_off_half_width_m(f);
  if (elastic_) {
    return thickness_m_ / elastic_->thickness_per_half_width(2 * pi * f * thickness_m_ / shear_speed_m_s_);
  }
  const double k = wavenumber_per_m(f);
  if (!clamped_bending()) return pi / (2 * k);
  if (tension_N_per_m == 0) return plate_root / k;
  // Here k is known, so that tan(k W) = -(k2/k) tanh(k2 W) can be solved for k W by a fast fixed-point
  // iteration.
  const double ratio = std::sqrt(1 + tension_N_per_m / (stiffness_N_m * k * k));
  double b = 2.4;
  for (int i = 0; i < 60; ++i) {
    const double next = pi - std::atan(ratio * std::tanh(ratio * b));
    if (std::abs(next - b) <= 2 * epsilon * b) return next / k;
    b = next;
  }
  return b / k;
}

double wavenumber_per_m(const Surface& s, double f) {
  validate(s);
  require_size("frequency_Hz", f);
  return Dispersion(s).wavenumber_per_m(f);
}
double frequency_for_wavenumber_Hz(const Surface& s, double k) {
  validate(s);
  require_size("wavenumber_per_m", k);
  return Dispersion(s).frequency_Hz(k);
}
double cut_off_frequency_Hz(const Surface& s, double w) {
  validate(s);
  require_size("half_width_m", w);
  return Dispersion(s).cut_off_frequency_Hz(w);
}
double cut_off_half_width_m(const Surface& s, double f) {
  validate(s);
  require_size("frequency_Hz", f);
  return Dispersion(s).cut_off_half_width_m(f);
}

}  // namespace turnpoint::physics

#pragma once
// Computes wavenumbers and local cut-off frequencies from tension, bending stiffness and the support of the
// sides.
#include <complex>
#include <optional>

#include "physics/elastic_section.hpp"
#include "physics/mindlin_plate.hpp"
#include "physics/surface.hpp"

namespace turnpoint::physics {

// The dispersion relation of one surface, prepared for many calls. Its functions neither allocate nor throw,
// and expect arguments above zero. The free functions below return the same values, and check their
// arguments.
struct Dispersion {
  explicit Dispersion(const Surface& surface);

  // Wavenumber k of a free plane wave without loss. It solves D k^4 +
  // N k^2 = rho h omega^2; if bending is not modelled, it is omega/c. Plate theories mindlin and elastic use
  // Mindlin's equation. For elastic the shear factor is 5/(6 - nu), which agrees with the Rayleigh-Lamb
  // equation within 0.1 % up to k h = 1.
  double wavenumber_per_m(double frequency_Hz) const noexcept;
  double frequency_Hz(double wavenumber_per_m) const noexcept;
  // With loss, k becomes k times this factor, 1 - i g/2Q with g = (omega/k) dk/domega. Then Q is the quality
  // factor that a resonance curve shows, because a small change of k by the part d moves a resonance by the
  // part d/g. On a membrane g is 1, in bending 1/2, with tension and bending in between. (The theories
  // mindlin and elastic multiply omega^2 by the fourth power of the factor for g = 1/2.)
  std::complex<double> loss(double frequency_Hz, double quality_factor) const noexcept;
  // The quality factor that a membrane would have if its waves lost as much on each radian of phase: Q/g.
  double wave_quality(double frequency_Hz, double quality_factor) const noexcept;
  // Cut-off of the first transverse mode in a strip of half-width W. For a membrane, or simply supported
  // sides: k W = pi/2 (eq. 17 of the 1998 paper). For clamped sides with bending: the root in pi/2 < k W < pi
  // of k tan(k W) + k2 tanh(k2 W) = 0 with k2^2 = k^2 + N/D (2.36502 without tension). For the plate theories
  // mindlin and elastic see MindlinPlate and ElasticCutOff.
  double cut_off_frequency_Hz(double half_width_m) const noexcept;
  double cut_off_half_width_m(double frequency_Hz) const noexcept;
  bool clamped_bending() const noexcept { return bending && clamped; }

  double stiffness_N_m = 0;    // bending stiffness D; 0 if bending is not modelled
  double tension_N_per_m = 0;  // line tension N
  double mass_kg_per_m2 = 0;   // mass per area, rho h
  double speed_m_s = 0;        // wave speed c of the membrane
  bool bending = false;
  bool clamped = false;
  PlateTheory theory = PlateTheory::kirchhoff;

 private:
  MindlinPlate mindlin_;
  std::optional<ElasticCutOff> elastic_;
  double shear_speed_m_s_ = 0;
  double thickness_m_ = 0;
};

// These functions throw std::invalid_argument unless all arguments are finite and above zero.
double wavenumber_per_m(const Surface& surface, double frequency_Hz);
double frequency_for_wavenumber_Hz(const Surface& surface, double wavenumber_per_m);
double cut_off_frequency_Hz(const Surface& surface, double half_width_m);
double cut_off_half_width_m(const Surface& surface, double frequency_Hz);

}  // namespace turnpoint::physics

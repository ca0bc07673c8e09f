#pragma once
// Wavenumbers and local cut-offs, as they depend on tension, bending and the support of the sides.
#include "physics/elastic_section.hpp"
#include "physics/mindlin_plate.hpp"
#include "physics/surface.hpp"

namespace turnpoint::physics {

// The dispersion of one surface, prepared for repeated use: plain numbers, no allocation, no exceptions for
// arguments above zero. The free functions below do the same and check their arguments.
struct Dispersion {
  explicit Dispersion(const Surface& surface);

  // Free plane wave: D k^4 + N k^2 = rho h omega^2, or omega/c where bending is not modelled. Lossless; loss
  // enters as k (1 - i/2Q). Plate theories mindlin and elastic: Mindlin's, with the shear factor 5/(6 - nu)
  // for elastic, which agrees with the Rayleigh-Lamb equation within 0.1 % for k h to 1.
  double wavenumber_per_m(double frequency_Hz) const noexcept;
  double frequency_Hz(double wavenumber_per_m) const noexcept;
  // Local cut-off of the first transverse mode of a strip of half-width W. Membrane, or simply supported
  // sides: k W = pi/2 (the seed's eq. 17). Clamped sides with bending: k tan(k W) + k2 tanh(k2 W) = 0, k2^2 =
  // k^2 + N/D, the root in pi/2 < k W < pi (2.36502 without tension). Plate theories mindlin and elastic: see
  // MindlinPlate and ElasticCutOff.
  double cut_off_frequency_Hz(double half_width_m) const noexcept;
  double cut_off_half_width_m(double frequency_Hz) const noexcept;
  bool clamped_bending() const noexcept { return bending && clamped; }

  double stiffness_N_m = 0;    // bending stiffness D; 0 if bending is not modelled
  double tension_N_per_m = 0;  // N
  double mass_kg_per_m2 = 0;   // mass per area, rho h
  double speed_m_s = 0;        // wave speed c of the membrane
  bool bending = false;
  bool clamped = false;
  PlateTheory theory = PlateTheory::kirchhoff;

 private:
  MindlinPlate mindlin_;
  const ElasticCutOff* elastic_ = nullptr;
  double shear_speed_m_s_ = 0;
  double thickness_m_ = 0;
};

// These functions throw std::invalid_argument for arguments that are not finite and above zero.
double wavenumber_per_m(const Surface& surface, double frequency_Hz);
double frequency_for_wavenumber_Hz(const Surface& surface, double wavenumber_per_m);
double cut_off_frequency_Hz(const Surface& surface, double half_width_m);
double cut_off_half_width_m(const Surface& surface, double frequency_Hz);

}  // namespace turnpoint::physics

#pragma once
// The dispersion and the cut-off of a clamped strip by Mindlin's plate theory, which includes shear
// deformation and rotary inertia.
#include "physics/surface.hpp"

namespace turnpoint::physics {

// Mindlin's shear factor for a Poisson's ratio nu: 5/(6 - nu) + 0.12 (nu / (1 - nu))^2. With the first term,
// long waves of a free plate agree with the Rayleigh-Lamb equation to the next order in k h (N. Stephen, J.
// Sound Vib. 202 (1997) 539; J. Hutchinson, J. Appl. Mech. 51 (1984) 581). The second term describes the
// clamp. A bent plate contracts across its thickness by nu / (1 - nu) of the bending strain; the clamp
// prevents this and so stiffens the strip within half a thickness of the clamp. The constant 0.12 is fitted
// to plane-strain finite elements. The cut-off half-width then agrees with the finite elements within 0.2 %
// for h/W to 0.4 and nu to 0.4, and within 0.4 % for nu to 0.49.
double shear_factor(double poisson);

// Mindlin's equations for a plate (R. Mindlin, J. Appl. Mech. 18 (1951) 31). beta is the rotation, so that z
// beta is the displacement in the plane; S = kappa G h with the shear factor kappa, and J = rho h^3 / 12:
//   S (lap w + div beta) + rho h omega^2 w = 0
//   D/2 ((1 - nu) lap beta + (1 + nu) grad div beta) - S (beta + grad w) + J omega^2 beta = 0
// Along a clamped side w = beta = 0. The functions neither allocate nor throw, and expect arguments above
// zero.
struct MindlinPlate {
  MindlinPlate() = default;
  explicit MindlinPlate(const Surface& surface);

  // Squared wavenumbers (1/m^2) of the waves of a free plate. Two belong to bending and solve D S k^4 - (D
  // rho h + S J) omega^2 k^2 + (J omega^2 - S) rho h omega^2 = 0. One belongs to shear in the plane. For
  // wavelengths above about three thicknesses, the squares of the evanescent bending wave and of the shear
  // wave are negative. `share` is -beta / grad w of each bending wave.
  struct Waves {
    double bending, evanescent, shear;
    double share_bending, share_evanescent;
  };
  Waves waves(double frequency_Hz) const noexcept;

  double wavenumber_per_m(double frequency_Hz) const noexcept;
  double frequency_Hz(double wavenumber_per_m) const noexcept;
  // First symmetric cut-off: the W that solves a1 k1 tan(k1 W) + a2 g2 tanh(g2 W) = 0 with pi/2 < k1 W < pi.
  // k1 belongs to the travelling bending wave, g2 to the evanescent one, and a1, a2 are their `share`s.
  double cut_off_half_width_m(double frequency_Hz) const noexcept;
  double cut_off_frequency_Hz(double half_width_m) const noexcept;
  // The dispersion function of an infinite strip. It is zero if the strip carries a wave exp(-i kx x),
  // symmetric about the centre line, with kx^2 = `along_per_m2`, which may be negative.
  double characteristic(double frequency_Hz, double half_width_m, double along_per_m2) const noexcept;

  double stiffness_N_m = 0;      // bending stiffness D
  double shear_N_per_m = 0;      // shear stiffness S
  double mass_kg_per_m2 = 0;     // mass per area, rho h
  double rotary_inertia_kg = 0;  // rotary inertia per area, J
  double twist_N_m = 0;          // twisting stiffness, D (1 - nu) / 2

 private:
  double below_cut_off(const Waves& waves, double half_width_m) const noexcept;
};

}  // namespace turnpoint::physics

#pragma once
// Computes the cut-off of a clamped strip from the three-dimensional elasticity of its cross-section.
#include <array>

namespace turnpoint::physics {

// First symmetric bending cut-off of a clamped strip, as omega W / c_s with c_s^2 = G / rho. The
// cross-section is |y| < W, |z| < h/2 (plane strain). It is held at |y| = W over the whole thickness and free
// at z = +-h/2. The result depends only on h/W and Poisson's ratio. A table of the cut-off is computed with
// finite elements once for each Poisson's ratio (in about 0.15 s) and kept. Functions marked const are
// thread-safe and allocate nothing.
class ElasticCutOff {
 public:
  // The table for a Poisson's ratio from 0 to 0.49. It stays valid until the program ends.
  static const ElasticCutOff& of(double poisson);

  explicit ElasticCutOff(double poisson);
  // Returns omega W / c_s for a given h/W. The table ends at h/W = 2. Beyond that the function returns the
  // last value, which is 4 % above the limit pi/2.
  double value(double thickness_per_half_width) const noexcept;
  // Returns the h/W for which omega h / c_s has this value. omega h / c_s is h/W times value(h/W).
  double thickness_per_half_width(double omega_h_per_speed) const noexcept;

 private:
  static constexpr std::size_t terms = 18;
  static constexpr double largest = 2;
  std::array<double, terms> coefficient_{};  // Chebyshev series of value() divided by Kirchhoff's value
  double kirchhoff_;                         // omega W / c_s by Kirchhoff's theory, divided by h/W
};

// Computes omega W / c_s by finite elements, without the table. The relative error, found with a mesh refined
// towards the corners, is within 2e-4 for Poisson's ratios to 0.33 and h/W to 0.4, and within 8e-4 for
// Poisson's ratios to 0.45 and h/W to 0.6.
double elastic_cut_off(double thickness_per_half_width, double poisson);

}  // namespace turnpoint::physics

#pragma once
// The cut-off of a clamped strip by the three-dimensional elasticity of its cross-section.
#include <array>

namespace turnpoint::physics {

// First symmetric bending cut-off of a clamped strip, as omega W / c_s with c_s^2 = G / rho. The
// cross-section is |y| < W, |z| < h/2 (plane strain). It is held at |y| = W over the whole thickness and free
// at z = +-h/2. The result depends only on h/W and Poisson's ratio: a compiled-in table of Chebyshev
// coefficients, made by tests/physics/oracles/make_section.py with finite elements of degree 5. Its relative
// error is within 2e-5 for Poisson's ratios to 0.45 and h/W from 0.05 to 0.6; elsewhere it was compared only
// with the coarser elements of fields, from which it differs by 2e-3 at most. Functions marked const are
// thread-safe and allocate nothing.
class ElasticCutOff {
 public:
  // The cut-offs for a Poisson's ratio from 0 to 0.49.
  explicit ElasticCutOff(double poisson);
  // Returns omega W / c_s for a given h/W. The table ends at h/W = 2. Beyond that the function returns the
  // last value, which is 6 to 11 % below the limit pi/2.
  double value(double thickness_per_half_width) const noexcept;
  // Returns the h/W for which omega h / c_s has this value. omega h / c_s is h/W times value(h/W).
  double thickness_per_half_width(double omega_h_per_speed) const noexcept;

 private:
  std::array<double, 18> coefficient_{};  // Chebyshev series of value() divided by Kirchhoff's value
  double kirchhoff_;                      // omega W / c_s by Kirchhoff's theory, divided by h/W
};

}  // namespace turnpoint::physics

#pragma once
// Marches g'' + p(x) g = 0 from the tip of a surface to its drive edge by high-order Taylor steps, carrying
// the size of g as a power of two, so that neither the evanescent zone nor strong loss leaves the range of a
// double.
//
//   p(x) = A - (B + C W'(x)^2) / W(x)^2,  A complex with loss
//
// Marching from the tip outward is the stable direction: the solution that vanishes at the tip is the one
// that grows. The tip is either the apex of a linear taper (regular singular point, started by Frobenius'
// series) or a clamped end anywhere.
#include <complex>
#include <memory>
#include <optional>
#include <span>

#include "physics/taper.hpp"

namespace turnpoint::physics {

struct MarchEquation {
  std::complex<double> a;  // 1/m^2
  double b = 0;            // factor of 1/W^2
  double c = 0;            // factor of W'^2/W^2
  double w_power = 0;      // exponent in the displacement v = g W^-w_power
};

// A value of g or v in two parts: it is `mantissa` exp(ln_scale).
struct Scaled {
  std::complex<double> mantissa;
  double ln_scale = 0;
  double ln_magnitude() const;  // ln|value|; ln_zero if the value is exactly zero
};

// One solution of the equation, with an arbitrary constant factor. Immutable; const functions are
// thread-safe.
class TaylorMarch {
 public:
  TaylorMarch(const Taper& taper, const MarchEquation& equation);
  // The part that holds the last maximum and the levels beyond it: from a point `held_m` in the evanescent
  // zone, where v is taken as zero, to the last maximum. Nothing may be asked about the rest.
  TaylorMarch(const Taper& taper, const MarchEquation& equation, double held_m);
  ~TaylorMarch();
  TaylorMarch(TaylorMarch&&) noexcept;
  TaylorMarch& operator=(TaylorMarch&&) noexcept;

  // The displacement v and its derivative dv/dx at one point of [0, length_m].
  Scaled value(double x_m) const;
  Scaled slope(double x_m) const;

  // Computes v exp(-ln_reference) / phase_reference at many points, and ln|v| - ln_reference. Any order of
  // `x_m` is allowed; ascending is fastest. Where v underflows it is 0, but the logarithm is still correct.
  void evaluate(std::span<const double> x_m, std::complex<double> phase_reference, double ln_reference,
                std::span<std::complex<double>> v, std::span<double> ln_amplitude) const;

  // Position of the outermost maximum of |v| on the surface; empty if |v| rises all the way to the drive
  // edge, so that the maximum would lie beyond it.
  std::optional<double> last_peak_m() const;
  // Outermost point at which |v| is `level` times its last maximum, 0 < level < 1; empty if there is none.
  std::optional<double> level_m(double level) const;
  // Number of zeros of a real solution strictly between the drive edge and the tip.
  int zeros() const;
  // Number of Taylor steps; the cost is proportional to it.
  int steps() const;

 private:
  struct State;
  std::unique_ptr<const State> state_;
};

}  // namespace turnpoint::physics

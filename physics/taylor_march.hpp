#pragma once
// Solves g'' + p(x) g = 0 step by step ("marches") from the tip of a surface to its drive edge, with
// high-order Taylor series:
//
//    p(x) = A - (B + C W'(x)^2) / W(x)^2,  A complex with loss
//
// The size of g is kept as a power of two, so that g stays in the range of a double even in the evanescent
// zone or with strong loss. Starting at the tip is stable, because the solution that vanishes at the tip
// grows towards the drive edge. The tip is either a clamped end or the apex of a linear taper. The apex is a
// regular singular point, so the solution starts with Frobenius' series there.
#include <complex>
#include <memory>
#include <optional>
#include <span>

#include "physics/taper.hpp"

namespace turnpoint::physics {

struct MarchEquation {
  std::complex<double> a;  // A, in 1/m^2
  double b = 0;            // B, the factor of 1/W^2
  double c = 0;            // C, the factor of W'^2/W^2
  double w_power = 0;      // exponent in the displacement v = g W^-w_power
};

// A value of g or v in two parts: the value is `mantissa` times exp(ln_scale).
struct Scaled {
  std::complex<double> mantissa;
  double ln_scale = 0;
  double ln_magnitude() const;  // ln|value|; ln_zero if the value is exactly zero
};

// One solution of the equation, with an arbitrary constant factor. Immutable; functions marked const are
// thread-safe.
class TaylorMarch {
 public:
  TaylorMarch(const Taper& taper, const MarchEquation& equation);
  // Solves only the part from `held_m`, a point in the evanescent zone where v is set to zero, to the last
  // maximum. This part contains the last maximum and the levels beyond it. The functions below are valid only
  // in this part.
  TaylorMarch(const Taper& taper, const MarchEquation& equation, double held_m);
  ~TaylorMarch();
  TaylorMarch(TaylorMarch&&) noexcept;
  TaylorMarch& operator=(TaylorMarch&&) noexcept;

  // The displacement v and its derivative dv/dx at one point of [0, length_m].
  Scaled value(double x_m) const;
  Scaled slope(double x_m) const;
  struct Motion {
    Scaled value, slope;
  };
  Motion motion(double x_m) const;  // both, which takes as long as the slope alone

  // Computes v exp(-ln_reference) / phase_reference at many points, and ln|v| - ln_reference. Any order of
  // `x_m` is allowed; ascending is fastest. Where v underflows it is 0, but the logarithm is still correct.
  void evaluate(std::span<const double> x_m, std::complex<double> phase_reference, double ln_reference,
                std::span<std::complex<double>> v, std::span<double> ln_amplitude) const;

  // Position of the outermost maximum of |v| on the surface; empty if |v| rises all the way to the drive
  // edge.
  std::optional<double> last_peak_m() const;
  // Outermost point at which |v| is `level` times its last maximum, 0 < level < 1; empty if there is none.
  std::optional<double> level_m(double level) const;
  // Number of zeros of a real solution strictly between the drive edge and the tip.
  int zeros() const;
  // Number of Taylor steps. The cost of a solution is proportional to it.
  int steps() const;

 private:
  struct State;
  std::unique_ptr<const State> state_;
};

}  // namespace turnpoint::physics

#pragma once
// The Airy function Ai and its derivative for real arguments, accurate to rounding. The result keeps the
// exponential factor separate, so that it does not underflow.

namespace turnpoint::physics {

// Ai(t) = ai exp(ln_scale) and Ai'(t) = dai exp(ln_scale), with ln_scale = -2/3 t^(3/2) for t above 10, else
// 0. The error is below 1e-14, relative to the local envelope where Ai oscillates (t < 0), and to the value
// elsewhere. For |t| above 10 the function uses the series in DLMF 9.7; otherwise it uses a table of Taylor
// polynomials, made by solving y'' = t y from 10 downwards, the direction in which the solution is stable.
struct Airy {
  double ai;
  double dai;
  double ln_scale;
};
Airy airy(double t);

// Position of the outermost maximum of |Ai|: Ai'(t) = 0 at t = -1.018793.
inline constexpr double airy_last_peak = -1.0187929716474710890173;

}  // namespace turnpoint::physics

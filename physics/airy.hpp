#pragma once
// The Airy function Ai and its derivative for real argument, to rounding, with the exponential split off.

namespace turnpoint::physics {

// Ai(t) = ai exp(ln_scale), Ai'(t) = dai exp(ln_scale); ln_scale = -2/3 t^(3/2) for t above 10, else 0. Error
// below 1e-14 of the local envelope (oscillatory side) or of the value. Series: DLMF 9.7; between -10 and 10
// a table of Taylor polynomials made by marching the equation y'' = t y from 10 downwards, its stable
// direction.
struct Airy {
  double ai;
  double dai;
  double ln_scale;
};
Airy airy(double t);

// The outermost maximum of |Ai|: Ai'(t) = 0 at t = -1.018793.
inline constexpr double airy_last_peak = -1.0187929716474710890173;

}  // namespace turnpoint::physics

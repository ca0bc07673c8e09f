#pragma once
// Local series of the marched equation, at a regular point and at the apex of a linear taper.
#include <array>
#include <complex>
#include <vector>

#include "physics/taper.hpp"
#include "physics/taylor_kernel.hpp"
#include "physics/taylor_march.hpp"

namespace turnpoint::physics {

// g and dg/dx at a point; both are to be multiplied by 2^exponent exp(ln_base). The exponent is an integer,
// so that thousands of steps add no rounding error to it.
struct TaylorState {
  double x = 0;
  std::complex<double> g;
  std::complex<double> dg;
  double ln_base = 0;
  long exponent = 0;
  double ln_scale() const;
  // Moves a power of two from (g, dg scale) into the exponent.
  void normalise(double scale);
};

// Makes the Taylor polynomial of the solution through a state, and computes the length over which it is
// accurate to rounding.
class SeriesMaker {
 public:
  SeriesMaker(const Taper& taper, const MarchEquation& equation);
  void fill(const TaylorState& from, TaylorStep& step) const;

 private:
  double trial_scale(double x) const;
  std::complex<double> potential(double x) const;
  template <bool lossy>
  void linear(double x, TaylorStep& step) const;
  void convolved(double x, double knot, TaylorStep& step) const;
  int potential_series(double x, double knot, double scale, std::array<double, taylor_order>& q) const;

  const Taper& taper_;
  MarchEquation equation_;
};

// Frobenius' series at the apex of a linear taper: g = s^(mu + 1/2) sum c_j (k s)^2j, s the distance from the
// apex, mu^2 = B/d^2 + C + 1/4. Used for k s below 2 sqrt(mu + 1), where its terms fall from the first on.
class ApexSeries {
 public:
  ApexSeries(const Taper& taper, const MarchEquation& equation);
  double inner_m() const { return inner_m_; }
  TaylorState at(double x) const;

 private:
  double half_width_m_;
  double slope_;
  double mu_;
  double inner_m_;
  std::complex<double> a_;
};

}  // namespace turnpoint::physics

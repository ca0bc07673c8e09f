#pragma once
// Series that solve the equation of taylor_march.hpp near one point: a Taylor series at a regular point, and
// Frobenius' series at the apex of a linear taper.
#include <array>
#include <complex>
#include <vector>

#include "physics/taper.hpp"
#include "physics/taylor_kernel.hpp"
#include "physics/taylor_march.hpp"

namespace turnpoint::physics {

// The solution at a point: g and dg/dx, both to be multiplied by 2^exponent exp(ln_base). The exponent is an
// integer, so that it stays exact over thousands of steps.
struct TaylorState {
  double x = 0;
  std::complex<double> g;
  std::complex<double> dg;
  double ln_base = 0;
  long exponent = 0;
  double ln_scale() const;
  // Divides g and dg by a power of two, so that g and dg times `scale` are of order 1, and adds the power to
  // the exponent.
  void normalise(double scale);
};

// Makes the Taylor polynomial of the solution that passes through a given state, and computes the length over
// which the polynomial is accurate to rounding.
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

// Frobenius' series at the apex of a linear taper of slope d: g = s^(mu + 1/2) sum c_j (k s)^2j, with s the
// distance from the apex and mu^2 = B/d^2 + C + 1/4. It is used only for k s below 2 sqrt(mu + 1), where each
// term is smaller than the one before.
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

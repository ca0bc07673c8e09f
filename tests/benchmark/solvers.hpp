#pragma once
#include <complex>
#include <functional>
#include <string>
#include <vector>

namespace turnpoint::benchmark {

/// The one-mode equation g'' + [k^2 - (b + c W'^2)/W^2] g = 0, with v = g / sqrt(W) and g = 0 at x = length.
/// v is the displacement. W is the half-width: w0 - slope x or, with `decay_m` above 0, w0 exp(-x / decay_m).
struct OneModeProblem {
  std::complex<double> k_squared;
  double b = 0, c = 0;
  double w0 = 0, slope = 0, decay_m = 0, length_m = 0;
  std::vector<double> x_m;  ///< ascending positions (m) at which the solution is wanted

  double half_width_m(double x) const;
  double width_slope(double x) const;
  bool wedge() const { return decay_m == 0; }
  /// the order mu of the wedge's exact solution J_mu(k s), where s is the distance from the apex
  double bessel_order() const;
};

/// Complex displacement at each point, up to a constant factor.
using Solution = std::vector<std::complex<double>>;

struct Solver {
  std::string name;     ///< such as "Boost.Odeint dopri5"
  std::string setting;  ///< tolerance or number of steps; "" if there is none
  std::function<Solution(const OneModeProblem&)> solve;
};

/// The solvers to compare with: a plain Numerov scheme and, if Boost was found at build time, Boost.Odeint
/// and (on a wedge without loss) Boost.Math's Bessel function.
std::vector<Solver> general_solvers(const OneModeProblem& problem);

/// The reference for errors: solves the same equation in extended precision, by a method that shares no code
/// with the library. Empty if this build has no Boost.
Solution reference_solution(const OneModeProblem& problem);

}  // namespace turnpoint::benchmark

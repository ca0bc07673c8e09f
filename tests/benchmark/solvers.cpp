#include "tests/benchmark/solvers.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#ifdef TURNPOINT_BOOST_PEERS
#include <boost/math/special_functions/bessel.hpp>
#include <boost/numeric/odeint.hpp>
#endif

namespace turnpoint::benchmark {

double OneModeProblem::half_width_m(double x) const {
  return wedge() ? w0 - slope * x : w0 * std::exp(-x / decay_m);
}

double OneModeProblem::width_slope(double x) const { return wedge() ? -slope : -half_width_m(x) / decay_m; }

double OneModeProblem::bessel_order() const { return std::sqrt(b / (slope * slope) + c + 0.25); }

namespace {

using Complex = std::complex<double>;

Complex potential(const OneModeProblem& p, double x) {
  const double w = p.half_width_m(x), w1 = p.width_slope(x);
  return p.k_squared - (p.b + p.c * w1 * w1) / (w * w);
}

/// Starting point of a solver: the point beyond the turning point where the mode has decayed by e^-36, or the
/// end of the surface if that comes first.
struct Start {
  double x_m = 0;
  bool held = false;  ///< true if the start is the end of the surface, where g = 0
};

Start start_of(const OneModeProblem& p) {
  const double last = p.wedge() ? p.length_m * (1 - 1e-9) : p.length_m;
  const double step = 2.5e-3 * p.length_m;
  double ln = 0, x = 0;
  for (; x < last; x += step) {
    const double q = potential(p, x).real();
    ln = q < 0 ? ln + step * std::sqrt(-q) : 0;
    if (ln > 36) return {x, false};
  }
  return {p.length_m, true};
}

constexpr double small = 1e-16;

/// Returns the value and slope of g (see OneModeProblem) at the start. The slope is taken in the direction of
/// the drive edge.
std::array<Complex, 2> start_values(const OneModeProblem& p, const Start& start) {
  if (start.held) return {0.0, small / p.length_m};
  return {small, small * std::sqrt(-potential(p, start.x_m))};
}

/// Numerov's scheme from the start to the drive edge. Between two steps, a cubic polynomial interpolates the
/// values and second derivatives; its error has the same order as the scheme's.
Solution numerov(const OneModeProblem& p, int n) {
  const Start start = start_of(p);
  const double h = start.x_m / n, c = h * h / 12;
  const auto at = [&](int i) { return start.x_m - i * h; };
  const auto q = [&](int i) { return potential(p, std::max(0.0, at(i))); };
  const auto first = start_values(p, start);
  std::vector<Complex> g{first[0], first[0] * std::cosh(h * std::sqrt(-q(0))) + first[1] * h};
  if (!start.held) g[1] = first[0] * std::exp(h * std::sqrt(-q(0)));
  for (int i = 1; i <= n; ++i)
    g.push_back((2.0 * (1.0 - 5 * c * q(i)) * g[static_cast<std::size_t>(i)] -
                 (1.0 + c * q(i - 1)) * g[static_cast<std::size_t>(i - 1)]) /
                (1.0 + c * q(i + 1)));
  Solution v;
  for (const double x : p.x_m) {
    if (x > start.x_m) {
      v.emplace_back(0);
      continue;
    }
    const double place = std::clamp((start.x_m - x) / h, 0.0, static_cast<double>(n));
    const auto i = std::min(static_cast<int>(place), n - 1);
    const double t = place - i;
    const Complex left = g[static_cast<std::size_t>(i)], right = g[static_cast<std::size_t>(i) + 1];
    const Complex bend = h * h / 6 * t * (1 - t) * ((2 - t) * q(i) * left + (1 + t) * q(i + 1) * right);
    v.push_back(((1 - t) * left + t * right + bend) / std::sqrt(p.half_width_m(x)));
  }
  return v;
}

#ifdef TURNPOINT_BOOST_PEERS
namespace ode = boost::numeric::odeint;

/// The one-mode equation as a real first-order system in the distance from the start: two unknowns without
/// loss, four with loss.
template <class Real, std::size_t size>
struct System {
  using State = std::array<Real, size>;
  const OneModeProblem& p;
  Real from;

  void operator()(const State& y, State& dy, Real u) const {
    const Real x = from - u;
    const Real w = p.wedge() ? Real(p.w0) - Real(p.slope) * x : Real(p.w0) * std::exp(-x / Real(p.decay_m));
    const Real w1 = p.wedge() ? Real(p.slope) : w / Real(p.decay_m);
    const Real side = (Real(p.b) + Real(p.c) * w1 * w1) / (w * w);
    const Real re = Real(p.k_squared.real()) - side;
    if constexpr (size == 2) {
      dy = {y[1], -re * y[0]};
    } else {
      const Real im = p.k_squared.imag();
      dy = {y[2], y[3], -re * y[0] + im * y[1], -re * y[1] - im * y[0]};
    }
  }
};

template <class Real, std::size_t size, class Stepper>
Solution integrate(const OneModeProblem& p, Stepper stepper) {
  const Start start = start_of(p);
  const auto first = start_values(p, start);
  typename System<Real, size>::State y{};
  if constexpr (size == 2) {
    y = {first[0].real(), first[1].real()};
  } else {
    y = {first[0].real(), first[0].imag(), first[1].real(), first[1].imag()};
  }
  std::vector<Real> times{0};
  std::vector<std::size_t> points;
  for (std::size_t i = p.x_m.size(); i-- > 0;) {
    if (p.x_m[i] >= start.x_m) continue;
    times.push_back(Real(start.x_m) - Real(p.x_m[i]));
    points.push_back(i);
  }
  Solution v(p.x_m.size());
  std::size_t next = 0;
  const System<Real, size> system{p, Real(start.x_m)};
  ode::integrate_times(
      stepper, system, y, times.begin(), times.end(), Real(1e-5), [&](const auto& state, Real) {
        if (next++ == 0) return;  // skip the value at the start, which is not one of the wanted points
        const std::size_t i = points[next - 2];
        const Complex g(static_cast<double>(state[0]), size == 4 ? static_cast<double>(state[1]) : 0.0);
        v[i] = g / std::sqrt(p.half_width_m(p.x_m[i]));
      });
  return v;
}

template <std::size_t size>
Solution dopri5(const OneModeProblem& p, double tolerance) {
  using State = std::array<double, size>;
  return integrate<double, size>(
      p, ode::make_dense_output(tolerance * small, tolerance, ode::runge_kutta_dopri5<State>()));
}

template <std::size_t size>
Solution bulirsch_stoer(const OneModeProblem& p, double tolerance) {
  using State = std::array<double, size>;
  return integrate<double, size>(p, ode::bulirsch_stoer_dense_out<State>(tolerance * small, tolerance));
}

template <std::size_t size>
void add_odeint(std::vector<Solver>& all) {
  for (const double tolerance : {1e-4, 1e-7, 1e-10})
    all.push_back({"Boost.Odeint dopri5", fmt::format("{:.0e}", tolerance),
                   [tolerance](const OneModeProblem& p) { return dopri5<size>(p, tolerance); }});
  for (const double tolerance : {1e-6, 1e-9, 1e-12})
    all.push_back({"Boost.Odeint bulirsch-stoer", fmt::format("{:.0e}", tolerance),
                   [tolerance](const OneModeProblem& p) { return bulirsch_stoer<size>(p, tolerance); }});
}

Solution bessel(const OneModeProblem& p) {
  Solution v;
  const double order = p.bessel_order(), k = std::sqrt(p.k_squared.real()), apex = p.w0 / p.slope;
  for (const double x : p.x_m) v.emplace_back(boost::math::cyl_bessel_j(order, k * std::max(0.0, apex - x)));
  return v;
}
#endif

}  // namespace

std::vector<Solver> general_solvers(const OneModeProblem& problem) {
  std::vector<Solver> all;
  for (const int steps : {1000, 4000, 16000})
    all.push_back({"Numerov", fmt::format("{} steps", steps),
                   [steps](const OneModeProblem& p) { return numerov(p, steps); }});
#ifdef TURNPOINT_BOOST_PEERS
  const bool lossless = problem.k_squared.imag() == 0;
  lossless ? add_odeint<2>(all) : add_odeint<4>(all);
  if (lossless && problem.wedge()) all.push_back({"Boost.Math cyl_bessel_j", "", bessel});
#else
  (void)problem;
#endif
  return all;
}

Solution reference_solution(const OneModeProblem& problem) {
#ifdef TURNPOINT_BOOST_PEERS
  using State = std::array<long double, 4>;
  using Stepper = ode::runge_kutta_fehlberg78<State, long double>;
  constexpr long double tolerance = 1e-17L;
  return integrate<long double, 4>(problem,
                                   ode::make_controlled<Stepper>(tolerance * small, tolerance, Stepper()));
#else
  (void)problem;
  return {};
#endif
}

}  // namespace turnpoint::benchmark

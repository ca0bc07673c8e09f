#include "physics/bench_peers.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#ifdef TURNPOINT_BOOST_PEERS
#include <boost/math/special_functions/bessel.hpp>
#include <boost/numeric/odeint.hpp>
#endif

namespace turnpoint::physics {
namespace {

double potential(const PeerProblem& p, double s) {
  return p.k_per_m * p.k_per_m - (p.mu * p.mu - 0.25) / (s * s);
}

// Where the mode has fallen by e^-18 beyond its turning point: general solvers start there.
double start(const PeerProblem& p) {
  double s = p.mu / p.k_per_m, ln = 0;
  const double step = 1e-3 * s;
  while (ln < 18 && s > 2 * step) {
    s -= step;
    ln += step * std::sqrt(std::max(0.0, -potential(p, s)));
  }
  return s;
}

// Numerov with as many steps as points, values joined by the nearest step.
std::vector<double> numerov(const PeerProblem& p) {
  const double s0 = start(p), s1 = p.s_m.front();
  const int n = static_cast<int>(p.s_m.size());
  const double h = (s1 - s0) / n, c = h * h / 12;
  std::vector<double> g{1e-8, 1e-8 * std::exp(h * std::sqrt(std::abs(potential(p, s0))))};
  for (int i = 1; i < n; ++i) {
    const double s = s0 + i * h;
    const double next = 2 * (1 - 5 * c * potential(p, s)) * g[static_cast<std::size_t>(i)] -
                        (1 + c * potential(p, s - h)) * g[static_cast<std::size_t>(i - 1)];
    g.push_back(next / (1 + c * potential(p, s + h)));
  }
  std::vector<double> v;
  for (const double s : p.s_m) {
    const double at = std::clamp((s - s0) / h, 0.0, static_cast<double>(n));
    const auto i = std::min(static_cast<std::size_t>(at), g.size() - 2);
    const double t = at - static_cast<double>(i);
    const double left = g[i], right = g[i + 1];
    // Cubic through the values and the equation's own second derivatives.
    const double bend =
        -h * h / 6 * t * (1 - t) *
        ((2 - t) * -potential(p, s0 + at * h) * left + (1 + t) * -potential(p, s0 + at * h) * right);
    v.push_back(s < s0 ? 0 : ((1 - t) * left + t * right + bend) / std::sqrt(s));
  }
  return v;
}

#ifdef TURNPOINT_BOOST_PEERS
std::vector<double> boost_bessel(const PeerProblem& p) {
  std::vector<double> v;
  for (const double s : p.s_m) v.push_back(boost::math::cyl_bessel_j(p.mu, p.k_per_m * s));
  return v;
}

std::vector<double> boost_odeint(const PeerProblem& p, double tolerance) {
  using State = std::array<double, 2>;
  namespace ode = boost::numeric::odeint;
  const double s0 = start(p);
  std::vector<double> times{s0}, v(p.s_m.size(), 0.0);
  for (auto s = p.s_m.rbegin(); s != p.s_m.rend(); ++s) {
    if (*s > s0) times.push_back(*s);
  }
  State y{1e-8, 1e-8 * std::sqrt(std::abs(potential(p, s0)))};
  const auto system = [&p](const State& x, State& dx, double s) {
    dx[0] = x[1];
    dx[1] = -potential(p, s) * x[0];
  };
  std::vector<double> values;
  const auto stepper = ode::make_dense_output(tolerance * 1e-8, tolerance, ode::runge_kutta_dopri5<State>());
  ode::integrate_times(stepper, system, y, times.begin(), times.end(), 1e-4,
                       [&values](const State& x, double s) { values.push_back(x[0] / std::sqrt(s)); });
  // values[0] belongs to the start itself; the rest run from the tip to the drive edge.
  for (std::size_t i = 1; i < values.size(); ++i) v[values.size() - 1 - i] = values[i];
  return v;
}
#endif

}  // namespace

std::vector<Peer> peers() {
  std::vector<Peer> all{{"Numerov, a step a point", numerov}};
#ifdef TURNPOINT_BOOST_PEERS
  all.push_back({"Boost.Math cyl_bessel_j", boost_bessel});
  all.push_back({"Boost.Odeint dopri5 1e-6", [](const PeerProblem& p) { return boost_odeint(p, 1e-6); }});
  all.push_back({"Boost.Odeint dopri5 1e-10", [](const PeerProblem& p) { return boost_odeint(p, 1e-10); }});
#endif
  return all;
}

}  // namespace turnpoint::physics

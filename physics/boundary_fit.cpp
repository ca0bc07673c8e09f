#include "physics/boundary_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "physics/boundary_budget.hpp"
#include "physics/edge_feature.hpp"
#include "physics/gate.hpp"
#include "physics/statement.hpp"

namespace turnpoint::physics {
namespace {

// The data of one fit. The fit divides parameters by their prior standard deviations, and boundaries by the
// standard deviations of their measurement.
struct Problem {
  const Surface& surface;
  const MapOptions& options;
  std::span<const MeasuredBoundary> measured;
  std::vector<Parameter> unknown = {};

  Surface moved(const Eigen::VectorXd& u) const {
    Surface s = surface;
    for (std::size_t j = 0; j < unknown.size(); ++j) {
      s = changed(std::move(s), unknown[j],
                  u(static_cast<Eigen::Index>(j)) * standard_deviation(surface, unknown[j]));
    }
    try {
      validate(s);
    } catch (const std::invalid_argument&) {
      throw impossible();
    }
    return s;
  }

  static Refused impossible() {
    return Refused(
        make_statement("boundary-fit",
                       "the measured boundaries lead to a surface that cannot exist; measure them again, "
                       "or correct the rig file"));
  }

  double boundary_m(const Surface& s, double f) const {
    const auto x = solve_edge_m(s, options, f, Model::edge, Wave::exact);
    if (x) return *x;
    throw Refused(make_statement("boundary-nowhere",
                                 "a boundary was measured at %1 Hz, but the surface has none there", {f}));
  }

  Eigen::VectorXd misses(const Eigen::VectorXd& u) const {
    const Surface s = moved(u);
    Eigen::VectorXd r(static_cast<Eigen::Index>(measured.size()));
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      const MeasuredBoundary& m = measured[static_cast<std::size_t>(i)];
      r(i) = (m.boundary_m - boundary_m(s, m.frequency_Hz)) / m.sd_m;
    }
    return r;
  }

  Eigen::MatrixXd jacobian(const Eigen::VectorXd& u, const Eigen::VectorXd& misses) const {
    const Surface s = moved(u);
    Eigen::MatrixXd jacobian(misses.size(), u.size());
    for (Eigen::Index i = 0; i < jacobian.rows(); ++i) {
      const MeasuredBoundary& m = measured[static_cast<std::size_t>(i)];
      for (Eigen::Index j = 0; j < jacobian.cols(); ++j) {
        const Parameter p = unknown[static_cast<std::size_t>(j)];
        jacobian(i, j) = standard_deviation(surface, p) / m.sd_m *
                         boundary_derivative(s, p, m.frequency_Hz, m.boundary_m - misses(i) * m.sd_m);
      }
    }
    return jacobian;
  }
};

// Values that may be measured. The fit divides by the precision, and a far smaller one would leave no digits.
constexpr double highest_Hz = 1e9, furthest_m = 1000, least_sd_m = 1e-9, largest_sd_m = 1;

void check(const MapOptions& options, std::span<const MeasuredBoundary> measured, const Problem& problem) {
  if (options.edge.kind == Edge::Kind::friction && !options.friction)
    throw std::invalid_argument("a friction edge needs a friction map and a displacement");
  if (measured.empty()) throw std::invalid_argument("there are no measured boundaries");
  for (const MeasuredBoundary& m : measured) {
    if (m.frequency_Hz > 0 && m.frequency_Hz <= highest_Hz && std::abs(m.boundary_m) <= furthest_m &&
        m.sd_m >= least_sd_m && m.sd_m <= largest_sd_m)
      continue;
    throw Refused(
        make_statement("measured-boundary",
                       "boundary at %1 m for %2 Hz, precise to %3 m; the position must be within "
                       "1000 m, the frequency above 0 and at most 1e9 Hz, the precision from 1e-9 to "
                       "1 m",
                       {m.boundary_m, m.frequency_Hz, m.sd_m}));
  }
  if (problem.unknown.empty())
    throw Refused(
        make_statement("nothing-uncertain",
                       "no parameter of the surface has a standard deviation, so nothing can be fitted"));
}

struct Solution {
  Eigen::VectorXd u, misses;
  Eigen::MatrixXd jacobian, covariance;
};

Solution solve(const Problem& problem) {
  constexpr double largest_step = 2, smallest_step = 1e-5;
  const auto n = static_cast<Eigen::Index>(problem.unknown.size());
  Solution s;
  s.u = Eigen::VectorXd::Zero(n);
  s.misses = problem.misses(s.u);
  for (int i = 0; i < 30; ++i) {
    s.jacobian = problem.jacobian(s.u, s.misses);
    const Eigen::MatrixXd information = s.jacobian.transpose() * s.jacobian + Eigen::MatrixXd::Identity(n, n);
    const Eigen::LLT<Eigen::MatrixXd> factors(information);
    s.covariance = factors.solve(Eigen::MatrixXd::Identity(n, n));
    Eigen::VectorXd step = factors.solve(s.jacobian.transpose() * s.misses - s.u);
    if (!step.allFinite() || !s.covariance.allFinite()) throw Problem::impossible();
    const double size = step.cwiseAbs().maxCoeff();
    if (size > largest_step) step *= largest_step / size;
    s.u += step;
    s.misses = problem.misses(s.u);
    if (size < smallest_step) break;
  }
  return s;
}

// `taken` marks the boundaries that must be removed so that no deviation exceeds the limit. `named` marks
// these and the boundaries that deviate almost as much.
struct Outliers {
  std::vector<bool> named, taken;
};

// Finds outliers. Repeatedly removes the boundary that deviates most from what the remaining boundaries
// predict, until no deviation exceeds the limit. Marks this boundary, and all others that deviate almost as
// much, as outliers.
Outliers find_outliers(const Solution& s) {
  constexpr double limit = 3, as_bad = 0.9;
  const Eigen::Index m = s.jacobian.rows(), n = s.jacobian.cols();
  // to first order, the deviations of the boundaries from what the unchanged parameters predict
  const Eigen::VectorXd free = s.misses + s.jacobian * s.u;
  std::vector<bool> named(static_cast<std::size_t>(m)), taken(static_cast<std::size_t>(m));
  for (Eigen::Index round = 0; round < m; ++round) {
    Eigen::MatrixXd information = Eigen::MatrixXd::Identity(n, n);
    Eigen::VectorXd pull = Eigen::VectorXd::Zero(n);
    for (Eigen::Index i = 0; i < m; ++i) {
      if (taken[static_cast<std::size_t>(i)]) continue;
      information += s.jacobian.row(i).transpose() * s.jacobian.row(i);
      pull += s.jacobian.row(i).transpose() * free(i);
    }
    const Eigen::MatrixXd covariance = information.llt().solve(Eigen::MatrixXd::Identity(n, n));
    const Eigen::VectorXd left = free - s.jacobian * (covariance * pull);
    const auto deviation = [&](Eigen::Index i) {
      if (taken[static_cast<std::size_t>(i)]) return 0.0;
      const double leverage = s.jacobian.row(i).dot(covariance * s.jacobian.row(i).transpose());
      return std::abs(left(i)) / std::sqrt(std::max(1e-12, 1 - leverage));
    };
    Eigen::Index worst = 0;
    for (Eigen::Index i = 1; i < m; ++i)
      if (deviation(i) > deviation(worst)) worst = i;
    const double most = deviation(worst);
    if (most <= limit) break;
    for (Eigen::Index i = 0; i < m; ++i)
      if (deviation(i) > std::max(limit, as_bad * most)) named[static_cast<std::size_t>(i)] = true;
    taken[static_cast<std::size_t>(worst)] = true;
  }
  return {named, taken};
}

}  // namespace

BoundaryFit fit_boundaries(const Surface& surface, const MapOptions& options,
                           std::span<const MeasuredBoundary> measured) {
  validate(surface);
  Problem problem{surface, options, measured};
  for (const Parameter p : parameters(surface))
    if (standard_deviation(surface, p) > 0 && p != Parameter::quality_factor) problem.unknown.push_back(p);
  validate(options.edge);
  check(options, measured, problem);
  for (const MeasuredBoundary& m : measured) validate(surface, m.frequency_Hz);
  Solution s = solve(problem);
  BoundaryFit fit;
  const Outliers outliers = find_outliers(s);
  fit.outliers = outliers.named;
  const bool any = std::find(fit.outliers.begin(), fit.outliers.end(), true) != fit.outliers.end();
  fit.left_out = any && outliers.named == outliers.taken;
  if (fit.left_out) {
    std::vector<MeasuredBoundary> kept;
    for (std::size_t i = 0; i < measured.size(); ++i)
      if (!fit.outliers[i]) kept.push_back(measured[i]);
    Problem without = problem;
    without.measured = kept;
    s = solve(without);
    s.misses = problem.misses(s.u);
    s.jacobian = problem.jacobian(s.u, s.misses);
  }
  for (std::size_t j = 0; j < problem.unknown.size(); ++j) {
    const Parameter p = problem.unknown[j];
    if (p == Parameter::temperature) continue;
    const auto at = static_cast<Eigen::Index>(j);
    const double prior = standard_deviation(surface, p);
    fit.parameters.push_back({p, s.u(at) * prior, std::sqrt(s.covariance(at, at)) * prior, prior});
    for (std::size_t k = 0; k < j; ++k) {
      if (problem.unknown[k] == Parameter::temperature) continue;
      const auto other = static_cast<Eigen::Index>(k);
      fit.correlations.push_back(
          {problem.unknown[k], p,
           s.covariance(at, other) / std::sqrt(s.covariance(at, at) * s.covariance(other, other))});
    }
  }
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double leverage = s.jacobian.row(at).dot(s.covariance * s.jacobian.row(at).transpose());
    fit.residuals_m.push_back(s.misses(at) * measured[i].sd_m);
    const bool out = fit.left_out && fit.outliers[i];
    fit.deviations.push_back(s.misses(at) / std::sqrt(std::max(1e-12, out ? 1 + leverage : 1 - leverage)));
  }
  return fit;
}

Surface with_fit(Surface surface, const std::vector<FittedParameter>& parameters,
                 const std::vector<Correlation>& correlations) {
  for (const FittedParameter& fitted : parameters) {
    surface = changed(std::move(surface), fitted.parameter, fitted.change);
    set_standard_deviation(surface, fitted.parameter, fitted.sd);
  }
  surface.correlations = correlations;
  return surface;
}

}  // namespace turnpoint::physics

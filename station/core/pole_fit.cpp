#include "station/core/pole_fit.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "station/core/texts.hpp"

namespace turnpoint::core {

namespace {

using PoleValue = std::complex<double>;
using PoleMatrix = Eigen::MatrixXcd;
using PoleVector = Eigen::VectorXcd;

constexpr int kRounds = 12;  // how often all poles are moved; they settle after about five rounds
constexpr int kSteps = 40;
constexpr int kBackground = 3;  // number of coefficients of the background, a parabola

/// Maps the frequencies to -1 ... 1, so that all columns of the fit's matrix have similar sizes.
struct PoleScale {
  double middle_Hz, half_Hz;
  double of(double frequency_Hz) const { return (frequency_Hz - middle_Hz) / half_Hz; }
};

/// Returns the matrix of the linear fit, one row for each x: 1 / (x - pole) for each pole, then 1, x, x^2.
PoleMatrix pole_columns(const Eigen::VectorXd& x, const PoleVector& poles) {
  PoleMatrix columns(x.size(), poles.size() + kBackground);
  for (Eigen::Index row = 0; row < x.size(); ++row) {
    for (Eigen::Index n = 0; n < poles.size(); ++n) columns(row, n) = 1.0 / (x(row) - poles(n));
    double power = 1;
    for (Eigen::Index k = 0; k < kBackground; ++k, power *= x(row)) columns(row, poles.size() + k) = power;
  }
  return columns;
}

/// One round of vector fitting. With the poles held fixed, fits response * (1 + sum of c / (x - pole)) by a
/// sum of the same form as the response. The zeros of the bracket are better estimates of the poles.
PoleVector better_poles(const Eigen::VectorXd& x, const PoleVector& response, const PoleVector& poles) {
  const auto n = poles.size();
  const PoleMatrix columns = pole_columns(x, poles);
  PoleMatrix all(x.size(), 2 * n + kBackground);
  all.leftCols(n + kBackground) = columns;
  for (Eigen::Index k = 0; k < n; ++k)
    all.col(n + kBackground + k) = -(response.array() * columns.col(k).array()).matrix();
  const PoleVector solution = all.householderQr().solve(response);
  PoleMatrix moved = poles.asDiagonal();
  moved.rowwise() -= solution.tail(n).transpose();
  PoleVector better = Eigen::ComplexEigenSolver<PoleMatrix>(moved, false).eigenvalues();
  // A pole with a negative imaginary part would mean a vibration that grows, which is impossible: mirror it.
  for (auto& pole : better) pole = {pole.real(), std::max(std::abs(pole.imag()), 1e-6)};
  return better;
}

struct PolesTried {
  PoleVector poles, weights, fitted;
  double residual = std::numeric_limits<double>::infinity();
};

PolesTried with_poles(const Eigen::VectorXd& x, const PoleVector& response, int count) {
  PoleVector poles(count);
  for (int k = 0; k < count; ++k) poles(k) = {-1 + (2.0 * k + 1) / count, 0.5 / count};
  PolesTried best;
  for (int round = 0; round < kRounds; ++round) {
    poles = better_poles(x, response, poles);
    const PoleMatrix columns = pole_columns(x, poles);
    const PoleVector weights = columns.householderQr().solve(response);
    const PoleVector fitted = columns * weights;
    const double residual =
        std::sqrt((response - fitted).squaredNorm() / static_cast<double>(response.size()));
    if (residual < best.residual) best = {poles, weights, fitted, residual};
  }
  return best;
}

/// Returns the derivatives of the fitted response with respect to all parameters: weights, background, poles.
PoleMatrix pole_slopes(const Eigen::VectorXd& x, const PolesTried& at) {
  const auto n = at.poles.size();
  PoleMatrix slopes(x.size(), 2 * n + kBackground);
  slopes.leftCols(n + kBackground) = pole_columns(x, at.poles);
  for (Eigen::Index k = 0; k < n; ++k)
    slopes.col(n + kBackground + k) =
        at.weights(k) * (slopes.col(k).array() * slopes.col(k).array()).matrix();
  return slopes;
}

/// Moves the poles to where the residual is smallest. (Vector fitting alone minimises a residual that is
/// weighted by the distance from the poles, so noise shifts the poles.) Damps the steps as Levenberg and
/// Marquardt do.
PolesTried refined(const Eigen::VectorXd& x, const PoleVector& response, PolesTried best) {
  double damping = 1e-3;
  for (int step = 0; step < kSteps && damping < 1e6; ++step) {
    const PoleMatrix slopes = pole_slopes(x, best);
    PoleMatrix normal = slopes.adjoint() * slopes;
    normal.diagonal() += damping * normal.diagonal();
    const PoleVector change = normal.ldlt().solve(slopes.adjoint() * (response - best.fitted));
    PolesTried tried;
    tried.poles = best.poles + change.tail(best.poles.size());
    for (auto& pole : tried.poles) pole = {pole.real(), std::max(std::abs(pole.imag()), 1e-6)};
    const PoleMatrix columns = pole_columns(x, tried.poles);
    tried.weights = columns.householderQr().solve(response);
    tried.fitted = columns * tried.weights;
    tried.residual =
        std::sqrt((response - tried.fitted).squaredNorm() / static_cast<double>(response.size()));
    const bool better = tried.residual < best.residual;
    damping *= better ? 0.1 : 10;
    if (!better) continue;
    const bool settled = tried.residual > (1 - 1e-6) * best.residual;
    best = std::move(tried);
    if (settled) break;
  }
  return best;
}

/// Makes the result, with standard errors computed from the derivatives with respect to all parameters.
PoleFit with_errors(const Eigen::VectorXd& x, const PolesTried& best, double noise, const PoleScale& scale) {
  const auto n = best.poles.size();
  const PoleMatrix slopes = pole_slopes(x, best);
  const double points = static_cast<double>(x.size()), free = points - static_cast<double>(slopes.cols());
  const double sd = std::max(noise, best.residual * std::sqrt(points / std::max(free, 1.0)));
  // two poles that describe the same resonance have nearly equal columns, so use a decomposition that
  // determines the rank
  const PoleMatrix inverse = slopes.completeOrthogonalDecomposition().pseudoInverse();
  PoleFit fit;
  fit.residual = best.residual;
  const auto error = [&](Eigen::Index row) { return sd * inverse.row(row).norm(); };
  for (Eigen::Index k = 0; k < n; ++k) {
    FittedPole pole;
    const double root_half = std::sqrt(0.5), wide_Hz = best.poles(k).imag() * scale.half_Hz;
    pole.frequency_Hz = scale.middle_Hz + best.poles(k).real() * scale.half_Hz;
    pole.frequency_sd_Hz = root_half * error(n + kBackground + k) * scale.half_Hz;
    pole.quality_factor = pole.frequency_Hz / (2 * wide_Hz);
    pole.quality_sd = pole.quality_factor * pole.frequency_sd_Hz / wide_Hz;
    pole.weight = best.weights(k) * scale.half_Hz;
    pole.weight_share = error(k) / std::abs(best.weights(k));
    fit.poles.push_back(pole);
  }
  std::sort(fit.poles.begin(), fit.poles.end(),
            [](const FittedPole& a, const FittedPole& b) { return a.frequency_Hz < b.frequency_Hz; });
  const PoleMatrix hat = slopes * inverse;
  for (Eigen::Index row = 0; row < x.size(); ++row) {
    fit.fitted.push_back(best.fitted(row));
    fit.fitted_sd.push_back(sd * std::sqrt(std::max(0.0, hat(row, row).real())));
  }
  return fit;
}

/// Returns two fits: the one whose number of poles the Bayesian information criterion prefers, and one with
/// the next larger number (or the next smaller one, if no larger number was tried). The first fit whose
/// residual is as small as the noise is not good enough: the part of the response that it misses is similar
/// at many neighbouring frequencies, so it shifts the poles by more than their standard errors.
std::pair<PolesTried, PolesTried> best_of(const Eigen::VectorXd& x, const PoleVector& response,
                                          int most_poles) {
  const double points = static_cast<double>(x.size());
  std::vector<PolesTried> tried;
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int count = 2; count <= most_poles && tried.size() < best + 3; count += 2) {
    tried.push_back(refined(x, response, with_poles(x, response, count)));
    const double criterion =
        4 * points * std::log(std::max(tried.back().residual, 1e-300)) + 4 * count * std::log(2 * points);
    if (criterion < least) least = criterion, best = tried.size() - 1;
  }
  const auto other = best + 1 < tried.size() ? best + 1 : best - (best > 0 ? 1 : 0);
  return {tried[best], tried[other]};
}

/// Increases the standard errors by the distance that each pole moves if the number of poles is chosen
/// differently.
void add_choice(PoleFit& fit, const PoleFit& other) {
  for (auto& pole : fit.poles) {
    const auto nearest = std::min_element(
        other.poles.begin(), other.poles.end(), [&](const FittedPole& a, const FittedPole& b) {
          return std::abs(a.frequency_Hz - pole.frequency_Hz) < std::abs(b.frequency_Hz - pole.frequency_Hz);
        });
    pole.frequency_sd_Hz = std::hypot(pole.frequency_sd_Hz, nearest->frequency_Hz - pole.frequency_Hz);
    pole.quality_sd = std::hypot(pole.quality_sd, nearest->quality_factor - pole.quality_factor);
  }
}

}  // namespace

std::vector<FittedPole> PoleFit::resonances() const {
  constexpr double quality_share = 0.25, weight_share = 0.1;
  std::vector<FittedPole> found;
  for (const FittedPole& pole : poles)
    if (pole.quality_sd < quality_share * pole.quality_factor && pole.weight_share < weight_share)
      found.push_back(pole);
  return found;
}

PoleFit fit_poles(std::span<const double> frequency_Hz, std::span<const std::complex<double>> response,
                  double noise, int most_poles) {
  constexpr std::size_t least = 20;
  if (frequency_Hz.size() < least || frequency_Hz.size() != response.size())
    throw Refusal(core::phrase("fitted.few_frequencies", {core::plain(least)}));
  const PoleScale scale{0.5 * (frequency_Hz.front() + frequency_Hz.back()),
                        0.5 * (frequency_Hz.back() - frequency_Hz.front())};
  Eigen::VectorXd x(static_cast<Eigen::Index>(frequency_Hz.size()));
  PoleVector wanted(x.size());
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    x(k) = scale.of(frequency_Hz[static_cast<std::size_t>(k)]);
    wanted(k) = response[static_cast<std::size_t>(k)];
  }
  most_poles = std::min(most_poles, static_cast<int>(frequency_Hz.size() - kBackground) / 3);
  const auto [best, next] = best_of(x, wanted, most_poles);
  auto fit = with_errors(x, best, noise, scale);
  add_choice(fit, with_errors(x, next, noise, scale));
  std::erase_if(fit.poles, [&](const FittedPole& pole) {
    return pole.frequency_Hz < frequency_Hz.front() || pole.frequency_Hz > frequency_Hz.back();
  });
  return fit;
}

}  // namespace turnpoint::core

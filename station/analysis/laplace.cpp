#include "station/analysis/laplace.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "station/analysis/likelihood.hpp"

namespace turnpoint::analysis {

namespace {

using Matrix5 = Eigen::Matrix<double, 5, 5>;

constexpr int kClimbs = 60, kDescents = 200, kNewtonSteps = 6;
constexpr double kDifference = 1e-4;  ///< step of central differences; theta is of the order of 1

double step_of(double value) { return kDifference * std::max(1.0, std::fabs(value)); }

MixedTheta gradient_of(Laplace& laplace, const MixedTheta& theta) {
  MixedTheta gradient;
  for (int i = 0; i < 5; ++i) {
    const double step = step_of(theta[i]);
    MixedTheta above = theta, below = theta;
    above[i] += step, below[i] -= step;
    gradient[i] = (laplace.negative_log(above) - laplace.negative_log(below)) / (2 * step);
  }
  return gradient;
}

/// Computes second derivatives by differences. The step is ten times as long as that of gradient_of(),
/// because second differences divide rounding errors by the square of the step.
Matrix5 hessian_of(Laplace& laplace, const MixedTheta& theta, double centre) {
  Matrix5 hessian;
  const auto at = [&](int i, double di, int j, double dj) {
    MixedTheta moved = theta;
    moved[i] += di, moved[j] += dj;
    return laplace.negative_log(moved);
  };
  for (int i = 0; i < 5; ++i) {
    const double hi = 10 * step_of(theta[i]);
    hessian(i, i) = (at(i, hi, i, 0) - 2 * centre + at(i, -hi, i, 0)) / (hi * hi);
    for (int j = 0; j < i; ++j) {
      const double hj = 10 * step_of(theta[j]);
      hessian(i, j) = hessian(j, i) =
          (at(i, hi, j, hj) - at(i, hi, j, -hj) - at(i, -hi, j, hj) + at(i, -hi, j, -hj)) / (4 * hi * hj);
    }
  }
  return hessian;
}

/// Line search that halves the step: returns the first point tried along `direction` at which the value is
/// low enough, or the start itself if there is none.
std::pair<MixedTheta, double> descend(Laplace& laplace, const MixedTheta& start, double value,
                                      const MixedTheta& direction, double slope) {
  for (double length = 1; length > 1e-8; length /= 2) {
    const MixedTheta moved = start + length * direction;
    const double there = laplace.negative_log(moved);
    if (std::isfinite(there) && there < value + 1e-4 * length * slope) return {moved, there};
  }
  return {start, value};
}

}  // namespace

Laplace::Local Laplace::local(const PersonAxis& person, const Eigen::Vector2d& coefficients) const {
  Local sum;
  const double range = 1 - person.guess - lapse_;
  for (std::size_t i = 0; i < person.x.size(); ++i) {
    const double z = coefficients[0] + coefficients[1] * person.x[i];
    const double p =
        std::clamp(person.guess + range * sigmoid(function_, z), kProbabilityFloor, 1 - kProbabilityFloor);
    const double slope = range * sigmoid_derivative(function_, z);
    const double n = person.trials[i], k = person.positive[i];
    sum.log_likelihood += k * std::log(p) + (n - k) * std::log1p(-p);
    const Eigen::Vector2d row(1, person.x[i]);
    sum.gradient += (k - n * p) / (p * (1 - p)) * slope * row;
    sum.information += n * slope * slope / (p * (1 - p)) * row * row.transpose();
  }
  return sum;
}

Laplace::Local Laplace::climb(std::size_t index, const MixedTheta& theta) {
  const Eigen::Vector2d fixed = theta.head<2>();
  const Eigen::Matrix2d factor = random_factor(theta);
  auto& mode = mode_[index];
  const auto value = [](const Local& at, const Eigen::Vector2d& v) {
    return at.log_likelihood - v.squaredNorm() / 2;
  };
  auto at = local(people_[index], fixed + factor * mode);
  for (int i = 0; i < kClimbs; ++i) {
    const Eigen::Vector2d gradient = factor.transpose() * at.gradient - mode;
    const Eigen::Matrix2d curvature =
        factor.transpose() * at.information * factor + Eigen::Matrix2d::Identity();
    const Eigen::Vector2d step = curvature.llt().solve(gradient);
    if (gradient.dot(step) < 1e-20) break;
    double length = 1;
    for (; length > 1e-6; length /= 2) {
      const Eigen::Vector2d moved = mode + length * step;
      const auto there = local(people_[index], fixed + factor * moved);
      if (value(there, moved) < value(at, mode)) continue;
      mode = moved, at = there;
      break;
    }
    if (length <= 1e-6) break;
  }
  return at;
}

double Laplace::negative_log(const MixedTheta& theta) {
  const Eigen::Matrix2d factor = random_factor(theta);
  double sum = 0;
  for (std::size_t i = 0; i < people_.size(); ++i) {
    const auto at = climb(i, theta);
    const Eigen::Matrix2d curvature =
        factor.transpose() * at.information * factor + Eigen::Matrix2d::Identity();
    sum -= at.log_likelihood - mode_[i].squaredNorm() / 2 - std::log(curvature.determinant()) / 2;
  }
  return sum;
}

Laplace::Person Laplace::person(std::size_t index, const MixedTheta& theta) {
  const auto at = climb(index, theta);
  return {mode_[index], at.information};
}

MixedMinimum minimise(Laplace& laplace, const MixedTheta& start) {
  MixedMinimum best{start, laplace.negative_log(start), Matrix5::Identity()};
  Matrix5 inverse = Matrix5::Identity() * 0.01;
  auto gradient = gradient_of(laplace, best.theta);
  for (int i = 0; i < kDescents; ++i) {
    MixedTheta direction = -inverse * gradient;
    if (direction.norm() > 1) direction /= direction.norm();  // the quadratic model fails for longer steps
    const double slope = gradient.dot(direction);
    if (!(slope < -1e-12)) break;
    const auto [moved, value] = descend(laplace, best.theta, best.negative_log, direction, slope);
    const MixedTheta step = moved - best.theta;
    const double gain = best.negative_log - value;
    best.theta = moved, best.negative_log = value;
    if (gain < 1e-11) break;
    const auto next = gradient_of(laplace, moved);
    const MixedTheta change = next - gradient;
    gradient = next;
    const double curvature = step.dot(change);
    if (curvature <= 1e-14) continue;
    const Matrix5 left = Matrix5::Identity() - step * change.transpose() / curvature;
    inverse = left * inverse * left.transpose() + step * step.transpose() / curvature;
  }
  best.hessian = hessian_of(laplace, best.theta, best.negative_log);
  for (int i = 0; i < kNewtonSteps; ++i) {
    const Eigen::LLT<Matrix5> solver(best.hessian);
    if (solver.info() != Eigen::Success) break;
    gradient = gradient_of(laplace, best.theta);
    const MixedTheta direction = -solver.solve(gradient);
    const auto [moved, value] =
        descend(laplace, best.theta, best.negative_log, direction, gradient.dot(direction));
    const double gain = best.negative_log - value;
    best.theta = moved, best.negative_log = value;
    if (gain < 1e-10) break;
    best.hessian = hessian_of(laplace, best.theta, best.negative_log);
  }
  return best;
}

}  // namespace turnpoint::analysis

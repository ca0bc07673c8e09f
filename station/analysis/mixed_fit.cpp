#include "station/analysis/mixed_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <map>
#include <stdexcept>

#include "station/analysis/fit_bounds.hpp"
#include "station/analysis/laplace.hpp"
#include "station/core/draws.hpp"
#include "station/core/number.hpp"

namespace turnpoint::analysis {

namespace {

constexpr std::size_t kFewestPeople = 3;
constexpr double kNormal975 = 1.959963984540054;
/// A random effect counts as absent if its standard deviation is below this value, on an axis whose levels
/// have the standard deviation 1.
constexpr double kNoVariance = 1e-3;

/// The data on an axis that is centred and scaled, so that all parameters are of the order of 1.
struct Scaled {
  std::vector<PersonAxis> people;
  std::vector<std::string> names;
  std::vector<int> trials;
  std::vector<LevelCount> pooled;
  double centre = 0, width = 1;
};

Scaled scaled(const std::vector<PersonCounts>& data, const MixedOptions& options) {
  Scaled all;
  double n = 0, sum = 0, squares = 0;
  for (const auto& person : data) {
    PersonAxis axis;
    axis.guess = person.guess;
    int trials = 0;
    for (const auto& point : person.counts) {
      if (point.level == kNoise || point.trials == 0) continue;
      axis.x.push_back(axis_position(options.function, options.scale, point.level));
      axis.trials.push_back(person.weight * point.trials);
      axis.positive.push_back(person.weight * point.sum());
      trials += point.trials;
      n += point.trials, sum += point.trials * axis.x.back();
      squares += point.trials * axis.x.back() * axis.x.back();
      all.pooled.push_back(point);
    }
    if (trials == 0) continue;
    all.people.push_back(std::move(axis)), all.names.push_back(person.person), all.trials.push_back(trials);
  }
  if (n == 0) return all;
  all.centre = sum / n;
  const double variance = squares / n - all.centre * all.centre;
  all.width = variance > 0 ? std::sqrt(variance) : 1;
  for (auto& person : all.people)
    for (auto& x : person.x) x = (x - all.centre) / all.width;
  return all;
}

/// The fit to the answers of all participants together, from which the search begins.
PsychometricFit together(const Scaled& data, const MixedOptions& options) {
  FitOptions pooled;
  pooled.function = options.function, pooled.scale = options.scale;
  pooled.lapse_low = options.lapse_low, pooled.lapse_high = options.lapse_high;
  double guess = 0;
  for (const auto& person : data.people) guess += person.guess / static_cast<double>(data.people.size());
  pooled.guess_value = guess;
  if (options.tied_to_lapse) pooled.guess = Guess::tied_to_lapse;
  return fit_psychometric(data.pooled, pooled);
}

MixedMinimum fit_at(double lapse, Scaled& data, const MixedOptions& options, const MixedTheta& start) {
  if (options.tied_to_lapse)
    for (auto& person : data.people) person.guess = lapse;
  Laplace laplace(options.function, lapse, data.people);
  return minimise(laplace, start);
}

/// Finds the lapse rate at which the likelihood is highest, and the best other parameters at this lapse rate.
std::pair<double, MixedMinimum> fit_all(Scaled& data, const MixedOptions& options, const MixedTheta& start) {
  double lapse = options.lapse_low;
  auto best = fit_at(lapse, data, options, start);
  if (options.lapse_high <= options.lapse_low) return {lapse, best};
  MixedTheta from = best.theta;
  const auto value = [&](double at) {
    const auto found = fit_at(at, data, options, from);
    if (found.negative_log < best.negative_log) best = found, lapse = at;
    from = found.theta;
    return found.negative_log;
  };
  boost::uintmax_t most = 15;
  boost::math::tools::brent_find_minima(value, options.lapse_low, options.lapse_high, 12, most);
  return {lapse, best};
}

/// Returns the covariance of the fixed effects. A random effect whose variance is 0 is left out of the
/// information matrix, which would otherwise be singular.
std::optional<Eigen::Matrix2d> covariance_of(const MixedMinimum& found) {
  std::vector<int> kept{0, 1};
  const Eigen::Matrix2d factor = random_factor(found.theta);
  for (const int i : {2, 3, 4})
    if (std::fabs(found.theta[i]) > kNoVariance || (i == 3 && std::fabs(factor(0, 0)) > kNoVariance))
      kept.push_back(i);
  for (int attempt = 0; attempt < 2; ++attempt, kept.resize(2)) {
    const Eigen::MatrixXd information = found.hessian(kept, kept);
    const Eigen::LLT<Eigen::MatrixXd> solver(information);
    if (solver.info() != Eigen::Success) continue;
    const Eigen::MatrixXd inverse =
        solver.solve(Eigen::MatrixXd::Identity(information.rows(), information.cols()));
    return inverse.topLeftCorner<2, 2>();
  }
  return std::nullopt;
}

/// Returns the matrix that converts coefficients on the scaled axis to coefficients on the original axis: b0
/// = s0 - s1 centre / width, b1 = s1 / width.
Eigen::Matrix2d unscaling(const Scaled& data) {
  Eigen::Matrix2d map;
  map << 1, -data.centre / data.width, 0, 1 / data.width;
  return map;
}

/// Returns the threshold that follows from these coefficients, in the unit of the level, with the interval
/// that follows from their covariance.
std::optional<Estimate> threshold_of(const Eigen::Vector2d& b, const Eigen::Matrix2d& covariance, double t,
                                     const MixedOptions& options) {
  if (!(b[1] > 0)) return std::nullopt;
  const double u = -b[0] / b[1];
  const Eigen::Vector2d gradient(-1 / b[1], b[0] / (b[1] * b[1]));
  const double half = t * std::sqrt(gradient.dot(covariance * gradient));
  const auto level = [&options](double at) { return level_from_axis(options.function, options.scale, at); };
  return Estimate{level(u), {level(u - half), level(u + half), 0.95}};
}

Estimate slope_of(double rate, double error, double t, Function function) {
  const double factor = std::exp(t * error / rate);
  double low = slope_from_rate(function, rate / factor), high = slope_from_rate(function, rate * factor);
  if (low > high) std::swap(low, high);
  return {slope_from_rate(function, rate), {low, high, 0.95}};
}

/// One likely value of the parameters, and its weight among several (their sum is 1).
struct LikelyTheta {
  MixedTheta theta;
  double weight = 0;
};

/// Draws factors of the random effects' covariance from their likelihood, with the fixed effects at their
/// estimates and a flat prior: importance sampling from a t distribution around the maximum. A hessian that
/// says little, as at a variance of 0, is replaced by a scale from the size of the estimate.
std::vector<LikelyTheta> likely_factors(Laplace& laplace, const MixedMinimum& found) {
  constexpr int draws_wanted = 150, freedom = 4;
  core::Draws draws({1, core::Stream::bootstrap, 4000, 0, 0});
  const double size =
      std::max({std::fabs(found.theta[2]), std::fabs(found.theta[3]), std::fabs(found.theta[4]), 0.1});
  Eigen::Vector3d scale;
  for (int i = 0; i < 3; ++i) {
    const double curvature = found.hessian(i + 2, i + 2);
    scale[i] = 1.2 * std::min(size, curvature > 0 ? 1 / std::sqrt(curvature) : size);
  }
  std::vector<LikelyTheta> all;
  std::vector<double> log_weight;
  for (int d = 0; d < draws_wanted; ++d) {
    double chi2 = 0;
    for (int k = 0; k < freedom; ++k) {
      const double g = draws.normal();
      chi2 += g * g;
    }
    Eigen::Vector3d z;
    for (int i = 0; i < 3; ++i) z[i] = draws.normal();
    MixedTheta theta = found.theta;
    theta.tail<3>() += std::sqrt(freedom / chi2) * scale.cwiseProduct(z);
    const double log_proposal = -0.5 * (freedom + 3) * std::log1p(z.squaredNorm() / chi2);
    const double value = laplace.negative_log(theta);
    all.push_back({theta, 0});
    log_weight.push_back(std::isfinite(value) ? -value - log_proposal : -INFINITY);
  }
  const double most = *std::max_element(log_weight.begin(), log_weight.end());
  double sum = 0;
  for (std::size_t i = 0; i < all.size(); ++i) sum += all[i].weight = std::exp(log_weight[i] - most);
  for (auto& one : all) one.weight /= sum;
  return all;
}

void add_people(const Scaled& data, const MixedMinimum& found, const Eigen::Matrix2d& fixed_covariance,
                MixedFit& fit) {
  Laplace laplace(fit.options.function, fit.lapse, data.people);
  const Eigen::Matrix2d map = unscaling(data);
  struct Prediction {
    Eigen::Vector2d b;
    Eigen::Matrix2d covariance, remains;
  };
  const auto predicted = [&](std::size_t i, const MixedTheta& theta) {
    const Eigen::Matrix2d factor = random_factor(theta);
    const auto person = laplace.person(i, theta);
    const Eigen::Matrix2d inner =
        factor.transpose() * person.information * factor + Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d conditional = factor * inner.inverse() * factor.transpose();
    // the part of an error in the group's parameters that still affects this participant's estimate
    const Eigen::Matrix2d remains = Eigen::Matrix2d::Identity() - conditional * person.information;
    return Prediction{theta.head<2>() + factor * person.mode,
                      conditional + remains * fixed_covariance * remains.transpose(), remains};
  };
  const auto likely = likely_factors(laplace, found);
  laplace.negative_log(found.theta);
  std::vector<Prediction> best;
  for (std::size_t i = 0; i < data.people.size(); ++i) best.push_back(predicted(i, found.theta));
  std::vector<Eigen::Matrix2d> covariances(best.size(), Eigen::Matrix2d::Zero());
  for (const auto& [theta, weight] : likely) {
    if (!(weight > 1e-6)) continue;
    for (std::size_t i = 0; i < best.size(); ++i) {
      const auto one = predicted(i, theta);
      const Eigen::Vector2d apart = one.b - best[i].b;
      covariances[i] += weight * (one.covariance + apart * apart.transpose());
    }
  }
  for (std::size_t i = 0; i < data.people.size(); ++i) {
    const Eigen::Vector2d b = map * best[i].b;
    PooledPerson pooled;
    pooled.person = data.names[i], pooled.trials = data.trials[i];
    pooled.threshold = threshold_of(b, map * covariances[i] * map.transpose(), kNormal975, fit.options);
    if (pooled.threshold)
      pooled.parameters = {pooled.threshold->value, slope_from_rate(fit.options.function, b[1]),
                           data.people[i].guess, fit.lapse};
    pooled.shrinkage = best[i].remains.trace() / 2;
    fit.persons.push_back(std::move(pooled));
  }
}

void describe_group(const Scaled& data, const MixedMinimum& found, const Eigen::Matrix2d& fixed_covariance,
                    MixedFit& fit) {
  const Eigen::Matrix2d map = unscaling(data), factor = map * random_factor(found.theta);
  const Eigen::Matrix2d random = factor * factor.transpose();
  const Eigen::Matrix2d errors = map * fixed_covariance * map.transpose();
  const Eigen::Vector2d b = map * found.theta.head<2>();
  fit.intercept = b[0], fit.rate = b[1];
  fit.intercept_se = std::sqrt(errors(0, 0)), fit.rate_se = std::sqrt(errors(1, 1));
  fit.intercept_sd = std::sqrt(random(0, 0)), fit.rate_sd = std::sqrt(random(1, 1));
  if (fit.intercept_sd > 0 && fit.rate_sd > 0)
    fit.correlation = random(0, 1) / (fit.intercept_sd * fit.rate_sd);
  const double t =
      boost::math::quantile(boost::math::students_t(static_cast<double>(data.people.size()) - 1), 0.975);
  fit.threshold = threshold_of(b, errors, t, fit.options);
  if (!fit.threshold) {
    fit.statements.push_back({"group-does-not-rise", core::phrase("statement.group_falls")});
    return;
  }
  fit.slope = slope_of(b[1], fit.rate_se, t, fit.options.function);
  const Eigen::Vector2d gradient(-1 / b[1], b[0] / (b[1] * b[1]));
  const double sd = std::sqrt(gradient.dot(random * gradient));
  const auto level = [&fit](double u) { return level_from_axis(fit.options.function, fit.options.scale, u); };
  const double u = -b[0] / b[1];
  fit.threshold_sd = (level(u + sd) - level(u - sd)) / 2;
  const Eigen::Matrix2d scaled_random = random_factor(found.theta) * random_factor(found.theta).transpose();
  if (scaled_random.determinant() < kNoVariance * kNoVariance * scaled_random.trace())
    fit.statements.push_back({"singular", core::phrase("statement.singular")});
}

}  // namespace

MixedResult fit_mixed(const std::vector<PersonCounts>& data, const MixedOptions& options) {
  auto people = scaled(data, options);
  if (people.people.size() < kFewestPeople)
    return {std::nullopt,
            {{"few-participants",
              core::phrase("statement.few_participants", {core::plain(people.people.size())})}}};
  const auto pooled = together(people, options);
  if (!pooled.parameters) return {std::nullopt, pooled.statements};
  const double rate = rate_from_slope(options.function, pooled.parameters->slope) * people.width;
  const double at = axis_position(options.function, options.scale, pooled.parameters->threshold);
  MixedTheta start;
  start << -rate * (at - people.centre) / people.width, rate, 0.5, 0, 0.3 * std::min(rate, 3.0);
  MixedFit fit;
  fit.options = options;
  const auto [lapse, found] = fit_all(people, options, start);
  if (options.tied_to_lapse)
    for (auto& person : people.people) person.guess = lapse;
  fit.lapse = lapse, fit.log_likelihood = -found.negative_log;
  const auto covariance = covariance_of(found);
  if (!covariance || !std::isfinite(found.negative_log))
    return {std::nullopt, {{"not-determined", core::phrase("statement.group_undetermined")}}};
  describe_group(people, found, *covariance, fit);
  add_people(people, found, *covariance, fit);
  return {std::move(fit), {}};
}

}  // namespace turnpoint::analysis

#include "station/analysis/likelihood.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

namespace turnpoint::analysis {

namespace {

/// Computes one Fisher-scoring step: solves a x = b for the free parameters by Cholesky decomposition. Only
/// the lower half of `a` is read. Fixed parameters get a step of 0. Returns false if `a` is not positive
/// definite.
bool solve(const std::array<std::array<double, 4>, 4>& a, const std::array<double, 4>& b,
           const std::array<bool, 4>& free, std::array<double, 4>& x) {
  Eigen::Matrix4d system = Eigen::Matrix4d::Identity();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (int i = 0; i < 4; ++i) {
    if (!free[i]) continue;
    right(i) = b[i];
    for (int j = 0; j <= i; ++j)
      if (free[j]) system(i, j) = a[i][j];
  }
  const Eigen::LLT<Eigen::Matrix4d> factor(system);
  if (factor.info() != Eigen::Success || !factor.matrixLLT().allFinite())
    return false;  // also returns here if the matrix contains NaN
  Eigen::Map<Eigen::Vector4d>(x.data()) = factor.solve(right);
  return true;
}

}  // namespace

Theta Likelihood::project(Theta theta) const {
  for (int i = 0; i < 4; ++i) theta[i] = std::clamp(theta[i], bounds_.low[i], bounds_.high[i]);
  if (guess_ == Guess::tied_to_lapse) theta[3] = theta[2];
  return theta;
}

Likelihood::Anchor Likelihood::anchor(const Theta& theta) const {
  if (!anchor_) return {};
  const double height = 1 - theta[3] - theta[2];
  const double inside = std::clamp((*anchor_ - theta[3]) / height, kProbabilityFloor, 1 - kProbabilityFloor);
  const double z = sigmoid_inverse(function_, inside), slope = sigmoid_derivative(function_, z);
  return {z, inside / height / slope, (inside - 1) / height / slope};
}

double Likelihood::probability(const Theta& theta, const Anchor& at, double u) const {
  const double z = std::exp(theta[1]) * (u - theta[0]) + at.z;
  return std::clamp(theta[3] + (1 - theta[3] - theta[2]) * sigmoid(function_, z), kProbabilityFloor,
                    1 - kProbabilityFloor);
}

double Likelihood::negative_log(const Theta& theta) const {
  double sum = 0;
  const auto at = anchor(theta);
  for (std::size_t i = 0; i < counts_.u.size(); ++i) {
    const double p = probability(theta, at, counts_.u[i]);
    sum -= counts_.positive[i] * std::log(p) + (counts_.trials[i] - counts_.positive[i]) * std::log1p(-p);
  }
  return sum;
}

std::array<double, 4> Likelihood::gradient_of_probability(const Theta& theta, const Anchor& at,
                                                          double u) const {
  const double rate = std::exp(theta[1]), height = 1 - theta[3] - theta[2], from = rate * (u - theta[0]);
  const double f = sigmoid(function_, from + at.z), df = sigmoid_derivative(function_, from + at.z);
  // In trials without a signal, `from` is minus infinity. The derivative with respect to the rate is then 0.
  std::array<double, 4> dp{-height * df * rate, df > 0 ? height * df * from : 0,
                           -f + height * df * at.dz_dlapse, 1 - f + height * df * at.dz_dguess};
  if (guess_ == Guess::tied_to_lapse) dp[2] += dp[3], dp[3] = 0;
  return dp;
}

Likelihood::Local Likelihood::local(const Theta& theta) const {
  Local result{};
  const auto at = anchor(theta);
  for (std::size_t i = 0; i < counts_.u.size(); ++i) {
    const double p = probability(theta, at, counts_.u[i]);
    const double k = counts_.positive[i], n = counts_.trials[i], weight = n / (p * (1 - p));
    result.negative_log -= k * std::log(p) + (n - k) * std::log1p(-p);
    const auto dp = gradient_of_probability(theta, at, counts_.u[i]);
    for (int a = 0; a < 4; ++a) {
      result.gradient[a] -= (k / n - p) * weight * dp[a];
      for (int b = 0; b <= a; ++b) result.information[a][b] += weight * dp[a] * dp[b];
    }
  }
  return result;
}

Likelihood::Maximum Likelihood::climb(Theta start) const {
  Theta theta = project(start);
  Local here = local(theta);
  double damping = 1e-3;
  for (int iteration = 0; iteration < 200 && damping < 1e12; ++iteration) {
    std::array<bool, 4> free{};
    for (int i = 0; i < 4; ++i)
      free[i] = bounds_.low[i] < bounds_.high[i] && !(guess_ == Guess::tied_to_lapse && i == 3) &&
                !(theta[i] <= bounds_.low[i] && here.gradient[i] >= 0) &&
                !(theta[i] >= bounds_.high[i] && here.gradient[i] <= 0);
    auto system = here.information;
    std::array<double, 4> right{}, step{};
    for (int i = 0; i < 4; ++i) {
      system[i][i] += damping * system[i][i] + 1e-12;
      right[i] = -here.gradient[i];
    }
    if (!solve(system, right, free, step)) {
      damping *= 10;
      continue;
    }
    Theta next = theta;
    // Limit each step: the threshold moves by at most two units of 1 / rate, and the rate changes by at most
    // a factor of e.
    step[0] = std::clamp(step[0], -2 / std::exp(theta[1]), 2 / std::exp(theta[1]));
    step[1] = std::clamp(step[1], -1.0, 1.0);
    for (int i = 0; i < 4; ++i) next[i] += step[i];
    next = project(next);
    Local there = local(next);
    const double gain = here.negative_log - there.negative_log;
    if (gain < 0) {
      damping = std::max(damping * 10, 1e-6);
      continue;
    }
    double moved = 0;
    for (int i = 0; i < 4; ++i)
      moved = std::max(moved, std::abs(next[i] - theta[i]) * (i ? 1 : std::exp(theta[1])));
    theta = next;
    here = there;
    damping *= 0.1;
    if (moved < 1e-9) break;
  }
  return steepest({theta, here.negative_log});
}

Likelihood::Maximum Likelihood::steepest(const Maximum& found) const {
  // If the answers jump between two levels, all steeper functions fit equally well, and the climb ends at an
  // arbitrary slope. Return the upper bound of the slope in that case: callers take it as the sign of a step.
  // A threshold that is held stays where it is.
  std::vector<double> thresholds{found.theta[0]};
  for (std::size_t i = 1; i < counts_.u.size() && bounds_.low[0] < bounds_.high[0]; ++i)
    if (counts_.u[i - 1] != kNoise && counts_.u[i - 1] <= found.theta[0] && found.theta[0] <= counts_.u[i])
      thresholds.push_back((counts_.u[i - 1] + counts_.u[i]) / 2);
  for (const double threshold : thresholds) {
    Theta theta = found.theta;
    theta[0] = threshold;
    theta[1] = bounds_.high[1];
    const double cost = negative_log(theta);
    if (cost <= found.negative_log + 1e-4) return {theta, cost};
  }
  return found;
}

Likelihood::Maximum Likelihood::search() const {
  const auto values = [this](int parameter, std::initializer_list<double> shares) {
    const double low = bounds_.low[parameter], high = bounds_.high[parameter];
    std::vector<double> result;
    for (const double share : shares)
      if (result.empty() || low < high) result.push_back(low + share * (high - low));
    return result;
  };
  // A steep function has a maximum between each pair of levels, and a shallow one another.
  auto thresholds = values(0, {0.3, 0.42, 0.5, 0.58, 0.7});
  const bool held = thresholds.size() == 1;
  constexpr std::size_t most = 12;
  for (std::size_t i = 1; i < counts_.u.size() && counts_.u.size() <= most && !held; ++i)
    if (counts_.u[i - 1] != kNoise) thresholds.push_back((counts_.u[i - 1] + counts_.u[i]) / 2);
  const auto rates = values(1, {0.2, 0.35, 0.5, 0.65, 0.8, 0.95}), lapses = values(2, {0.1, 0.9});
  const auto guesses =
      guess_ == Guess::tied_to_lapse ? std::vector<double>{0} : values(3, {0.05, 0.2, 0.4, 0.6, 0.8});
  // the best start with each threshold; if it is held, with each rate
  std::vector<Maximum> starts;
  for (const double threshold : thresholds)
    for (const double rate : rates) {
      Maximum best{{}, std::numeric_limits<double>::infinity()};
      for (const double lapse : lapses)
        for (const double guess : guesses) {
          const Theta theta = project({threshold, rate, lapse, guess});
          if (const double cost = negative_log(theta); cost < best.negative_log) best = {theta, cost};
        }
      if (held || starts.empty() || starts.back().theta[0] != best.theta[0])
        starts.push_back(best);
      else if (best.negative_log < starts.back().negative_log)
        starts.back() = best;
    }
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Maximum& a, const Maximum& b) { return a.negative_log < b.negative_log; });
  constexpr std::size_t climbs = 6;
  Maximum best = climb(starts[0].theta);
  for (std::size_t i = 1; i < std::min(climbs, starts.size()); ++i) {
    const Maximum other = climb(starts[i].theta);
    if (other.negative_log < best.negative_log) best = other;
  }
  return best;
}

}  // namespace turnpoint::analysis

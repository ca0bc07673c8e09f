#include "station/analysis/rating_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "station/analysis/proportion.hpp"

namespace turnpoint::analysis {

namespace {

// Beyond these values the likelihood is so flat that the estimate would depend on when the search ends.
constexpr double kLargestMean = 6, kLargestRatio = 10;

/// Numbers of trials by rating, without ratings that were never given.
struct Table {
  std::vector<double> noise, signal;
  std::size_t criteria() const { return noise.size() - 1; }
};

Table table_of(const std::vector<int>& noise, const std::vector<int>& signal) {
  Table table;
  for (std::size_t i = 0; i < noise.size(); ++i) {
    if (noise[i] < 0 || signal[i] < 0) throw std::invalid_argument("ratings: a number of trials is negative");
    if (noise[i] + signal[i] == 0) continue;
    table.noise.push_back(noise[i]), table.signal.push_back(signal[i]);
  }
  return table;
}

double sum_of(const std::vector<double>& counts) {
  double sum = 0;
  for (const double count : counts) sum += count;
  return sum;
}

/// The parameters, as in Dorfman and Alf: the signal's criterion is b z - a for each noise criterion z. So
/// a is the mean over the signal's standard deviation, and b is 1 over the latter. Order: a, b, z.
using Vector = Eigen::VectorXd;

struct Slope {
  double log_likelihood = -std::numeric_limits<double>::infinity();
  Vector gradient;
  Eigen::MatrixXd information;
};

bool is_possible(const Vector& at) {
  if (!(at[1] > 1 / kLargestRatio && at[1] < kLargestRatio)) return false;
  for (Eigen::Index k = 3; k < at.size(); ++k)
    if (!(at[k] > at[k - 1])) return false;
  return true;
}

/// Adds the trials of one kind: `count` by rating, with the criteria b z - a, or z for noise.
void add(const std::vector<double>& count, const Vector& at, bool is_signal, Slope& slope) {
  const auto n = at.size();
  const double total = sum_of(count);
  Vector below = Vector::Zero(n);
  double share_below = 0;
  for (std::size_t k = 0; k < count.size(); ++k) {
    const bool last = k + 1 == count.size();
    const auto z = static_cast<Eigen::Index>(k) + 2;
    const double place = last ? 0 : is_signal ? at[1] * at[z] - at[0] : at[z];
    const double share = last ? 1 : normal_cdf(place);
    Vector upper = Vector::Zero(n);
    if (!last) {
      const double density = normal_density(place);
      upper[z] = density * (is_signal ? at[1] : 1);
      if (is_signal) upper[0] = -density, upper[1] = density * at[z];
    }
    const double p = share - share_below;
    const Vector change = upper - below;
    if (p > 0) {
      if (count[k] > 0) slope.log_likelihood += count[k] * std::log(p);
      slope.gradient += count[k] / p * change;
      slope.information += total / p * change * change.transpose();
    } else if (count[k] > 0) {
      slope.log_likelihood = -std::numeric_limits<double>::infinity();
      return;
    }
    share_below = share, below = upper;
  }
}

Slope slope_at(const Table& table, const Vector& at, Variances variances) {
  Slope slope;
  if (!is_possible(at)) return slope;
  slope.log_likelihood = 0;
  slope.gradient = Vector::Zero(at.size());
  slope.information = Eigen::MatrixXd::Zero(at.size(), at.size());
  add(table.noise, at, false, slope);
  add(table.signal, at, true, slope);
  if (variances == Variances::equal) {
    slope.gradient[1] = 0;
    slope.information.row(1).setZero(), slope.information.col(1).setZero();
    slope.information(1, 1) = 1;
  }
  return slope;
}

/// Begins with criteria in the middle between those that noise and signal suggest. They ascend, because each
/// rating was given at least once.
Vector first_guess(const Table& table) {
  const double n = sum_of(table.noise), s = sum_of(table.signal);
  const auto m = static_cast<Eigen::Index>(table.criteria());
  Vector noise(m), signal(m);
  double below_noise = 0, below_signal = 0;
  for (Eigen::Index k = 0; k < m; ++k) {
    below_noise += table.noise[static_cast<std::size_t>(k)];
    below_signal += table.signal[static_cast<std::size_t>(k)];
    noise[k] = normal_quantile((below_noise + 0.5) / (n + 1));
    signal[k] = normal_quantile((below_signal + 0.5) / (s + 1));
  }
  Vector at(m + 2);
  at[0] = (noise - signal).mean(), at[1] = 1;
  at.tail(m) = (noise + signal).array() / 2 + at[0] / 2;
  return at;
}

/// Fisher's scoring, with shorter steps where a whole one would not increase the likelihood. Empty if the
/// search does not come to rest.
std::optional<Vector> most_likely(const Table& table, Variances variances) {
  auto at = first_guess(table);
  auto here = slope_at(table, at, variances);
  for (int round = 0; round < 500; ++round) {
    const Eigen::LLT<Eigen::MatrixXd> solver(here.information);
    if (solver.info() != Eigen::Success) return std::nullopt;
    Vector step = solver.solve(here.gradient);
    const double gain = here.gradient.dot(step) / 2;  // what a whole step would add to the log likelihood
    if (gain < 1e-12) return at;
    auto there = slope_at(table, at + step, variances);
    for (int halved = 0; halved < 40 && !(there.log_likelihood >= here.log_likelihood); ++halved) {
      step /= 2;
      there = slope_at(table, at + step, variances);
    }
    if (!(there.log_likelihood >= here.log_likelihood))  // if the gain is tiny, only rounding errors are left
      return gain < 1e-6 ? std::optional(at) : std::nullopt;
    at += step, here = std::move(there);
    if (std::fabs(at[0]) > kLargestMean * std::max(1.0, at[1])) return std::nullopt;
  }
  return std::nullopt;
}

/// False for an estimate at the edge of what is possible: the likelihood rises up to there, and beyond.
bool is_determined(const Vector& at) {
  constexpr double near_edge = 0.99;
  return at[1] > 1 / (near_edge * kLargestRatio) && at[1] < near_edge * kLargestRatio &&
         at.tail(at.size() - 2).cwiseAbs().maxCoeff() < kLargestMean;
}

Estimate around(double value, double sd) { return {value, {value - kZ95 * sd, value + kZ95 * sd, 0.95}}; }

}  // namespace

std::optional<RatingFit> fit_ratings(const std::vector<int>& noise, const std::vector<int>& signal,
                                     Variances variances) {
  if (noise.size() != signal.size())
    throw std::invalid_argument("ratings: noise and signal have different numbers of ratings");
  const auto table = table_of(noise, signal);
  if (sum_of(table.noise) == 0 || sum_of(table.signal) == 0) return std::nullopt;
  if (table.noise.size() < (variances == Variances::equal ? 2u : 3u)) return std::nullopt;
  const auto at = most_likely(table, variances);
  if (!at || !is_determined(*at)) return std::nullopt;
  const auto slope = slope_at(table, *at, variances);
  const Eigen::MatrixXd covariance =
      slope.information.llt().solve(Eigen::MatrixXd::Identity(at->size(), at->size()));
  const double a = (*at)[0], b = (*at)[1], root = std::sqrt(1 + b * b);
  Vector turn = Vector::Zero(at->size());  // the derivative of d_a
  turn[0] = std::sqrt(2.0) / root;
  if (variances == Variances::unequal) turn[1] = -std::sqrt(2.0) * a * b / (root * root * root);
  RatingFit fit;
  fit.mean = a / b;
  fit.sensitivity = around(std::sqrt(2.0) * a / root, std::sqrt(turn.dot(covariance * turn)));
  if (variances == Variances::unequal) {
    const double wide = std::exp(kZ95 * std::sqrt(covariance(1, 1)) / b);
    fit.sd = {1 / b, {1 / (b * wide), wide / b, 0.95}};
  }
  const auto area = [](double d) { return normal_cdf(d / std::sqrt(2.0)); };
  const double value = fit.sensitivity.value;
  const auto range = fit.sensitivity.interval;
  fit.area = {area(value), {area(range.low), area(range.high), 0.95}};
  fit.criteria.assign(at->data() + 2, at->data() + at->size());
  fit.log_likelihood = slope.log_likelihood;
  return fit;
}

}  // namespace turnpoint::analysis

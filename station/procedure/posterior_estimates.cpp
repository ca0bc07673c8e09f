#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "station/core/elementary.hpp"
#include "station/procedure/distance.hpp"
#include "station/procedure/posterior.hpp"

namespace turnpoint::procedure {

namespace {

/// Share of the weight below a 95 % interval, and above it.
constexpr double kTail = 0.025;

/// Returns the ends of the cells around ascending values: halfway to the neighbours, and as far outwards at
/// the ends. If no value is below 0, neither is a cell: rates and slopes cannot be.
std::vector<double> edges_of(const std::vector<double>& values) {
  std::vector<double> edges{values.front()};
  for (std::size_t i = 1; i < values.size(); ++i) edges.push_back(0.5 * (values[i - 1] + values[i]));
  edges.push_back(values.back());
  if (values.size() < 2) return edges;
  edges.front() -= edges[1] - values.front();
  edges.back() += values.back() - edges[values.size() - 1];
  if (values.front() >= 0) edges.front() = std::max(edges.front(), 0.0);
  return edges;
}

/// Returns the value below which this share of the weight lies. The weight of a value is spread evenly over
/// its cell.
double quantile(const std::vector<double>& edges, const std::vector<double>& weights, double share) {
  double below = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] > 0 && below + weights[i] >= share)
      return edges[i] + (edges[i + 1] - edges[i]) * std::max(0.0, share - below) / weights[i];
    below += weights[i];
  }
  return edges.back();
}

struct Moments {
  double mean = 0, sd = 0;
};

Moments moments_of(const std::vector<double>& values, const std::vector<double>& weights) {
  Moments moments;
  for (std::size_t i = 0; i < values.size(); ++i) moments.mean += weights[i] * values[i];
  double variance = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    variance += weights[i] * (values[i] - moments.mean) * (values[i] - moments.mean);
  moments.sd = std::sqrt(variance);
  return moments;
}

/// Returns the estimate from ascending values and their weights, which sum to 1. The mode is that of the
/// weights.
Estimate estimate_of(const std::vector<double>& values, const std::vector<double>& weights) {
  Estimate estimate;
  estimate.mode =
      values[static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin())];
  const auto moments = moments_of(values, weights);
  estimate.mean = moments.mean, estimate.sd = moments.sd;
  const auto edges = edges_of(values);
  estimate.interval = {quantile(edges, weights, kTail), quantile(edges, weights, 1 - kTail)};
  return estimate;
}

}  // namespace

std::size_t Posterior::nearest_stimulus(double level, Scale scale) const {
  std::size_t nearest = 0;
  double least = 2 * kBeyond;
  for (std::size_t i = 0; i < stimuli_.size(); ++i)
    if (const double away = std::fabs(distance(scale, stimuli_[i].level, level)); away < least)
      nearest = i, least = away;
  return nearest;
}

double Posterior::most_likely_threshold() const {
  const auto weights = marginal(threshold);
  // products of the same factors in another order differ by rounding
  const double most = *std::max_element(weights.begin(), weights.end()) * (1 - 1e-9);
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (weights[i] >= most) sum += values_[threshold][i], ++count;
  return sum / count;
}

std::vector<double> Posterior::marginal(Parameter parameter) const {
  std::vector<double> marginal(values_[parameter].size());
  const std::size_t stride = stride_[parameter];
  // The values take turns, because a sum waits for its last addition.
  for (std::size_t first = 0; first < size(); first += stride * marginal.size())
    for (std::size_t i = 0; i < stride; ++i)
      for (std::size_t value = 0; value < marginal.size(); ++value)
        marginal[value] += weights_[first + value * stride + i];
  return marginal;
}

double Posterior::mean(Parameter parameter) const {
  return moments_of(values_[parameter], marginal(parameter)).mean;
}

double Posterior::sd(Parameter parameter) const {
  return moments_of(values_[parameter], marginal(parameter)).sd;
}

Estimate Posterior::estimate(Parameter parameter) const {
  auto estimate = estimate_of(values_[parameter], marginal(parameter));
  const auto peak = std::max_element(weights_.begin(), weights_.end()) - weights_.begin();
  estimate.mode = values_[parameter][index_of(static_cast<std::size_t>(peak), parameter)];
  return estimate;
}

std::vector<ThresholdAt> Posterior::thresholds() const {
  std::vector<double> at_place(places_);
  const std::size_t points = shapes_ * ends_;
  for (std::size_t i = 0; i < size(); ++i) at_place[i / points] += weights_[i];
  std::vector<ThresholdAt> all;
  for (const double second : seconds_) {
    std::map<double, double> weight;
    for (std::size_t place = 0; place < places_; ++place)
      weight[threshold_of(place, second)] += at_place[place];
    std::vector<double> values, weights;
    for (const auto& [value, sum] : weight) values.push_back(value), weights.push_back(sum);
    all.push_back({second, estimate_of(values, weights)});
  }
  return all;
}

double Posterior::entropy_nats() const {
  double sum = 0;
  for (const double weight : weights_)
    if (weight > 0) sum -= weight * core::log(weight);
  return sum;
}

}  // namespace turnpoint::procedure

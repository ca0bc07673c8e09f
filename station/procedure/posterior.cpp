#include "station/procedure/posterior.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "station/procedure/psychometric.hpp"
#include "station/random/elementary.hpp"

namespace turnpoint::procedure {

namespace {

/// No answer is ever impossible: a slip must not annihilate the posterior. Lower than anything that shows.
constexpr double kFloor = 1e-14;

/// Binary entropy in nats; 0 at 0 and 1.
double binary_entropy(double p) {
  if (p <= 0 || p >= 1) return 0;
  return -p * random::log(p) - (1 - p) * random::log(1 - p);
}

/// Sum of products in eight fixed lanes: the compiler may use any vector width, the result is the same.
double dot(const double* a, const double* b, std::size_t n) {
  constexpr std::size_t kLanes = 8;
  double lanes[kLanes] = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) lanes[lane] += a[i + lane] * b[i + lane];
  double sum = 0;
  for (; i < n; ++i) sum += a[i] * b[i];
  for (const double lane : lanes) sum += lane;
  return sum;
}

std::vector<double> prior_weights(const Prior& prior, const std::vector<double>& values) {
  if (!prior.weights.empty()) return prior.weights;
  std::vector<double> weights(values.size(), 1.0);
  if (prior.normal)
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double z = (values[i] - prior.normal->first) / prior.normal->second;
      weights[i] = random::exp(std::max(-0.5 * z * z, -700.0));
    }
  return weights;
}

}  // namespace

Posterior::Posterior(const Spec& spec) : stimuli_(spec.stimuli.values) {
  values_ = {spec.threshold.values, spec.slope.values, spec.guess.values, spec.lapse.values};
  const bool tied = !spec.guess.tied.empty();
  if (tied || values_[guess].empty()) values_[guess] = {0};
  if (values_[lapse].empty()) values_[lapse] = {0};
  std::size_t size = 1;
  for (int parameter = lapse; parameter >= threshold; --parameter) {
    stride_[static_cast<std::size_t>(parameter)] = size;
    size *= values_[static_cast<std::size_t>(parameter)].size();
  }
  const std::array<const Prior*, 4> priors{&spec.prior_threshold, &spec.prior_slope, &spec.prior_guess,
                                           &spec.prior_lapse};
  std::array<std::vector<double>, 4> prior;
  for (std::size_t k = 0; k < 4; ++k)
    prior[k] = k == guess && tied ? std::vector<double>{1.0} : prior_weights(*priors[k], values_[k]);
  weights_.resize(size);
  std::vector<Psychometric> points(size);
  for (std::size_t i = 0; i < size; ++i) {
    std::array<std::size_t, 4> at{};
    for (std::size_t k = 0; k < 4; ++k) at[k] = index_of(i, static_cast<Parameter>(k));
    points[i] = {values_[0][at[0]], values_[1][at[1]], values_[2][at[2]], values_[3][at[3]]};
    if (tied) points[i].guess = points[i].lapse;
    weights_[i] = prior[0][at[0]] * prior[1][at[1]] * prior[2][at[2]] * prior[3][at[3]];
  }
  const double total = std::accumulate(weights_.begin(), weights_.end(), 0.0);
  for (auto& weight : weights_) weight /= total;

  p_.resize(stimuli_.size() * size);
  for (std::size_t s = 0; s < stimuli_.size(); ++s)
    for (std::size_t i = 0; i < size; ++i)
      p_[s * size + i] =
          std::clamp(probability(spec.function, spec.scale, points[i], stimuli_[s]), kFloor, 1 - kFloor);

  if (spec.nuisance.empty()) {
    entropy_.resize(p_.size());
    for (std::size_t i = 0; i < p_.size(); ++i) entropy_[i] = binary_entropy(p_[i]);
    return;
  }
  static const std::array<const char*, 4> names{"threshold", "slope", "guess", "lapse"};
  kept_.resize(size);
  groups_ = 1;
  for (int parameter = lapse; parameter >= threshold; --parameter) {
    const auto k = static_cast<std::size_t>(parameter);
    if (std::find(spec.nuisance.begin(), spec.nuisance.end(), names[k]) != spec.nuisance.end()) continue;
    for (std::size_t i = 0; i < size; ++i)
      kept_[i] += groups_ * index_of(i, static_cast<Parameter>(parameter));
    groups_ *= values_[k].size();
  }
}

std::size_t Posterior::index_of(std::size_t point, Parameter parameter) const {
  return point / stride_[parameter] % values_[parameter].size();
}

double Posterior::kept_entropy(std::size_t stimulus, std::vector<double>& scratch) const {
  // The mean over groups of the entropy of the answer, each group's probability being its nuisance average.
  const double* p = &p_[stimulus * size()];
  scratch.assign(2 * groups_, 0.0);
  for (std::size_t i = 0; i < size(); ++i) {
    scratch[2 * kept_[i]] += weights_[i];
    scratch[2 * kept_[i] + 1] += weights_[i] * p[i];
  }
  double sum = 0;
  for (std::size_t g = 0; g < groups_; ++g)
    if (scratch[2 * g] > 0) sum += scratch[2 * g] * binary_entropy(scratch[2 * g + 1] / scratch[2 * g]);
  return sum;
}

std::size_t Posterior::memory_bytes() const {
  return sizeof(double) * (weights_.size() + p_.size() + entropy_.size()) +
         sizeof(std::size_t) * kept_.size();
}

double Posterior::predictive(std::size_t stimulus) const {
  return dot(weights_.data(), &p_[stimulus * size()], size());
}

std::vector<double> Posterior::information() const {
  std::vector<double> information(stimuli_.size()), scratch;
  for (std::size_t s = 0; s < stimuli_.size(); ++s) {
    const double expected = predictive(s);
    const double given =
        kept_.empty() ? dot(weights_.data(), &entropy_[s * size()], size()) : kept_entropy(s, scratch);
    information[s] = binary_entropy(expected) - given;
  }
  return information;
}

std::size_t Posterior::best_stimulus() const {
  const auto all = information();
  return static_cast<std::size_t>(std::max_element(all.begin(), all.end()) - all.begin());
}

void Posterior::update(std::size_t stimulus, bool one) {
  const double* p = &p_[stimulus * size()];
  double total = 0;
  for (std::size_t i = 0; i < size(); ++i) weights_[i] *= one ? p[i] : 1 - p[i];
  for (const double weight : weights_) total += weight;
  for (auto& weight : weights_) weight /= total;
}

std::vector<double> Posterior::marginal(Parameter parameter) const {
  std::vector<double> marginal(values_[parameter].size());
  for (std::size_t i = 0; i < size(); ++i) marginal[index_of(i, parameter)] += weights_[i];
  return marginal;
}

Estimate Posterior::estimate(Parameter parameter) const {
  const auto weights = marginal(parameter);
  const auto& values = values_[parameter];
  Estimate estimate;
  const auto peak = std::max_element(weights_.begin(), weights_.end()) - weights_.begin();
  estimate.mode = values[index_of(static_cast<std::size_t>(peak), parameter)];
  for (std::size_t i = 0; i < values.size(); ++i) estimate.mean += weights[i] * values[i];
  double variance = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    variance += weights[i] * (values[i] - estimate.mean) * (values[i] - estimate.mean);
  estimate.sd = std::sqrt(variance);
  return estimate;
}

double Posterior::entropy_nats() const {
  double sum = 0;
  for (const double weight : weights_)
    if (weight > 0) sum -= weight * random::log(weight);
  return sum;
}

}  // namespace turnpoint::procedure

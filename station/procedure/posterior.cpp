#include "station/procedure/posterior.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "station/procedure/psychometric.hpp"
#include "station/random/elementary.hpp"
#include "station/random/instruction_sets.hpp"

namespace turnpoint::procedure {

namespace {

/// The lowest probability of an answer. If it were 0, a single slip could make the posterior zero everywhere.
/// The value is so small that it has no other effect.
constexpr double kFloor = 1e-14;

/// Represents an infinite distance. Distances between finite levels are always smaller.
constexpr double kBeyond = 1e300;
/// Two distances count as equal if their difference is below this fraction of the largest distance, because
/// such differences are rounding errors.
constexpr double kSameDistance = 1e-13;

double likely(double p) { return std::clamp(p, kFloor, 1 - kFloor); }

/// Returns the distance of a stimulus above a threshold: the difference of their levels on a linear scale,
/// the logarithm of their ratio on a logarithmic scale.
double distance(Scale scale, double level, double threshold) {
  if (scale == Scale::linear) return level - threshold;
  if (level <= 0) return -kBeyond;
  return threshold <= 0 ? kBeyond : random::log(level / threshold);
}

/// Returns the binary entropy of a probability in nats; 0 at probabilities 0 and 1.
double binary_entropy(double p) {
  if (p <= 0 || p >= 1) return 0;
  return -p * random::log(p) - (1 - p) * random::log(1 - p);
}

/// A sum of products is made of this many partial sums, which are computed in parallel.
constexpr std::size_t kLanes = 8;

using Quad = double __attribute__((vector_size(32)));

/// A sum of products. It always uses the same kLanes partial sums, so that the result does not depend on the
/// compiler.
struct Products {
  std::array<double, kLanes> lane{};
  double rest = 0;

  double sum() const {
    return rest + ((lane[0] + lane[1]) + (lane[2] + lane[3])) + ((lane[4] + lane[5]) + (lane[6] + lane[7]));
  }
};

/// Adds x * y to the first sum and x * z to the second. Computing both together is faster, because neither
/// waits for the other. The partial sums are copied to local variables, which cannot overlap the inputs, so
/// that the compiler can keep them in registers.
TURNPOINT_CLONES
void add(Products& first, Products& second, const double* x, const double* y, const double* z,
         std::size_t n) {
  Quad one_low, one_high, two_low, two_high, value, by;
  std::memcpy(&one_low, &first.lane[0], sizeof one_low);
  std::memcpy(&one_high, &first.lane[4], sizeof one_high);
  std::memcpy(&two_low, &second.lane[0], sizeof two_low);
  std::memcpy(&two_high, &second.lane[4], sizeof two_high);
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    std::memcpy(&value, x + i, sizeof value);
    std::memcpy(&by, y + i, sizeof by);
    one_low += value * by;
    std::memcpy(&by, z + i, sizeof by);
    two_low += value * by;
    std::memcpy(&value, x + i + 4, sizeof value);
    std::memcpy(&by, y + i + 4, sizeof by);
    one_high += value * by;
    std::memcpy(&by, z + i + 4, sizeof by);
    two_high += value * by;
  }
  double one_rest = first.rest, two_rest = second.rest;
  for (; i < n; ++i) one_rest += x[i] * y[i], two_rest += x[i] * z[i];
  std::memcpy(&first.lane[0], &one_low, sizeof one_low);
  std::memcpy(&first.lane[4], &one_high, sizeof one_high);
  std::memcpy(&second.lane[0], &two_low, sizeof two_low);
  std::memcpy(&second.lane[4], &two_high, sizeof two_high);
  first.rest = one_rest, second.rest = two_rest;
}

/// The expected entropies of this many stimuli are computed side by side. Each stimulus has sums of its own,
/// in the same order of additions as if it were computed alone.
constexpr std::size_t kAbreast = 4;
/// The logarithms of this many groups are computed together.
constexpr std::size_t kBatch = 128;

/// Adds to the sums of each point's group the point's weight times its range times the value of the function,
/// for kAbreast stimuli. `values` has kAbreast values for each slope.
TURNPOINT_CLONES
void add_to_groups(double* __restrict sums, const std::uint32_t* __restrict groups,
                   const double* __restrict weights, const double* __restrict ranges,
                   const double* __restrict values, std::size_t slopes, std::size_t ends) {
  Quad value, sum;
  for (std::size_t s = 0; s < slopes; ++s) {
    std::memcpy(&value, values + s * kAbreast, sizeof value);
    for (std::size_t e = 0; e < ends; ++e, ++weights, ++groups) {
      double* group = sums + *groups * kAbreast;
      std::memcpy(&sum, group, sizeof sum);
      sum += *weights * (ranges[e] * value);
      std::memcpy(group, &sum, sizeof sum);
    }
  }
}

/// Adds to `totals` the weighted entropies of the answer in `n` groups, at most kBatch, for kAbreast stimuli.
/// `ones` are the groups' weights of answer 1.
TURNPOINT_CLONES
void add_entropies(double* __restrict totals, const double* __restrict ones, const double* __restrict weights,
                   std::size_t n) {
  std::array<double, kBatch * kAbreast> one, zero, log_one, log_zero;
  for (std::size_t i = 0; i < n * kAbreast; ++i) {
    const double weight = weights[i / kAbreast], p = ones[i] / (weight > 0 ? weight : 1);
    const bool certain = p <= 0 || p >= 1;
    one[i] = certain ? 1 : p;  // an entropy of 0
    zero[i] = certain ? 1 : 1 - p;
  }
  random::logs({one.data(), n * kAbreast}, log_one);
  random::logs({zero.data(), n * kAbreast}, log_zero);
  Quad total, p, q, log_p, log_q;
  std::memcpy(&total, totals, sizeof total);
  for (std::size_t g = 0; g < n; ++g) {
    if (!(weights[g] > 0)) continue;
    std::memcpy(&p, &one[g * kAbreast], sizeof p);
    std::memcpy(&q, &zero[g * kAbreast], sizeof q);
    std::memcpy(&log_p, &log_one[g * kAbreast], sizeof log_p);
    std::memcpy(&log_q, &log_zero[g * kAbreast], sizeof log_q);
    total += weights[g] * (-p * log_p - q * log_q);
  }
  std::memcpy(totals, &total, sizeof total);
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
  if (!spec.guess.tied.empty() || values_[guess].empty()) values_[guess] = {0};
  if (values_[lapse].empty()) values_[lapse] = {0};
  std::size_t size = 1;
  for (int parameter = lapse; parameter >= threshold; --parameter) {
    stride_[static_cast<std::size_t>(parameter)] = size;
    size *= values_[static_cast<std::size_t>(parameter)].size();
  }
  set_asymptotes(spec);
  set_weights(spec);
  set_groups(spec);
  set_rows(spec);
}

void Posterior::set_asymptotes(const Spec& spec) {
  slopes_ = values_[slope].size();
  padded_slopes_ = (slopes_ + kLanes - 1) / kLanes * kLanes;
  for (const double g : values_[guess])
    for (const double l : values_[lapse]) {
      const double low = spec.guess.tied.empty() ? g : l;
      guesses_.push_back(low), ranges_.push_back(1 - low - l);
    }
  ends_ = guesses_.size();
}

void Posterior::set_weights(const Spec& spec) {
  const std::array<const Prior*, 4> priors{&spec.prior_threshold, &spec.prior_slope, &spec.prior_guess,
                                           &spec.prior_lapse};
  Axes prior;
  for (std::size_t k = 0; k < 4; ++k)
    prior[k] = k == guess && !spec.guess.tied.empty() ? std::vector<double>{1.0}
                                                      : prior_weights(*priors[k], values_[k]);
  weights_.reserve(values_[0].size() * slopes_ * ends_);
  for (const double t : prior[threshold])
    for (const double s : prior[slope])
      for (const double g : prior[guess])
        for (const double l : prior[lapse]) weights_.push_back(t * s * g * l);
  const double total = std::accumulate(weights_.begin(), weights_.end(), 0.0);
  for (auto& weight : weights_) weight /= total;
}

void Posterior::set_rows(const Spec& spec) {
  struct Pair {
    double distance;
    std::size_t stimulus, at_threshold;
  };
  std::vector<Pair> pairs;
  double largest = 0;
  for (std::size_t x = 0; x < stimuli_.size(); ++x)
    for (std::size_t t = 0; t < values_[threshold].size(); ++t) {
      const double d = distance(spec.scale, stimuli_[x], values_[threshold][t]);
      pairs.push_back({d, x, t});
      if (std::fabs(d) < kBeyond) largest = std::max(largest, std::fabs(d));
    }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  rows_.resize(pairs.size());
  std::vector<Pair> distinct;
  for (const auto& pair : pairs) {
    if (distinct.empty() || pair.distance > distinct.back().distance + kSameDistance * largest)
      distinct.push_back(pair);
    rows_[pair.stimulus * values_[threshold].size() + pair.at_threshold] =
        static_cast<std::uint32_t>(distinct.size() - 1);
  }
  core_.assign(distinct.size() * padded_slopes_, 0);
  if (kept_.empty()) entropy_.reserve(distinct.size() * slopes_ * ends_);
  for (std::size_t d = 0; d < distinct.size(); ++d)
    for (std::size_t s = 0; s < slopes_; ++s) {
      const double f = probability(spec.function, spec.scale,
                                   {values_[threshold][distinct[d].at_threshold], values_[slope][s], 0, 0},
                                   stimuli_[distinct[d].stimulus]);
      core_[d * padded_slopes_ + s] = f;
      for (std::size_t e = 0; e < ends_ && kept_.empty(); ++e)
        entropy_.push_back(binary_entropy(likely(guesses_[e] + ranges_[e] * f)));
    }
}

void Posterior::set_groups(const Spec& spec) {
  if (spec.nuisance.empty()) return;
  static const std::array<const char*, 4> names{"threshold", "slope", "guess", "lapse"};
  kept_.assign(size(), 0);
  groups_ = 1;
  for (int parameter = lapse; parameter >= threshold; --parameter) {
    const auto k = static_cast<std::size_t>(parameter);
    if (std::find(spec.nuisance.begin(), spec.nuisance.end(), names[k]) != spec.nuisance.end()) continue;
    for (std::size_t i = 0; i < size(); ++i)
      kept_[i] += static_cast<std::uint32_t>(groups_ * index_of(i, static_cast<Parameter>(parameter)));
    groups_ *= values_[k].size();
  }
}

std::size_t Posterior::index_of(std::size_t point, Parameter parameter) const {
  return point / stride_[parameter] % values_[parameter].size();
}

/// Returns for each stimulus the sum of products over all thresholds: `factors` times the rows of `table`
/// that belong to the stimulus. Both have `length` entries per threshold.
std::vector<double> Posterior::sums(const std::vector<double>& factors, const std::vector<double>& table,
                                    std::size_t length) const {
  const std::size_t n = stimuli_.size();
  std::vector<double> all;
  for (std::size_t x = 0; x < n; x += 2) {
    const std::size_t other = std::min(x + 1, n - 1);
    Products first, second;
    for (std::size_t t = 0; t < values_[threshold].size(); ++t)
      add(first, second, &factors[t * length], &table[row(x, t) * length], &table[row(other, t) * length],
          length);
    all.push_back(first.sum());
    if (other > x) all.push_back(second.sum());
  }
  return all;
}

std::vector<double> Posterior::predictives() const {
  // The answer's probability is a linear function of guess and of 1 - guess - lapse, so first average over
  // these two.
  std::vector<double> range(values_[threshold].size() * padded_slopes_);
  double floor = 0;
  for (std::size_t t = 0; t < values_[threshold].size(); ++t)
    for (std::size_t s = 0; s < slopes_; ++s) {
      const double* weights = &weights_[(t * slopes_ + s) * ends_];
      double low = 0, between = 0;
      for (std::size_t e = 0; e < ends_; ++e)
        low += weights[e] * guesses_[e], between += weights[e] * ranges_[e];
      floor += low;
      range[t * padded_slopes_ + s] = between;
    }
  auto all = sums(range, core_, padded_slopes_);
  for (auto& p : all) p += floor;
  return all;
}

/// Returns the expected entropy of the answer at each stimulus if the kept parameters were known. It groups
/// grid points with the same kept parameters, averages the probability of the answer within each group (over
/// the nuisance parameters), and returns the weighted mean of the groups' entropies. A group's weight, and
/// the part of its probability that comes from guessing, do not depend on the stimulus.
std::vector<double> Posterior::kept_entropies() const {
  std::vector<double> weight(groups_), guess_part(groups_), entropies;
  for (std::size_t i = 0; i < size();)
    for (std::size_t e = 0; e < ends_; ++e, ++i) {
      weight[kept_[i]] += weights_[i];
      guess_part[kept_[i]] += weights_[i] * guesses_[e];
    }
  std::vector<double> values(slopes_ * kAbreast), ones(groups_ * kAbreast);
  for (std::size_t first = 0; first < stimuli_.size(); first += kAbreast) {
    for (std::size_t i = 0; i < ones.size(); ++i) ones[i] = guess_part[i / kAbreast];
    for (std::size_t t = 0; t < values_[threshold].size(); ++t) {
      for (std::size_t x = 0; x < kAbreast; ++x) {
        const double* core = &core_[row(std::min(first + x, stimuli_.size() - 1), t) * padded_slopes_];
        for (std::size_t s = 0; s < slopes_; ++s) values[s * kAbreast + x] = core[s];
      }
      const std::size_t point = t * slopes_ * ends_;
      add_to_groups(ones.data(), &kept_[point], &weights_[point], ranges_.data(), values.data(), slopes_,
                    ends_);
    }
    std::array<double, kAbreast> totals{};
    for (std::size_t g = 0; g < groups_; g += kBatch)
      add_entropies(totals.data(), &ones[g * kAbreast], &weight[g], std::min(kBatch, groups_ - g));
    entropies.insert(
        entropies.end(), totals.begin(),
        totals.begin() + static_cast<std::ptrdiff_t>(std::min(kAbreast, stimuli_.size() - first)));
  }
  return entropies;
}

std::size_t Posterior::memory_bytes() const {
  return sizeof(double) * (weights_.size() + core_.size() + entropy_.size()) +
         sizeof(std::uint32_t) * (rows_.size() + kept_.size());
}

double Posterior::predictive(std::size_t stimulus) const { return predictives()[stimulus]; }

std::vector<double> Posterior::information() const {
  auto information = predictives();
  const auto given = kept_.empty() ? sums(weights_, entropy_, slopes_ * ends_) : kept_entropies();
  for (std::size_t x = 0; x < stimuli_.size(); ++x)
    information[x] = binary_entropy(information[x]) - given[x];
  return information;
}

std::size_t Posterior::best_stimulus() const {
  const auto all = information();
  return static_cast<std::size_t>(std::max_element(all.begin(), all.end()) - all.begin());
}

std::size_t Posterior::nearest_stimulus(double level, Scale scale) const {
  std::size_t nearest = 0;
  double least = 2 * kBeyond;
  for (std::size_t i = 0; i < stimuli_.size(); ++i)
    if (const double away = std::fabs(distance(scale, stimuli_[i], level)); away < least)
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

void Posterior::update(std::size_t stimulus, bool one) {
  double total = 0;
  for (std::size_t t = 0; t < values_[threshold].size(); ++t)
    for (std::size_t s = 0; s < slopes_; ++s) {
      const double f = core_[row(stimulus, t) * padded_slopes_ + s];
      double* weights = &weights_[(t * slopes_ + s) * ends_];
      double part = 0;
      for (std::size_t e = 0; e < ends_; ++e) {
        const double p = likely(guesses_[e] + ranges_[e] * f);
        part += weights[e] *= one ? p : 1 - p;
      }
      total += part;
    }
  const double scale = 1 / total;
  for (auto& weight : weights_) weight *= scale;
}

std::vector<double> Posterior::marginal(Parameter parameter) const {
  std::vector<double> marginal(values_[parameter].size());
  const std::size_t stride = stride_[parameter];
  for (std::size_t first = 0; first < size(); first += stride * marginal.size())
    for (std::size_t value = 0; value < marginal.size(); ++value)
      for (std::size_t i = 0; i < stride; ++i) marginal[value] += weights_[first + value * stride + i];
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

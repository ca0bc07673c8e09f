#include "station/procedure/posterior.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "station/core/elementary.hpp"
#include "station/procedure/distance.hpp"
#include "station/procedure/posterior_sums.hpp"
#include "station/procedure/psychometric.hpp"

namespace turnpoint::procedure {

namespace {

/// The lowest probability of an answer. If it were 0, a single slip could make the posterior zero everywhere.
/// The value is so small that it has no other effect.
constexpr double kFloor = 1e-14;

/// A place is left out of the sums over all places if none of its weights, of which the sum is 1, reaches
/// this. A sum of a million such weights is still below the rounding error of the others.
constexpr double kNegligible = 1e-22;

/// Two distances count as equal if their difference is below this fraction of the largest distance, because
/// such differences are rounding errors.
constexpr double kSameDistance = 1e-13;

double likely(double p) { return std::clamp(p, kFloor, 1 - kFloor); }

/// Returns the binary entropy of a probability in nats; 0 at probabilities 0 and 1.
double binary_entropy(double p) {
  if (p <= 0 || p >= 1) return 0;
  return -p * core::log(p) - (1 - p) * core::log(1 - p);
}

std::vector<double> prior_weights(const Prior& prior, const std::vector<double>& values) {
  if (!prior.weights.empty()) return prior.weights;
  std::vector<double> weights(values.size(), 1.0);
  if (prior.normal)
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double z = (values[i] - prior.normal->first) / prior.normal->second;
      weights[i] = core::exp(std::max(-0.5 * z * z, -700.0));
    }
  return weights;
}

/// True if the guess rate always equals the lapse rate.
bool tied_ends(const Spec& spec) { return spec.signal_detection || !spec.guess.tied.empty(); }

}  // namespace

Posterior::Posterior(const Spec& spec) : scale_(spec.scale), floored_(!spec.floor.values.empty()) {
  for (std::size_t k = 0; k < kParameters.size(); ++k) {
    const bool unused = k == guess && tied_ends(spec);
    if (!unused) values_[k] = (spec.*kParameters[k].grid).values;
    if (values_[k].empty()) values_[k] = {0};
  }
  std::size_t size = 1;
  for (std::size_t k = kParameters.size(); k-- > 0;) stride_[k] = size, size *= values_[k].size();
  set_stimuli(spec);
  set_asymptotes(spec);
  set_weights(spec);
  set_groups(spec);
  set_rows(spec);
}

void Posterior::set_stimuli(const Spec& spec) {
  if (spec.second) seconds_ = spec.second->stimuli.values, origin_ = spec.second->origin;
  for (const double level : spec.stimuli.values) {
    if (!spec.second) stimuli_.push_back({level, 0});
    for (const double second : seconds_) stimuli_.push_back({level, second});
  }
}

void Posterior::set_asymptotes(const Spec& spec) {
  places_ = values_[threshold].size() * values_[gradient].size() * values_[floor].size();
  shapes_ = values_[slope].size() * values_[criterion].size();
  padded_shapes_ = (shapes_ + kLanes - 1) / kLanes * kLanes;
  for (const double g : values_[guess])
    for (const double l : values_[lapse]) {
      const double low = tied_ends(spec) ? l : g;
      guesses_.push_back(low), ranges_.push_back(1 - low - l);
    }
  ends_ = guesses_.size();
}

void Posterior::set_weights(const Spec& spec) {
  weights_ = {1.0};
  for (std::size_t k = 0; k < kParameters.size(); ++k) {
    const bool unused = (k == guess && tied_ends(spec)) || (spec.*kParameters[k].grid).values.empty();
    const auto prior =
        unused ? std::vector<double>{1.0} : prior_weights(spec.*kParameters[k].prior, values_[k]);
    std::vector<double> product;
    product.reserve(weights_.size() * prior.size());
    for (const double weight : weights_)
      for (const double more : prior) product.push_back(weight * more);
    weights_ = std::move(product);
  }
  const double total = std::accumulate(weights_.begin(), weights_.end(), 0.0);
  for (auto& weight : weights_) weight /= total;
}

double Posterior::threshold_of(std::size_t place, double second) const {
  const std::size_t floors = values_[floor].size(), gradients = values_[gradient].size();
  const auto at = [&](Parameter parameter, std::size_t index) { return values_[parameter][index]; };
  const double base = at(threshold, place / (gradients * floors));
  if (seconds_.empty()) return base;
  return threshold_at(scale_, base, at(gradient, place / floors % gradients),
                      floored_ ? std::optional(at(floor, place % floors)) : std::nullopt, second - origin_);
}

void Posterior::set_rows(const Spec& spec) {
  struct Pair {
    double distance;
    std::uint32_t stimulus, place;
  };
  std::vector<Pair> pairs;
  pairs.reserve(stimuli_.size() * places_);
  double largest = 0;
  for (std::size_t x = 0; x < stimuli_.size(); ++x)
    for (std::size_t place = 0; place < places_; ++place) {
      const double d = distance(scale_, stimuli_[x].level, threshold_of(place, stimuli_[x].second));
      pairs.push_back({d, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(place)});
      if (std::fabs(d) < kBeyond) largest = std::max(largest, std::fabs(d));
    }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  rows_.resize(pairs.size());
  std::vector<std::pair<std::size_t, std::size_t>> distinct;
  double last = 0;
  for (const auto& pair : pairs) {
    if (distinct.empty() || pair.distance > last + kSameDistance * largest)
      distinct.emplace_back(pair.stimulus, pair.place), last = pair.distance;
    rows_[pair.stimulus * places_ + pair.place] = static_cast<std::uint32_t>(distinct.size() - 1);
  }
  set_core(spec, distinct);
}

/// Computes the tables for each distance, of which `distinct` has one example: a stimulus and a place.
void Posterior::set_core(const Spec& spec, const std::vector<std::pair<std::size_t, std::size_t>>& distinct) {
  core_.assign(distinct.size() * padded_shapes_, 0);
  if (kept_.empty()) entropy_.reserve(distinct.size() * shapes_ * ends_);
  const std::size_t criteria = values_[criterion].size();
  for (std::size_t d = 0; d < distinct.size(); ++d) {
    const auto& stimulus = stimuli_[distinct[d].first];
    const double at = threshold_of(distinct[d].second, stimulus.second);
    for (std::size_t s = 0; s < shapes_; ++s) {
      const double steepness = values_[slope][s / criteria];
      const double f =
          spec.signal_detection
              ? detection_rate(scale_, at, steepness, values_[criterion][s % criteria], stimulus.level)
              : probability(spec.function, scale_, {at, steepness, 0, 0}, stimulus.level);
      core_[d * padded_shapes_ + s] = f;
      for (std::size_t e = 0; e < ends_ && kept_.empty(); ++e)
        entropy_.push_back(likely(guesses_[e] + ranges_[e] * f));
    }
  }
  // binary_entropy() of these probabilities, all of which lie between 0 and 1
  std::vector<double> zero, log_one(entropy_.size()), log_zero(entropy_.size());
  for (const double one : entropy_) zero.push_back(1 - one);
  core::logs(entropy_, log_one);
  core::logs(zero, log_zero);
  for (std::size_t i = 0; i < entropy_.size(); ++i)
    entropy_[i] = -entropy_[i] * log_one[i] - zero[i] * log_zero[i];
}

void Posterior::set_groups(const Spec& spec) {
  if (spec.nuisance.empty()) return;
  kept_.assign(size(), 0);
  groups_ = 1;
  for (std::size_t k = kParameters.size(); k-- > 0;) {
    if (std::find(spec.nuisance.begin(), spec.nuisance.end(), kParameters[k].name) != spec.nuisance.end())
      continue;
    for (std::size_t i = 0; i < size(); ++i)
      kept_[i] += static_cast<std::uint32_t>(groups_ * index_of(i, static_cast<Parameter>(k)));
    groups_ *= values_[k].size();
  }
}

std::size_t Posterior::index_of(std::size_t point, Parameter parameter) const {
  return point / stride_[parameter] % values_[parameter].size();
}

/// Returns the places that have a weight of at least kNegligible. After some trials, these are few.
std::vector<std::size_t> Posterior::places_that_matter() const {
  std::vector<std::size_t> matter;
  for (std::size_t p = 0; p < places_; ++p) {
    const auto first = weights_.begin() + static_cast<std::ptrdiff_t>(p * shapes_ * ends_);
    const auto last = first + static_cast<std::ptrdiff_t>(shapes_ * ends_);
    if (std::any_of(first, last, [](double weight) { return weight >= kNegligible; })) matter.push_back(p);
  }
  return matter;
}

/// Returns for each stimulus the sum of products over all places that matter: `factors` times the rows of
/// `table` that belong to the stimulus. Both have `length` entries per place.
std::vector<double> Posterior::sums(const std::vector<double>& factors, const std::vector<double>& table,
                                    std::size_t length, const std::vector<std::size_t>& matter) const {
  const std::size_t n = stimuli_.size();
  std::vector<double> all(n + kAbreast);
  for (std::size_t first = 0; first < n; first += kAbreast) {
    std::array<const std::uint32_t*, kAbreast> rows;
    for (std::size_t x = 0; x < kAbreast; ++x) rows[x] = &rows_[std::min(first + x, n - 1) * places_];
    sum_rows(&all[first], factors.data(), table.data(), rows, matter.data(), matter.size(), length);
  }
  all.resize(n);
  return all;
}

std::vector<double> Posterior::predictives(const std::vector<std::size_t>& matter) const {
  // The answer's probability is a linear function of guess and of 1 - guess - lapse, so first average over
  // these two.
  std::vector<double> range(places_ * padded_shapes_);
  double from_guessing = 0;
  for (std::size_t p = 0; p < places_; ++p)
    for (std::size_t s = 0; s < shapes_; ++s) {
      const double* weights = &weights_[(p * shapes_ + s) * ends_];
      double low = 0, between = 0;
      for (std::size_t e = 0; e < ends_; ++e)
        low += weights[e] * guesses_[e], between += weights[e] * ranges_[e];
      from_guessing += low;
      range[p * padded_shapes_ + s] = between;
    }
  auto all = sums(range, core_, padded_shapes_, matter);
  for (auto& p : all) p += from_guessing;
  return all;
}

/// Returns the expected entropy of the answer at each stimulus if the kept parameters (all but the nuisance
/// parameters) were known. It groups grid points with the same kept parameters, averages the probability of
/// the answer within each group, and returns the weighted mean of the groups' entropies. A group's weight,
/// and the part of its probability that comes from guessing, do not depend on the stimulus.
std::vector<double> Posterior::kept_entropies(const std::vector<std::size_t>& matter) const {
  std::vector<double> weight(groups_), guess_part(groups_), entropies;
  for (std::size_t i = 0; i < size();)
    for (std::size_t e = 0; e < ends_; ++e, ++i) {
      weight[kept_[i]] += weights_[i];
      guess_part[kept_[i]] += weights_[i] * guesses_[e];
    }
  std::vector<double> values(shapes_ * kAbreast), ones(groups_ * kAbreast);
  for (std::size_t first = 0; first < stimuli_.size(); first += kAbreast) {
    for (std::size_t i = 0; i < ones.size(); ++i) ones[i] = guess_part[i / kAbreast];
    for (const std::size_t p : matter) {
      for (std::size_t x = 0; x < kAbreast; ++x) {
        const double* core = &core_[row(std::min(first + x, stimuli_.size() - 1), p) * padded_shapes_];
        for (std::size_t s = 0; s < shapes_; ++s) values[s * kAbreast + x] = core[s];
      }
      const std::size_t point = p * shapes_ * ends_;
      add_to_groups(ones.data(), &kept_[point], &weights_[point], ranges_.data(), values.data(), shapes_,
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

double Posterior::predictive(std::size_t stimulus) const {
  return predictives(places_that_matter())[stimulus];
}

std::vector<double> Posterior::information() const {
  const auto matter = places_that_matter();
  auto information = predictives(matter);
  const auto given =
      kept_.empty() ? sums(weights_, entropy_, shapes_ * ends_, matter) : kept_entropies(matter);
  for (std::size_t x = 0; x < stimuli_.size(); ++x)
    information[x] = binary_entropy(information[x]) - given[x];
  return information;
}

std::size_t Posterior::best_stimulus() const {
  const auto all = information();
  return static_cast<std::size_t>(std::max_element(all.begin(), all.end()) - all.begin());
}

void Posterior::update(std::size_t stimulus, bool one) {
  double total = 0;
  for (std::size_t p = 0; p < places_; ++p)
    weigh(&weights_[p * shapes_ * ends_], total, guesses_.data(), ranges_.data(),
          &core_[row(stimulus, p) * padded_shapes_], shapes_, ends_, kFloor, one);
  const double scale = 1 / total;
  for (auto& weight : weights_) weight *= scale;
}

}  // namespace turnpoint::procedure

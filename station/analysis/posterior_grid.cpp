#include "station/analysis/posterior_grid.hpp"

#include <algorithm>
#include <cmath>

#include "station/analysis/likelihood.hpp"

namespace turnpoint::analysis {

namespace {

/// A cell is left out of the next, finer grid if its profile log-likelihood is this far below the maximum.
/// For a normal likelihood that is 4.2 standard deviations.
constexpr double kNegligible_nats = 9;
/// The data exclude an end of the prior if the log-likelihood there is this far below the maximum: half the
/// 95 % point of chi squared with one degree of freedom.
constexpr double kNotExcluded_nats = 1.92;
constexpr int kMostRefinements = 16;
/// Number of cells for threshold, ln rate, lapse and guess. With a fitted guess the other parameters get
/// fewer cells, because each additional axis multiplies the size of the grid.
constexpr std::array<int, kParameters> kCoarse{24, 16, 3, 8}, kFine{96, 36, 4, 1},
    kFineWithGuess{64, 24, 3, 10};
constexpr int kProbabilityCells = 500, kMostCrossingCells = 4096;

Box with_counts(Box box, const std::array<int, kParameters>& counts) {
  for (std::size_t p = 0; p < kParameters; ++p) box[p].count = box[p].high > box[p].low ? counts[p] : 1;
  return box;
}

double extent(const Cells& cells) { return cells.high - cells.low; }

}  // namespace

PosteriorGrid::PosteriorGrid(Function function, Guess guess, const AxisCounts& counts, const Box& prior,
                             double falling_share)
    : function_(function), guess_(guess), counts_(counts), prior_(prior) {
  Box box = prior;
  for (int i = 0; i < kMostRefinements; ++i) {
    evaluate(with_counts(box, kCoarse));
    const Box next = narrowed();
    bool shrunk = false;
    for (std::size_t p = 0; p < kParameters; ++p) shrunk = shrunk || extent(next[p]) < 0.6 * extent(box[p]);
    box = next;
    if (!shrunk) break;
  }
  evaluate(with_counts(box, extent(box[at_guess]) > 0 ? kFineWithGuess : kFine));
  set_weights(falling_share);
}

double PosteriorGrid::rate(int cell) const { return std::exp(box_[at_rate].centre(cell)); }

std::size_t PosteriorGrid::stride(std::size_t parameter) const {
  std::size_t stride = 1;
  for (std::size_t p = kParameters - 1; p > parameter; --p) stride *= static_cast<std::size_t>(box_[p].count);
  return stride;
}

std::vector<PosteriorGrid::Asymptotes> PosteriorGrid::asymptotes() const {
  std::vector<Asymptotes> all;
  for (int l = 0; l < box_[at_lapse].count; ++l)
    for (int g = 0; g < box_[at_guess].count; ++g) {
      const double lapse = box_[at_lapse].centre(l);
      const double low = guess_ == Guess::tied_to_lapse ? lapse : box_[at_guess].centre(g);
      all.push_back({low, 1 - low - lapse});
    }
  return all;
}

void PosteriorGrid::evaluate(const Box& box) {
  box_ = box;
  ends_ = asymptotes();
  log_likelihood_.clear();
  std::vector<double> between(counts_.u.size());
  for (int t = 0; t < box[at_threshold].count; ++t)
    for (int r = 0; r < box[at_rate].count; ++r) {
      for (std::size_t i = 0; i < between.size(); ++i)
        between[i] = sigmoid(function_, rate(r) * (counts_.u[i] - box[at_threshold].centre(t)));
      add_log_likelihoods(between);
    }
}

/// Adds up the log-likelihood of the data for each pair of asymptotes. `between` holds the value of the
/// psychometric function at each level, without guess and lapse.
void PosteriorGrid::add_log_likelihoods(const std::vector<double>& between) {
  for (const auto& ends : ends_) {
    double sum = 0;
    for (std::size_t i = 0; i < between.size(); ++i) {
      const double p =
          std::clamp(ends.low + ends.range * between[i], kProbabilityFloor, 1 - kProbabilityFloor);
      const double misses = counts_.trials[i] - counts_.positive[i];
      if (counts_.positive[i] > 0) sum += counts_.positive[i] * std::log(p);
      if (misses > 0) sum += misses * std::log(1 - p);
    }
    log_likelihood_.push_back(sum);
  }
}

/// Returns the box for the next, finer grid: the cells that are not negligible, and one more cell on each
/// side. The box keeps at least half the width of the previous one, because the maximum may lie outside the
/// cell with the highest likelihood if cells are far wider than the posterior.
Box PosteriorGrid::narrowed() const {
  Box box = box_;
  for (std::size_t p = 0; p < kParameters; ++p) {
    const auto count = static_cast<std::size_t>(box_[p].count);
    std::vector<double> profile(count, -1e300);
    for (std::size_t i = 0; i < log_likelihood_.size(); ++i) {
      auto& entry = profile[i / stride(p) % count];
      entry = std::max(entry, log_likelihood_[i]);
    }
    const double least = *std::max_element(profile.begin(), profile.end()) - kNegligible_nats;
    int first = 0, last = box_[p].count - 1;
    while (profile[static_cast<std::size_t>(first)] < least) ++first;
    while (profile[static_cast<std::size_t>(last)] < least) --last;
    first = std::max(first - 1, 0), last = std::min(last + 1, box_[p].count - 1);
    while (2 * (last - first + 1) < box_[p].count) {
      if (first > 0) --first;
      if (last < box_[p].count - 1) ++last;
    }
    box[p].low = box_[p].edge(first);
    box[p].high = box_[p].edge(last + 1);
  }
  return box;
}

/// Returns the prior density of a cell, relative to the flat part of the prior.
double PosteriorGrid::prior_density(Parameter parameter, int cell, double falling_share) const {
  const double falling = falling_share * extent(prior_[parameter]), at = box_[parameter].centre(cell);
  const double inside = std::min(at - prior_[parameter].low, prior_[parameter].high - at);
  return inside < falling ? inside / falling : 1;
}

void PosteriorGrid::set_weights(double falling_share) {
  const double best = *std::max_element(log_likelihood_.begin(), log_likelihood_.end());
  for (const double value : log_likelihood_) flat_.push_back(std::exp(value - best));
  double total = 0;
  for (int t = 0; t < box_[at_threshold].count; ++t)
    for (int r = 0; r < box_[at_rate].count; ++r) {
      const double density =
          prior_density(at_threshold, t, falling_share) * prior_density(at_rate, r, falling_share);
      for (std::size_t e = 0; e < ends_.size(); ++e)
        total += weight_.emplace_back(density * flat_[weight_.size()]);
    }
  for (auto& weight : weight_) weight /= total;
}

Marginal PosteriorGrid::marginal(Parameter parameter) const { return marginal(parameter, weight_); }

Marginal PosteriorGrid::marginal(Parameter parameter, const std::vector<double>& weights) const {
  const auto count = static_cast<std::size_t>(box_[parameter].count), step = stride(parameter);
  std::vector<double> mass(count);
  for (std::size_t i = 0; i < weights.size(); ++i) mass[i / step % count] += weights[i];
  return {box_[parameter], std::move(mass)};
}

std::optional<Marginal> PosteriorGrid::marginal_of_crossing(double p) const {
  // For each rate and pair of asymptotes: the distance from the threshold to the point where the probability
  // is p.
  std::vector<std::optional<double>> shifts;
  double least = 1e300, most = -1e300, held = 0;
  for (int r = 0; r < box_[at_rate].count; ++r)
    for (const auto& ends : ends_) {
      const double inside = (p - ends.low) / ends.range;
      auto& shift = shifts.emplace_back();
      if (!(inside > 0 && inside < 1)) continue;
      shift = sigmoid_inverse(function_, inside) / rate(r);
      least = std::min(least, *shift), most = std::max(most, *shift);
    }
  if (least > most) return std::nullopt;
  const auto& thresholds = box_[at_threshold];
  Cells cells{thresholds.low + least - thresholds.width(), thresholds.high + most + thresholds.width(), 1};
  cells.count = std::clamp(static_cast<int>(extent(cells) / thresholds.width()) + 1, 2, kMostCrossingCells);
  std::vector<double> mass(static_cast<std::size_t>(cells.count));
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    const auto& shift = shifts[i % shifts.size()];
    if (!shift) continue;
    // Divide the weight between the two nearest cells in such a way that the mean level does not change.
    const double level = thresholds.centre(static_cast<int>(i / shifts.size())) + *shift;
    const double at = std::max(0.0, (level - cells.low) / cells.width() - 0.5);
    const auto cell = std::min(static_cast<std::size_t>(at), mass.size() - 2);
    const double share = at - static_cast<double>(cell);
    mass[cell] += (1 - share) * weight_[i];
    mass[cell + 1] += share * weight_[i];
    held += weight_[i];
  }
  if (held < 0.5) return std::nullopt;
  return Marginal(cells, std::move(mass));
}

Marginal PosteriorGrid::marginal_of_probability(double u) const {
  std::vector<double> mass(kProbabilityCells);
  const double* weight = weight_.data();
  for (int t = 0; t < box_[at_threshold].count; ++t)
    for (int r = 0; r < box_[at_rate].count; ++r) {
      const double between = sigmoid(function_, rate(r) * (u - box_[at_threshold].centre(t)));
      for (const auto& ends : ends_) {
        const auto cell = static_cast<int>((ends.low + ends.range * between) * kProbabilityCells);
        mass[static_cast<std::size_t>(std::clamp(cell, 0, kProbabilityCells - 1))] += *weight++;
      }
    }
  return {{0, 1, kProbabilityCells}, std::move(mass)};
}

bool PosteriorGrid::open_low(Parameter parameter) const {
  const auto of = marginal(parameter, flat_);
  const double least = *std::max_element(of.mass().begin(), of.mass().end()) * std::exp(-kNotExcluded_nats);
  return of.cells().low <= prior_[parameter].low && of.mass().front() >= least;
}

bool PosteriorGrid::open_high(Parameter parameter) const {
  const auto of = marginal(parameter, flat_);
  const double least = *std::max_element(of.mass().begin(), of.mass().end()) * std::exp(-kNotExcluded_nats);
  return of.cells().high >= prior_[parameter].high && of.mass().back() >= least;
}

}  // namespace turnpoint::analysis

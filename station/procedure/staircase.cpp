#include "station/procedure/staircase.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "station/procedure/state_hash.hpp"
#include "station/random/elementary.hpp"

namespace turnpoint::procedure {

namespace {

constexpr int kRepeats = 3, kSpentAtMost = 20;
constexpr double kLargest = 1e300, kSmallest = 1e-300;
/// e to this is the most that one step multiplies by; the limits above hold the product.
constexpr double kLargestExponent = 690;

double factor(double exponent) {
  return random::exp(std::clamp(exponent, -kLargestExponent, kLargestExponent));
}

}  // namespace

Staircase::Staircase(const Spec& spec, const Context&) : spec_(spec), level_(spec.start.value_or(0)) {
  steps_down_ = spec.step_down.empty() ? spec.step : spec.step_down;
  steps_up_ = spec.step_up.empty() ? spec.step : spec.step_up;
  if (spec.kind == Kind::weighted_up_down) {
    // The balance p S_down = (1 - p) S_up holds where the probability of a step down is p.
    const double ratio = *spec.target / (1 - *spec.target);
    if (spec.step_up.empty())
      for (steps_up_ = steps_down_; auto& step : steps_up_) step *= ratio;
    if (spec.step_down.empty() && spec.step.empty())
      for (steps_down_ = steps_up_; auto& step : steps_down_) step /= ratio;
  }
}

bool Staircase::done() const {
  const auto& stop = spec_.stop;
  if (stop.min_trials && recorded_ + spent_ < *stop.min_trials) return false;
  const bool by_trials = stop.trials ? recorded_ + spent_ >= *stop.trials : spent_ >= kSpentAtMost;
  const bool by_reversals = stop.reversals && static_cast<int>(reversals_.size()) >= *stop.reversals;
  if (stop.rule == StopRule::any) return by_trials || by_reversals;
  return spent_ >= kSpentAtMost || ((!stop.trials || by_trials) && (!stop.reversals || by_reversals));
}

std::optional<Proposal> Staircase::next() const {
  if (done()) return std::nullopt;
  return Proposal{level_, {}};
}

double Staircase::step(const std::vector<double>& steps) const {
  return steps[std::min(reversals_.size(), steps.size() - 1)];
}

void Staircase::move(Direction direction) {
  if (direction_ != Direction::none && direction != direction_) reversals_.push_back(level_);
  direction_ = direction;
  const double size = direction == Direction::down ? -step(steps_down_) : step(steps_up_);
  switch (spec_.scale) {
    case Scale::linear:
      level_ += size;
      break;
    case Scale::log10:
      level_ *= factor(size * 2.302585092994045684);
      break;
    case Scale::dB:
      level_ *= factor(size * 0.11512925464970228420);
      break;
  }
  // Without limits of its own a staircase still stays a number, far beyond any unit.
  const bool multiplies = spec_.scale != Scale::linear;
  level_ = std::clamp(level_, multiplies ? kSmallest : -kLargest, kLargest);
  if (spec_.min) level_ = std::max(level_, *spec_.min);
  if (spec_.max) level_ = std::min(level_, *spec_.max);
}

void Staircase::record(Answer answer) {
  if (answer == Answer::none) {
    // The same level again, but nobody is asked for ever: after three repeats a trial of the budget is spent.
    if (++unanswered_ > kRepeats) unanswered_ = 0, ++spent_;
    return;
  }
  unanswered_ = 0;
  ++recorded_;
  answers_.push_back(answer);
  const bool initial = spec_.initial_down && reversals_.empty() && direction_ != Direction::up;
  const int n_down = initial ? *spec_.initial_down : spec_.n_down;
  if (answer == Answer::one) {
    zeros_ = 0;
    if (++ones_ >= n_down) ones_ = 0, move(Direction::down);
  } else {
    ones_ = 0;
    if (++zeros_ >= spec_.n_up) zeros_ = 0, move(Direction::up);
  }
}

int Staircase::expected() const {
  if (spec_.stop.trials) return std::max(*spec_.stop.trials, recorded_);
  return std::max(recorded_, 6 * spec_.stop.reversals.value_or(1));
}

std::map<std::string, Estimate> Staircase::estimates() const {
  // One more is left out where the count is odd: as many peaks as valleys.
  const auto discarded = static_cast<std::size_t>(spec_.discard_reversals);
  if (reversals_.size() < discarded + 2) return {};
  const std::size_t first = discarded + (reversals_.size() - discarded) % 2;
  const bool logs = spec_.scale != Scale::linear;
  double sum = 0, squares = 0;
  const auto n = static_cast<double>(reversals_.size() - first);
  for (std::size_t i = first; i < reversals_.size(); ++i) {
    const double value = logs ? std::log(reversals_[i]) : reversals_[i];
    sum += value, squares += value * value;
  }
  const double mean = sum / n;
  const double sd = std::sqrt(std::max(0.0, squares / n - mean * mean));
  Estimate estimate;
  estimate.mean = estimate.mode = logs ? std::exp(mean) : mean;
  estimate.sd = logs ? estimate.mean * sd : sd;
  const auto count = std::to_string(reversals_.size());
  estimate.basis = "reversals " + std::to_string(first + 1) + " to " + count + " of " + count;
  return {{"threshold", estimate}};
}

std::uint64_t Staircase::state_hash() const {
  StateHash hash;
  for (const auto answer : answers_) hash.add(static_cast<std::uint64_t>(answer));
  hash.add(reversals_.size());
  hash.add(static_cast<std::uint64_t>(8 * spent_ + unanswered_));
  return hash.value();
}

}  // namespace turnpoint::procedure

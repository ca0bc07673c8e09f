#include "station/procedure/track.hpp"

#include <algorithm>

#include "station/procedure/state_hash.hpp"
#include "station/random/elementary.hpp"

namespace turnpoint::procedure {

namespace {

constexpr double kLargest = 1e300, kSmallest = 1e-300;
/// A step multiplies the level by exp(exponent). This limit of the exponent keeps the factor finite.
constexpr double kLargestExponent = 690;

double factor(double exponent) {
  return random::exp(std::clamp(exponent, -kLargestExponent, kLargestExponent));
}

}  // namespace

Track::Track(const Spec& spec) : spec_(spec), level_(spec.start.value_or(0)) {}

bool Track::done() const {
  const auto& stop = spec_.stop;
  if (stop.min_trials && recorded_ + spent_ < *stop.min_trials) return false;
  const bool by_trials = stop.trials ? recorded_ + spent_ >= *stop.trials : spent_ >= kSpentAtMost;
  const bool by_right =
      enough_right(stop, answers_.size(), [this](std::size_t i) { return answers_[i] == Answer::one; });
  const bool by_reversals = stop.reversals && static_cast<int>(reversals_.size()) >= *stop.reversals;
  if (stop.rule == StopRule::any) return by_trials || by_reversals || by_right;
  return spent_ >= kSpentAtMost ||
         ((!stop.trials || by_trials) && (!stop.reversals || by_reversals) && (!stop.right || by_right));
}

std::optional<Proposal> Track::next() const {
  if (done()) return std::nullopt;
  return Proposal{level_, {}};
}

void Track::record(Answer answer) {
  if (answer == Answer::none) {
    if (++unanswered_ > kRepeatsInARow) unanswered_ = 0, ++spent_;
    return;
  }
  unanswered_ = 0;
  ++recorded_;
  answers_.push_back(answer);
  learn(answer);
}

void Track::turn(Direction direction) {
  if (direction_ != Direction::none && direction != direction_) reversals_.push_back(level_);
  direction_ = direction;
}

void Track::move(double size) {
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
  // These limits keep the level finite if the protocol sets none. They lie far beyond any useful level.
  const bool multiplies = spec_.scale != Scale::linear;
  level_ = std::clamp(level_, multiplies ? kSmallest : -kLargest, kLargest);
  if (spec_.min) level_ = std::max(level_, *spec_.min);
  if (spec_.max) level_ = std::min(level_, *spec_.max);
}

int Track::expected() const {
  if (spec_.stop.trials) return std::max(*spec_.stop.trials, recorded_);
  return std::max(recorded_, 6 * spec_.stop.reversals.value_or(1));
}

std::uint64_t Track::state_hash() const {
  StateHash hash;
  for (const auto answer : answers_) hash.add(static_cast<std::uint64_t>(answer));
  hash.add(reversals_.size());
  hash.add(static_cast<std::uint64_t>(8 * spent_ + unanswered_));
  return hash.value();
}

}  // namespace turnpoint::procedure

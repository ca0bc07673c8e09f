#include "station/procedure/track.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "station/core/elementary.hpp"
#include "station/procedure/grid.hpp"
#include "station/procedure/state_hash.hpp"

namespace turnpoint::procedure {

namespace {

constexpr double kLargest = 1e300, kSmallest = 1e-300;
/// A step multiplies the level by exp(exponent). This limit of the exponent keeps the factor finite.
constexpr double kLargestExponent = 690;
constexpr double kLogOfTen = 2.302585092994045684;
/// A level that is beyond a limit by less than this fraction of a step is at the limit.
constexpr double kRungSlack = 1e-6;
/// Farthest way from the start, in units of the steps' last decimal place.
constexpr double kFarthest = 1e15;

/// The logarithm of the factor by which a step of 1 multiplies the level.
double per_step(Scale scale) { return scale == Scale::dB ? kLogOfTen / 20 : kLogOfTen; }

double factor(double exponent) {
  return core::exp(std::clamp(exponent, -kLargestExponent, kLargestExponent));
}

}  // namespace

Ladder::Ladder(const Spec& spec, const std::vector<double>& steps)
    : scale_(spec.scale), start_(spec.start.value_or(0)), min_(spec.min), max_(spec.max) {
  const bool linear = scale_ == Scale::linear;
  auto decimals = steps;
  if (linear) decimals.push_back(start_);
  per_one_ = decimal_places(decimals);
  if (per_one_ == 0) {
    sizes_ = steps;
    counts_.assign(sizes_.size(), 0);
    return;
  }
  common_ = 0;
  for (const double step : steps) common_ = std::gcd(common_, std::llround(step * per_one_));
  common_ = std::max<std::int64_t>(common_, 1);
  const auto commons_to = [&](double limit) {
    const double way = linear ? limit - start_ : core::log(limit / start_) / per_step(scale_);
    const double farthest = kFarthest / static_cast<double>(common_);
    return std::clamp(way * per_one_ / static_cast<double>(common_), -farthest, farthest);
  };
  // A limit that a multiplying scale cannot reach (0 or less) is no limit to it.
  if (min_ && (linear || *min_ > 0))
    lowest_ = common_ * static_cast<std::int64_t>(std::ceil(commons_to(*min_) - kRungSlack));
  if (max_ && (linear || *max_ > 0))
    highest_ = common_ * static_cast<std::int64_t>(std::floor(commons_to(*max_) + kRungSlack));
}

double Ladder::level() const {
  double way = 0;
  for (std::size_t i = 0; i < sizes_.size(); ++i) way += static_cast<double>(counts_[i]) * sizes_[i];
  if (per_one_ > 0) way = static_cast<double>(units_) / per_one_;
  double level = 0;
  if (scale_ != Scale::linear)
    level = way == 0 ? start_ : std::clamp(start_ * factor(way * per_step(scale_)), kSmallest, kLargest);
  else if (per_one_ > 0)
    level = static_cast<double>(std::llround(start_ * per_one_) + units_) / per_one_;
  else
    level = start_ + way;
  // Whole steps may miss a limit that they should meet by a rounding error.
  if (min_) level = std::max(level, *min_);
  if (max_) level = std::min(level, *max_);
  return level;
}

bool Ladder::move(double step, bool upwards) {
  const double before = level();
  if (per_one_ > 0) {
    const auto units = std::llround(step * per_one_);
    units_ += upwards ? units : -units;
    // These limits keep the level finite if the protocol sets none. They lie far beyond any useful level.
    const auto farthest = static_cast<std::int64_t>(kFarthest);
    units_ = std::clamp(units_, lowest_.value_or(-farthest), highest_.value_or(farthest));
    return level() != before;
  }
  const auto found = std::find(sizes_.begin(), sizes_.end(), step);
  if (found == sizes_.end()) throw std::logic_error("track: a step that is not among the track's steps");
  counts_[static_cast<std::size_t>(found - sizes_.begin())] += upwards ? 1 : -1;
  const double after = level();
  if ((min_ && after <= *min_) || (max_ && after >= *max_)) {
    start_ = after;
    counts_.assign(sizes_.size(), 0);
  }
  return after != before;
}

Track::Track(const Spec& spec, const std::vector<double>& steps)
    : spec_(spec), level_(spec.start.value_or(0)), ladder_(spec, steps) {}

bool Track::rules_met() const {
  const auto& stop = spec_.stop;
  if (stop.min_trials && recorded_ + spent_ < *stop.min_trials) return false;
  const bool by_trials = stop.trials && recorded_ + spent_ >= *stop.trials;
  const bool by_right =
      enough_right(stop, answers_.size(), [this](std::size_t i) { return answers_[i] == Answer::one; });
  const bool by_reversals = stop.reversals && static_cast<int>(reversals_.size()) >= *stop.reversals;
  if (stop.rule == StopRule::any) return by_trials || by_reversals || by_right;
  return (!stop.trials || by_trials) && (!stop.reversals || by_reversals) && (!stop.right || by_right);
}

Ended Track::ended() const {
  if (rules_met()) return Ended::rule;
  if (stopped_ >= steps_at_limit(spec_.stop)) return Ended::limit;
  if (recorded_ + spent_ >= most_trials(spec_.stop)) return Ended::most;
  const bool counted = spec_.stop.trials && spec_.stop.rule == StopRule::any;
  return spent_ >= kSpentAtMost && !counted ? Ended::unanswered : Ended::no;
}

std::optional<Proposal> Track::next() const {
  if (ended() != Ended::no) return std::nullopt;
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

void Track::count_stopped(bool moved) { stopped_ = moved ? 0 : stopped_ + 1; }

void Track::step(double size, Direction direction) {
  count_stopped(ladder_.move(size, direction == Direction::up));
  level_ = ladder_.level();
}

void Track::move(double amount) {
  const double before = level_;
  if (spec_.scale == Scale::linear)
    level_ += amount;
  else
    level_ *= factor(amount * per_step(spec_.scale));
  // These limits keep the level finite if the protocol sets none. They lie far beyond any useful level.
  const bool multiplies = spec_.scale != Scale::linear;
  level_ = std::clamp(level_, multiplies ? kSmallest : -kLargest, kLargest);
  if (spec_.min) level_ = std::max(level_, *spec_.min);
  if (spec_.max) level_ = std::min(level_, *spec_.max);
  count_stopped(level_ != before);
}

std::optional<core::Phrase> Track::end() const {
  const auto how = ended();
  return end_in_words(how, spec_.name, how == Ended::limit ? stopped_ : recorded_ + spent_);
}

std::string Track::with_end(std::string basis) const {
  if (const auto how = end()) basis += "; ended early: " + core::say(*how, "en");
  return basis;
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
  if (stopped_ > 0) hash.add(static_cast<std::uint64_t>(stopped_));
  return hash.value();
}

}  // namespace turnpoint::procedure

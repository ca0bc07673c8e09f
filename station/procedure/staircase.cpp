#include "station/procedure/staircase.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include "station/procedure/description.hpp"
#include "station/procedure/keys.hpp"

namespace turnpoint::procedure {

using core::phrase, core::plain;

namespace {

/// The sizes of the steps in each direction.
std::pair<std::vector<double>, std::vector<double>> step_sizes(const Spec& spec) {
  auto down = spec.step_down.empty() ? spec.step : spec.step_down;
  auto up = spec.step_up.empty() ? spec.step : spec.step_up;
  if (spec.kind == Kind::weighted_up_down) {
    // At the target level, an answer of 1 has the probability `target` and causes a step down. Steps balance
    // there if target * step_down = (1 - target) * step_up.
    const double ratio = *spec.target / (1 - *spec.target);
    if (spec.step_up.empty())
      for (up = down; auto& step : up) step *= ratio;
    if (spec.step_down.empty() && spec.step.empty())
      for (down = up; auto& step : down) step /= ratio;
  }
  return {down, up};
}

/// The sizes of the steps upwards after an answer of those who do not want to guess: the mean step after a
/// guess (Kaernbach 2001). With it, the steps balance at the same level as if they had guessed.
std::vector<double> unsure_steps(const Spec& spec) {
  const auto [down, up] = step_sizes(spec);
  std::vector<double> steps;
  if (!spec.guess_rate || spec.kind != Kind::weighted_up_down) return steps;
  for (std::size_t i = 0; i < std::min(down.size(), up.size()); ++i)
    steps.push_back((1 - *spec.guess_rate) * up[i] - *spec.guess_rate * down[i]);
  return steps;
}

std::vector<double> all_steps(const Spec& spec) {
  auto [all, up] = step_sizes(spec);
  all.insert(all.end(), up.begin(), up.end());
  const auto unsure = unsure_steps(spec);
  all.insert(all.end(), unsure.begin(), unsure.end());
  return all;
}

}  // namespace

Staircase::Staircase(const Spec& spec) : Track(spec, all_steps(spec)) {
  std::tie(steps_down_, steps_up_) = step_sizes(spec);
  steps_unsure_ = unsure_steps(spec);
}

void Staircase::step_towards(Direction direction) {
  step_towards(direction, direction == Direction::down ? steps_down_ : steps_up_);
}

void Staircase::step_towards(Direction direction, const std::vector<double>& sizes) {
  turn(direction);
  step(sizes[std::min(reversals_.size(), sizes.size() - 1)], direction);
}

void Staircase::learn(Answer answer) {
  const bool initial = spec_.initial_down && reversals_.empty() && direction_ != Direction::up;
  const int n_down = initial ? *spec_.initial_down : spec_.n_down;
  if (answer == Answer::unsure && !steps_unsure_.empty()) {
    ones_ = zeros_ = 0;
    step_towards(Direction::up, steps_unsure_);
  } else if (answer == Answer::one) {
    zeros_ = 0;
    if (++ones_ >= n_down) ones_ = 0, step_towards(Direction::down);
  } else {
    ones_ = 0;
    if (++zeros_ >= spec_.n_up) zeros_ = 0, step_towards(Direction::up);
  }
}

std::map<std::string, Estimate> Staircase::estimates() const {
  // Use an even number of reversals, so that there are as many peaks as valleys. If the number is odd, leave
  // out one more.
  const auto discarded = static_cast<std::size_t>(spec_.discard_reversals);
  if (reversals_.size() < discarded + 2) return {};
  const std::size_t first = discarded + (reversals_.size() - discarded) % 2;
  const bool logs = spec_.scale != Scale::linear;
  std::vector<double> values(reversals_.begin() + static_cast<std::ptrdiff_t>(first), reversals_.end());
  if (logs)
    for (double& value : values) value = std::log(value);
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const double sd = std::sqrt(squares / (n - 1));
  Estimate estimate;
  estimate.mean = estimate.mode = logs ? std::exp(mean) : mean;
  estimate.sd = logs ? estimate.mean * sd : sd;
  const auto count = std::to_string(reversals_.size());
  estimate.basis = "reversals " + std::to_string(first + 1) + " to " + count + " of " + count;
  estimate.basis = with_end(std::move(estimate.basis));
  return {{"threshold", estimate}};
}

namespace {

core::Keys staircase_keys(const core::Keys& of_this_kind) {
  using namespace core::key;
  core::Keys keys{tracks_key()};
  keys.and_also(span_keys());
  keys.and_also(
      {numbers("step", positive_step,
               "step sizes in both directions: each reversal moves on to the next, and the last stays"),
       numbers("step_down", positive_step,
               "step sizes down, if those up differ; weighted-up-down needs these only")});
  keys.and_also(of_this_kind);
  return keys.and_also(
      {integer("discard_reversals", 0, 1000,
               "first reversals that the estimate leaves out; 4 if the start is far from the threshold")
           .by_default("0"),
       scale_key(), track_stop_key()});
}

core::Keys up_down_keys() {
  using namespace core::key;
  return staircase_keys(
      {numbers("step_up", positive_step, "step sizes up"),
       integer("n_down", 1, 20, "right answers in a row that lower the level").required(),
       integer("n_up", 1, 20, "wrong answers in a row that raise the level").by_default("1"),
       integer("initial_down", 1, 20, "`n_down` before the first reversal").without_it("`n_down`")});
}

core::Keys weighted_keys() { return staircase_keys({target_key()}); }

void read_steps(core::TableReader& reader, Spec& spec) {
  spec.step = reader.maybe_numbers("step");
  spec.step_down = reader.maybe_numbers("step_down");
  if (spec.kind == Kind::up_down) spec.step_up = reader.maybe_numbers("step_up");
  if (reader.has("step") == reader.has("step_down"))
    reader.findings().add(reader.has("step") ? reader.place("step_down") : reader.place("step_up"),
                          reader.has("step")
                              ? phrase("%1 has both \"step\" and \"step_down\"", {reader.title()})
                              : phrase("%1 has no steps", {reader.title()}),
                          phrase("give either \"step\" (for both directions) or \"step_down\""));
}

void read_staircase(core::TableReader& reader, Spec& spec) {
  read_tracks(reader, spec);
  read_scale(reader, spec);
  read_span(reader, spec);
  read_steps(reader, spec);
  spec.discard_reversals = reader.integer("discard_reversals");
  if (spec.kind == Kind::up_down) {
    spec.n_down = reader.integer("n_down");
    spec.n_up = reader.integer("n_up");
    spec.initial_down = reader.maybe_integer("initial_down");
  } else {
    spec.target = reader.number("target");
  }
  read_stop(reader, spec);
}

void validate_staircase(const Spec& spec, std::vector<Problem>& problems) {
  validate_span(spec, problems);
  if (spec.step.empty() && spec.step_down.empty() && spec.step_up.empty())
    problems.push_back({"step_down", plain("missing"), phrase("give one or more steps above 0")});
  if (!positive(spec.step) || !positive(spec.step_down) || !positive(spec.step_up))
    problems.push_back({"step_down", phrase("every step must be above 0"), phrase("steps above 0")});
  if (spec.kind == Kind::weighted_up_down && (!spec.target || !(*spec.target > 0 && *spec.target < 1)))
    problems.push_back({"target", phrase("the target is missing, or not between 0 and 1"),
                        phrase("give a probability between 0 and 1")});
  if (spec.kind == Kind::up_down && (spec.n_down < 1 || spec.n_up < 1))
    problems.push_back({"n_down", phrase("below 1"), phrase("write whole numbers of 1 or more")});
  if (spec.kind == Kind::up_down && spec.step.empty() && (spec.step_down.empty() || spec.step_up.empty()))
    problems.push_back({"step", phrase("the step is missing for one direction"),
                        phrase("give step, or both step_down and step_up")});
  if (!spec.stop.trials && !spec.stop.reversals && !spec.stop.right)
    problems.push_back({"stop", phrase("no rule ends the procedure"), phrase("add trials or reversals")});
  if (spec.discard_reversals < 0 || (spec.stop.reversals && spec.stop.rule == StopRule::any &&
                                     spec.discard_reversals + 2 > *spec.stop.reversals))
    problems.push_back(
        {"discard_reversals", phrase("fewer than two reversals would be left to average"),
         phrase("it must be at least two less than the number of reversals at which the staircase stops")});
}

std::unique_ptr<Procedure> make_staircase(const Spec& spec, const Context&, const core::DrawKey&) {
  return std::make_unique<Staircase>(spec);
}

/// Returns the proportion of answers of 1 at which steps down and steps up balance (Garcia-Perez 1998). If
/// both steps are equal, it is 0.5^(1 / n_down).
std::optional<double> staircase_target(const Spec& spec, double, double) {
  if (spec.target) return spec.target;
  const auto& down = spec.step_down.empty() ? spec.step : spec.step_down;
  const auto& up = spec.step_up.empty() ? spec.step : spec.step_up;
  if (spec.n_up != 1 || down.empty() || up.empty()) return std::nullopt;
  return std::pow(up.back() / (up.back() + down.back()), 1.0 / spec.n_down);
}

}  // namespace

extern const Description up_down{"up-down",          Choice::track,  up_down_keys,    read_staircase,
                                 validate_staircase, make_staircase, staircase_target};

extern const Description weighted_up_down{"weighted-up-down", Choice::track,  weighted_keys,   read_staircase,
                                          validate_staircase, make_staircase, staircase_target};

}  // namespace turnpoint::procedure

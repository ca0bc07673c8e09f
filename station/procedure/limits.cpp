#include "station/procedure/limits.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "station/core/elementary.hpp"
#include "station/procedure/description.hpp"
#include "station/procedure/grid.hpp"
#include "station/procedure/keys.hpp"
#include "station/procedure/state_hash.hpp"

namespace turnpoint::procedure {

using core::phrase, core::plain;

namespace {

constexpr int kMostUnanswered = 3;
/// Levels that are beyond a limit by less than this fraction of a step are rounding errors.
constexpr double kSlack = 1e-6;
constexpr double kLogOf10 = 2.302585092994045684;

/// The difference on a scale (in dB or log10 units) between two levels of which one is e times the other.
double per_e(Scale scale) { return scale == Scale::dB ? 20 / kLogOf10 : 1 / kLogOf10; }

/// Returns the position of a level on the scale on which the steps are counted.
double position_of(double level, Scale scale) {
  return scale == Scale::linear ? level : per_e(scale) * core::log(level);
}

double level_at(double position, Scale scale) {
  return scale == Scale::linear ? position : core::exp(position / per_e(scale));
}

double gap(double low, double high, Scale scale) {
  return position_of(high, scale) - position_of(low, scale);
}

}  // namespace

std::vector<double> levels_of_series(const Spec& spec, std::size_t most) {
  const bool listed = !spec.ascending.uniform && !spec.descending.uniform;
  if (!listed || spec.step.empty() || !(spec.step.front() > 0) || !spec.min || !spec.max) return {};
  std::vector<double> given{*spec.min, *spec.max};
  given.insert(given.end(), spec.ascending.values.begin(), spec.ascending.values.end());
  given.insert(given.end(), spec.descending.values.begin(), spec.descending.values.end());
  if (spec.scale != Scale::linear && *std::min_element(given.begin(), given.end()) <= 0) return {};
  const double step = spec.step.front(), slack = kSlack * step;
  const double lowest = position_of(*spec.min, spec.scale), highest = position_of(*spec.max, spec.scale);
  std::vector<double> positions;
  const auto add_series = [&](double start, int way) {
    const double from = position_of(start, spec.scale);
    for (std::size_t k = 0; k <= most; ++k) {
      const double at = at_step(from, way * static_cast<std::int64_t>(k), step);
      if (at < lowest - slack || at > highest + slack) break;
      positions.push_back(at);
    }
  };
  for (const double start : spec.ascending.values) add_series(start, 1);
  for (const double start : spec.descending.values) add_series(start, -1);
  std::sort(positions.begin(), positions.end());
  const auto same = [slack](double a, double b) { return b - a <= slack; };
  positions.erase(std::unique(positions.begin(), positions.end(), same), positions.end());
  if (positions.size() > most) return {};
  for (double& at : positions) at = std::clamp(level_at(at, spec.scale), *spec.min, *spec.max);
  return positions;
}

Limits::Limits(const Spec& spec, const core::DrawKey& key) : spec_(spec) {
  core::Draws draws({key.seed, core::Stream::level_order, key.block, key.attempt, 0});
  const bool up = !spec.ascending.empty(), down = !spec.descending.empty();
  std::vector<Direction> order;
  const bool down_first = !up || (down && draws.below(2) == 1);
  for (int i = 0; i < spec.series; ++i)
    order.push_back((up && down ? (i % 2 == 1) != down_first : down) ? Direction::down : Direction::up);
  if (spec.directions == Directions::random) draws.shuffle(order);
  for (const auto direction : order) series_.push_back({direction, 0, {}});
  set_starts(Direction::up, spec.ascending, draws);
  set_starts(Direction::down, spec.descending, draws);
}

/// Uses each listed start equally often, in shuffled order. If the number of series is not a multiple of the
/// number of starts, some starts are used once more; these are drawn at random.
void Limits::set_starts(Direction direction, const SeriesStarts& starts, core::Draws& draws) {
  std::vector<double> bag;
  for (auto& series : series_) {
    if (series.direction != direction) continue;
    if (starts.uniform) {
      series.start = draws.uniform(starts.uniform->first, starts.uniform->second);
      continue;
    }
    if (bag.empty()) {
      bag = starts.values;
      draws.shuffle(bag);
    }
    series.start = bag.back();
    bag.pop_back();
  }
}

double Limits::position_after(int steps) const {
  const auto& series = series_[current_];
  const int way = series.direction == Direction::up ? steps : -steps;
  return at_step(position_of(series.start, spec_.scale), way, spec_.step.front());
}

bool Limits::inside(double position) const {
  const double slack = kSlack * spec_.step.front();
  return position >= position_of(*spec_.min, spec_.scale) - slack &&
         position <= position_of(*spec_.max, spec_.scale) + slack;
}

std::optional<Proposal> Limits::next() const {
  if (current_ >= series_.size()) return std::nullopt;
  const double level = steps_ == 0 ? series_[current_].start : level_at(position_after(steps_), spec_.scale);
  return Proposal{std::clamp(level, *spec_.min, *spec_.max), {}};
}

void Limits::end_series(const std::optional<double>& midpoint) {
  series_[current_].midpoint = midpoint;
  ++current_;
  steps_ = changed_ = unanswered_ = 0;
}

void Limits::record(Answer answer) {
  if (current_ >= series_.size()) return;
  if (answer == Answer::none) {
    if (++unanswered_ > kMostUnanswered) end_series(std::nullopt);
    return;
  }
  unanswered_ = 0;
  answers_.push_back(answer);
  const bool going_up = series_[current_].direction == Direction::up;
  changed_ = (answer == Answer::one) == going_up ? changed_ + 1 : 0;
  if (changed_ >= spec_.n_change) {
    const int first_new = steps_ - spec_.n_change + 1;
    if (first_new == 0) return end_series(std::nullopt);
    return end_series(0.5 * (position_after(first_new - 1) + position_after(first_new)));
  }
  if (!inside(position_after(++steps_))) end_series(std::nullopt);
}

int Limits::expected() const {
  if (current_ >= series_.size()) return recorded();
  const auto left = static_cast<double>(series_.size() - current_) / static_cast<double>(series_.size());
  return recorded() + std::max(1, static_cast<int>(std::lround(left * series_trials(spec_))) - steps_);
}

Limits::Mean Limits::mean_of(Direction direction) const {
  Mean mean;
  double squares = 0;
  for (std::size_t i = 0; i < current_; ++i) {
    if (series_[i].direction != direction) continue;
    ++mean.ended;
    if (!series_[i].midpoint) continue;
    // update the mean and the sum of squares by Welford's method
    const double off = *series_[i].midpoint - mean.position;
    mean.position += off / ++mean.used;
    squares += off * (*series_[i].midpoint - mean.position);
  }
  if (mean.used > 1) mean.variance = squares / (mean.used - 1) / mean.used;
  return mean;
}

Estimate Limits::estimate_of(const Mean& mean, const std::string& kind) const {
  Estimate estimate;
  estimate.mean = estimate.mode = level_at(mean.position, spec_.scale);
  if (mean.variance) {
    const double error = std::sqrt(*mean.variance);
    estimate.sd = spec_.scale == Scale::linear ? error : estimate.mean * error / per_e(spec_.scale);
  }
  estimate.basis = "midpoints of " + std::to_string(mean.used);
  if (mean.used < mean.ended) estimate.basis += " of " + std::to_string(mean.ended);
  estimate.basis += " " + kind + "series";
  if (mean.variance) estimate.basis += "; SD is the standard error";
  return estimate;
}

std::map<std::string, Estimate> Limits::estimates() const {
  const auto up = mean_of(Direction::up), down = mean_of(Direction::down);
  std::map<std::string, Estimate> all;
  if (spec_.descending.empty() || spec_.ascending.empty()) {
    const bool ascends = spec_.descending.empty();
    const auto& only = ascends ? up : down;
    if (only.used > 0) all["threshold"] = estimate_of(only, ascends ? "ascending " : "descending ");
    return all;
  }
  if (up.used > 0) all["threshold ascending"] = estimate_of(up, "ascending ");
  if (down.used > 0) all["threshold descending"] = estimate_of(down, "descending ");
  if (up.used == 0 || down.used == 0) return all;
  Mean both{0.5 * (up.position + down.position), {}, up.used + down.used, up.ended + down.ended};
  if (up.variance && down.variance) both.variance = 0.25 * (*up.variance + *down.variance);
  all["threshold"] = estimate_of(both, "");
  auto difference = all["threshold"];  // a copy, because both use the same series
  const auto& above = all["threshold ascending"];
  const auto& below = all["threshold descending"];
  difference.mean = difference.mode = above.mean - below.mean;
  difference.sd = above.sd && below.sd
                      ? std::optional(std::sqrt(*above.sd * *above.sd + *below.sd * *below.sd))
                      : std::nullopt;
  all["threshold ascending - descending"] = difference;
  return all;
}

std::vector<double> Limits::reversals() const {
  std::vector<double> midpoints;
  for (const auto& series : series_)
    if (series.midpoint) midpoints.push_back(level_at(*series.midpoint, spec_.scale));
  return midpoints;
}

std::uint64_t Limits::state_hash() const {
  StateHash hash;
  for (const auto answer : answers_) hash.add(static_cast<std::uint64_t>(answer));
  for (const auto word : {static_cast<int>(current_), steps_, changed_, unanswered_})
    hash.add(static_cast<std::uint64_t>(word));
  for (std::size_t i = current_; i < series_.size(); ++i)
    hash.add(static_cast<std::uint64_t>(series_[i].direction));
  return hash.value();
}

double series_trials(const Spec& spec) {
  const auto reach = [](const SeriesStarts& starts) {
    return 0.5 * (starts.ends().first + starts.ends().second);
  };
  const double low = spec.ascending.empty() ? *spec.min : reach(spec.ascending);
  const double high = spec.descending.empty() ? *spec.max : reach(spec.descending);
  const double steps = 0.5 * gap(low, high, spec.scale) / spec.step.front();
  return spec.series * (std::max(1.0, steps) + spec.n_change);
}

namespace {

core::Keys limits_keys() {
  using namespace core::key;
  const auto starts = [](const char* name, const char* help) {
    return several(
        name,
        {numbers("", any_level, ""),
         table("", {interval("uniform", any_level, "each series draws its start between these").required()},
               "")},
        help);
  };
  core::Keys keys{string("tracks", "id of the answer that is more frequent at higher levels").required()};
  keys.and_also(range_keys());
  return keys.and_also(
      {step_key(),
       starts("start_ascending",
              "levels at which ascending series start: each is used equally often, or each series draws one"),
       starts("start_descending", "levels at which descending series start, in the same forms"),
       integer("series", 1, 1000, "number of series; with both directions, half of them each").required(),
       integer("n_change", 1, 20, "new answers in a row that end a series; with 2, a slip does not")
           .by_default("1"),
       word("directions", {"alternate", "random"},
            "the directions take turns (the first is drawn), or are shuffled, each equally often")
           .by_default("\"alternate\""),
       scale_key()});
}

SeriesStarts read_starts(core::TableReader& reader, const std::string& key) {
  const auto* value = reader.take(key);
  if (!value) return {};
  SeriesStarts starts;
  if (value->kind != core::Value::Kind::table) {
    starts.values = reader.numbers(key);
    return starts;
  }
  core::TableReader inner(*value, reader.path(key), reader.findings(), reader.keys(key));
  inner.require("uniform");
  starts.uniform = inner.maybe_interval("uniform");
  inner.finish();
  return starts;
}

void read_limits(core::TableReader& reader, Spec& spec) {
  spec.tracks = reader.string("tracks");
  read_scale(reader, spec);
  spec.ascending = read_starts(reader, "start_ascending");
  spec.descending = read_starts(reader, "start_descending");
  if (!reader.has("start_ascending") && !reader.has("start_descending"))
    reader.problem("start_ascending",
                   phrase("%1 says nowhere at which levels series start", {reader.title()}),
                   phrase("give \"start_ascending\", \"start_descending\" or both: a list of levels, or %1",
                          {plain("{ uniform = [low, high] }")}));
  spec.min = reader.number("min");
  spec.max = reader.number("max");
  spec.step = {reader.number("step")};
  spec.series = reader.integer("series");
  spec.n_change = reader.integer("n_change");
  spec.directions = reader.word("directions") == "random" ? Directions::random : Directions::alternate;
}

void validate_starts(const Spec& spec, std::vector<Problem>& problems) {
  const auto check = [&](const char* key, const SeriesStarts& starts, double end) {
    if (starts.empty()) return;
    const auto [low, high] = starts.ends();
    if (low < *spec.min || high > *spec.max)
      problems.push_back(
          {key, phrase("a series starts outside of min to max"), phrase("write levels between min and max")});
    else if (std::fabs(gap(end == *spec.max ? high : low, end, spec.scale)) <
             spec.step.front() * (spec.n_change - kSlack))
      problems.push_back({key, phrase("a series reaches its end before the answer can change"),
                          phrase("start at least n_change steps before the end")});
  };
  check("start_ascending", spec.ascending, *spec.max);
  check("start_descending", spec.descending, *spec.min);
  if (!spec.ascending.empty() && !spec.descending.empty() &&
      spec.ascending.ends().second >= spec.descending.ends().first)
    problems.push_back({"start_ascending", phrase("an ascending series starts above a descending one"),
                        phrase("ascending series start below the threshold, descending series above it")});
}

void validate_limits(const Spec& spec, std::vector<Problem>& problems) {
  if (spec.tracks.empty()) problems.push_back({"tracks", plain("missing"), phrase("the id of an answer")});
  if (spec.ascending.empty() && spec.descending.empty())
    problems.push_back(
        {"start_ascending", phrase("no series has a starting level"), phrase("give levels to start from")});
  if (spec.step.size() != 1 || !positive(spec.step))
    problems.push_back({"step", phrase("missing or not above 0"), phrase("one number above 0")});
  if (!spec.min || !spec.max || !(*spec.min < *spec.max))
    problems.push_back({"min", phrase("\"min\" is not less than \"max\""), plain("min < max")});
  if (spec.scale != Scale::linear && spec.min && !(*spec.min > 0))
    problems.push_back({"min", phrase("on a logarithmic scale all levels must be above 0"),
                        phrase("write a level above 0")});
  if (spec.n_change < 1)
    problems.push_back({"n_change", phrase("below 1"), phrase("write a whole number of 1 or more")});
  const bool both = !spec.ascending.empty() && !spec.descending.empty();
  if (spec.series < 1 || (both && spec.series % 2 != 0))
    problems.push_back({"series", phrase("there must be as many ascending as descending series"),
                        phrase("write an even number; each direction has half of it")});
  if (problems.empty()) validate_starts(spec, problems);
}

}  // namespace

extern const Description limits{
    "limits",
    Choice::series,
    limits_keys,
    read_limits,
    validate_limits,
    [](const Spec& spec, const Context&, const core::DrawKey& key) -> std::unique_ptr<Procedure> {
      return std::make_unique<Limits>(spec, key);
    },
    [](const Spec&, double, double) -> std::optional<double> { return std::nullopt; },
};

}  // namespace turnpoint::procedure

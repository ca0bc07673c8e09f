#include "station/procedure/adjustment.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "station/core/median.hpp"
#include "station/procedure/description.hpp"
#include "station/procedure/keys.hpp"
#include "station/procedure/state_hash.hpp"

namespace turnpoint::procedure {

using core::phrase, core::plain;

void Adjustment::record_setting(double setting) {
  if (!std::isfinite(setting)) throw std::invalid_argument("adjustment: a setting must be a finite number");
  settings_.push_back(setting);
  record(Answer::one);
}

std::map<std::string, Estimate> Adjustment::estimates() const {
  const auto n = settings_.size();
  if (n < 2) return {};
  Estimate estimate;
  estimate.mode = core::median(settings_);
  for (const double setting : settings_) estimate.mean += setting / static_cast<double>(n);
  double squares = 0;
  for (const double setting : settings_) squares += (setting - estimate.mean) * (setting - estimate.mean);
  estimate.sd = std::sqrt(squares / static_cast<double>(n - 1));
  return {{"pse", estimate}};
}

std::uint64_t Adjustment::state_hash() const {
  StateHash hash;
  hash.add(ConstantStimuli::state_hash());
  for (const double setting : settings_) hash.add(std::bit_cast<std::uint64_t>(setting));
  return hash.value();
}

namespace {

/// Reads "start", or "start_below" and "start_above". A list "start" is split at the middle between its
/// lowest and its highest level: levels below it are starts from below, levels above it are starts from
/// above.
void read_starts(core::TableReader& reader, Spec& spec) {
  auto &below = spec.ascending.values, &above = spec.descending.values;
  below = reader.maybe_numbers("start_below");
  above = reader.maybe_numbers("start_above");
  if (!reader.has("start_below") && !reader.has("start_above")) {
    spec.values = reader.numbers("start");
    if (spec.values.empty()) return;
    const auto [low, high] = std::minmax_element(spec.values.begin(), spec.values.end());
    const double middle = 0.5 * (*low + *high);
    for (const double level : spec.values) {
      if (level < middle) below.push_back(level);
      if (level > middle) above.push_back(level);
    }
    return;
  }
  if (reader.has("start"))
    reader.problem("start",
                   phrase("\"start\" is not allowed together with \"start_below\" or \"start_above\""),
                   phrase("give either \"start\", or \"start_below\" and \"start_above\""));
  if (below.size() != above.size())
    reader.problem(reader.has("start_below") ? "start_below" : "start_above",
                   phrase("there must be as many starts from below as from above"),
                   phrase("list equally many levels in \"start_below\" and \"start_above\""));
  spec.values = below;
  spec.values.insert(spec.values.end(), above.begin(), above.end());
}

}  // namespace

extern const Description adjustment{
    "adjustment",
    Choice::listed,
    [] {
      using namespace core::key;
      return list_keys().and_also(
          {numbers("start", any_level,
                   "where the slider starts: below or above, as seen from the middle of the list"),
           numbers("start_below", any_level, "where the slider starts below"),
           numbers("start_above", any_level, "where the slider starts above; as many as below")});
    },
    [](core::TableReader& reader, Spec& spec) {
      read_starts(reader, spec);
      read_list(reader, spec);
    },
    [](const Spec& spec, std::vector<Problem>& problems) {
      if (spec.values.empty())
        problems.push_back({"start", plain("missing"), phrase("list one or more levels to start from")});
      const auto &below = spec.ascending.values, &above = spec.descending.values;
      if (!below.empty() && !above.empty() && spec.ascending.ends().second >= spec.descending.ends().first)
        problems.push_back({"start_below", phrase("a start from below lies above a start from above"),
                            phrase("choose all of them below all of \"start_above\"")});
      if (spec.repeats < 1)
        problems.push_back({"repeats", phrase("below 1"), phrase("write a whole number of 1 or more")});
    },
    [](const Spec& spec, const Context& context, const core::DrawKey& key) -> std::unique_ptr<Procedure> {
      return std::make_unique<Adjustment>(spec, context, key);
    },
    [](const Spec&, double, double) -> std::optional<double> { return std::nullopt; },
};

}  // namespace turnpoint::procedure

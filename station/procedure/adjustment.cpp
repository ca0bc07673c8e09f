#include "station/procedure/adjustment.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "station/procedure/description.hpp"
#include "station/procedure/keys.hpp"
#include "station/procedure/state_hash.hpp"

namespace turnpoint::procedure {

void Adjustment::record_setting(double setting) {
  if (!std::isfinite(setting)) throw std::invalid_argument("adjustment: a setting must be a finite number");
  settings_.push_back(setting);
  record(Answer::one);
}

std::map<std::string, Estimate> Adjustment::estimates() const {
  const auto n = settings_.size();
  if (n < 2) return {};
  auto sorted = settings_;
  std::sort(sorted.begin(), sorted.end());
  Estimate estimate;
  estimate.mode = 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]);
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

extern const Description adjustment{
    Kind::adjustment,
    "adjustment",
    Choice::listed,
    [](text::TableReader& reader, Spec& spec) {
      spec.values = reader.numbers("start", any_level);
      read_list(reader, spec);
    },
    [](const Spec& spec, std::vector<Problem>& problems) {
      if (spec.values.empty())
        problems.push_back({"start", "missing", "list one or more levels to start from"});
      if (spec.repeats < 1) problems.push_back({"repeats", "below 1", "write a whole number of 1 or more"});
    },
    [](const Spec& spec, const Context& context, const random::Key& key) -> std::unique_ptr<Procedure> {
      return std::make_unique<Adjustment>(spec, context, key);
    },
    [](const Spec&, double, double) -> std::optional<double> { return std::nullopt; },
};

}  // namespace turnpoint::procedure

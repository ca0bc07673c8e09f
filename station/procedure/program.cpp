#include "station/procedure/program.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "station/procedure/description.hpp"
#include "station/procedure/keys.hpp"

namespace turnpoint::procedure {

using core::phrase, core::plain;

namespace {

constexpr int kStandInLevels = 25;

class StandIn final : public Procedure {
 public:
  explicit StandIn(const Spec& spec)
      : min_(spec.min.value()), max_(spec.max.value()), trials_(spec.stop.trials.value()) {}

  std::optional<Proposal> next() const override {
    if (presented_ >= trials_) return std::nullopt;
    return Proposal{min_ + (max_ - min_) * (presented_ % kStandInLevels) / (kStandInLevels - 1), {}};
  }
  void record(Answer) override { ++presented_; }
  int recorded() const override { return presented_; }
  int expected() const override { return trials_; }
  std::uint64_t state_hash() const override { return static_cast<std::uint64_t>(presented_); }

 private:
  double min_, max_;
  int trials_, presented_ = 0;
};

core::Keys program_keys() {
  using namespace core::key;
  core::Keys keys{tracks_key()};
  keys.and_also(range_keys());
  return keys.and_also(
      {string("program", "file of a separate program that chooses the levels, as seen from this file")
           .required(),
       number("limit_s", {0.05, 60, core::Range::Ends::closed, "s"},
              "longest time that the program may take for each reply")
           .by_default("2"),
       table("settings", core::Keys{}.with_free_names(any("NAME", "what the program gets as it is")),
             "what the program gets as it is"),
       stop_key()});
}

void read_program(core::TableReader& reader, Spec& spec) {
  read_tracks(reader, spec);
  auto& program = spec.program;
  program.file = reader.string("program");
  program.place = reader.place("program");
  program.limit_s = reader.number("limit_s");
  if (const auto* settings = reader.maybe_table("settings")) program.settings = *settings;
  spec.min = reader.number("min");
  spec.max = reader.number("max");
  read_stop(reader, spec);
}

/// True if JSON can express the value.
bool expressible(const core::Value& value) {
  using Kind = core::Value::Kind;
  if (value.kind == Kind::number && !std::isfinite(value.number)) return false;
  return value.kind != Kind::date && std::ranges::all_of(value.items, expressible) &&
         std::ranges::all_of(value.entries, [](const auto& entry) { return expressible(entry.value); });
}

void validate_program(const Spec& spec, std::vector<Problem>& problems) {
  if (spec.program.file.empty())
    problems.push_back({"program", phrase("missing or empty"), phrase("the path of an executable file")});
  if (!spec.min || !spec.max || *spec.min >= *spec.max)
    problems.push_back({"min", phrase("\"min\" is not less than \"max\""), plain("min < max")});
  const auto& stop = spec.stop;
  const bool others =
      stop.reversals || stop.min_trials || stop.threshold_sd || stop.entropy_nats || stop.right;
  if (!stop.trials || others)
    problems.push_back(
        {"stop", phrase("a program decides itself when it is done, so \"stop\" only limits its trials"),
         plain("stop = { trials = N }")});
  for (const auto& entry : spec.program.settings.entries)
    if (!expressible(entry.value))
      problems.push_back({"settings." + entry.key, phrase("JSON has no such value"),
                          phrase("a finite number, text, true, false, a list or a table of them")});
}

}  // namespace

std::unique_ptr<Procedure> StandIns::procedure(const Spec& spec, const core::DrawKey&) {
  return std::make_unique<StandIn>(spec);
}

extern const Description program{
    "program",
    Choice::program,
    program_keys,
    read_program,
    validate_program,
    [](const Spec& spec, const Context& context, const core::DrawKey& key) -> std::unique_ptr<Procedure> {
      if (context.programs == nullptr)
        throw std::logic_error("procedure " + spec.name + ": nothing was given that starts programs");
      return context.programs->procedure(spec, key);
    },
    [](const Spec&, double, double) -> std::optional<double> { return std::nullopt; },
};

}  // namespace turnpoint::procedure

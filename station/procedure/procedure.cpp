#include "station/procedure/procedure.hpp"

#include <array>
#include <stdexcept>

#include "station/procedure/description.hpp"

namespace turnpoint::procedure {

using core::phrase, core::plain;

// The kinds are listed here explicitly. They could not register themselves: a linker leaves out an object
// file of a static library if nothing refers to it.
extern const Description constant_stimuli;
extern const Description up_down;
extern const Description weighted_up_down;
extern const Description quest_plus;
extern const Description psi;
extern const Description psi_marginal;
extern const Description zest;
extern const Description best_pest;
extern const Description adjustment;
extern const Description accelerated_stochastic_approximation;
extern const Description limits;
extern const Description program;
extern const Description comparisons;

namespace {

constexpr std::array kDescriptions{
    &constant_stimuli, &up_down, &weighted_up_down, &quest_plus, &psi,
    &psi_marginal,     &zest,    &best_pest,        &adjustment, &accelerated_stochastic_approximation,
    &limits,           &program, &comparisons,
};

}  // namespace

const Description& description(Kind kind) {
  for (const auto* entry : kDescriptions)
    if (entry->kind == kind) return *entry;
  throw std::logic_error("procedure: this kind has no description in the table");
}

const char* name(Kind kind) { return description(kind).name; }

std::optional<Kind> parse_kind(const std::string& text) {
  for (const auto* entry : kDescriptions)
    if (text == entry->name) return entry->kind;
  return std::nullopt;
}

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const auto* entry : kDescriptions) names.emplace_back(entry->name);
  return names;
}

std::vector<Problem> validate(const Spec& spec) {
  std::vector<Problem> problems;
  if (spec.level.empty())
    problems.push_back({"level", plain("missing"), phrase("write the name of a factor")});
  description(spec.kind).validate(spec, problems);
  return problems;
}

core::Phrase parameter_name(const std::string& parameter) {
  static const std::map<std::string, const char*> known{
      {"threshold", "report.threshold"}, {"pse", "report.pse"},     {"slope", "report.slope"},
      {"spread", "report.spread"},       {"lapse", "report.lapse"}, {"criterion", "report.criterion"},
      {"gradient", "report.gradient"},   {"floor", "report.floor"}};
  const auto found = known.find(parameter);
  return found == known.end() ? core::plain(parameter) : core::phrase(found->second);
}

std::optional<core::Phrase> end_in_words(Ended ended, const std::string& procedure, int count) {
  switch (ended) {
    case Ended::limit:
      return phrase("report.ended_limit", {plain(procedure), plain(count)});
    case Ended::most:
      return phrase("report.ended_most", {plain(procedure), plain(count)});
    case Ended::unanswered:
      return phrase("report.ended_unanswered", {plain(procedure)});
    default:
      return std::nullopt;
  }
}

std::vector<Candidate> Procedure::candidates() const {
  const auto proposal = next();
  return proposal ? std::vector<Candidate>{{*proposal}} : std::vector<Candidate>();
}

void Procedure::record_setting(double) {
  throw std::logic_error("procedure: only an adjustment can record a setting");
}

core::DrawKey key_of(std::uint64_t seed, int block, std::size_t place, int attempt) {
  return {seed, core::Stream::level_order, block * 64 + static_cast<int>(place), attempt, 0};
}

std::unique_ptr<Procedure> make_procedure(const Spec& spec, const Context& context,
                                          const core::DrawKey& key) {
  if (const auto problems = validate(spec); !problems.empty())
    throw std::invalid_argument("procedure " + spec.name + ": " + problems.front().key + ": " +
                                core::say(problems.front().what, "en") + "; " +
                                core::say(problems.front().allowed, "en"));
  return description(spec.kind).make(spec, context, key);
}

}  // namespace turnpoint::procedure

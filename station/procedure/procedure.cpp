#include "station/procedure/procedure.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "station/procedure/description.hpp"
#include "station/procedure/keys.hpp"

namespace turnpoint::procedure {

using core::phrase, core::plain;

#define TURNPOINT_DESCRIPTION(kind) extern const Description kind;
TURNPOINT_PROCEDURES(TURNPOINT_DESCRIPTION)
#undef TURNPOINT_DESCRIPTION

namespace {

#define TURNPOINT_ADDRESS(kind) &kind,
constexpr std::array kDescriptions{TURNPOINT_PROCEDURES(TURNPOINT_ADDRESS)};
#undef TURNPOINT_ADDRESS

/// Adds a key of one kind of procedure: to the kinds of the same declaration, or after those of the same
/// name.
void add(core::Keys& all, core::Key key, const std::string& kind) {
  auto place = all.list.end();
  for (auto known = all.list.begin(); known != all.list.end(); ++known) {
    if (known->name != key.name) continue;
    if (core::alike(*known, key)) return known->conditions.front().words.push_back(kind);
    place = known + 1;
  }
  all.list.insert(place, key.only_with("kind", {kind}));
}

}  // namespace

const Description& description(Kind kind) { return *kDescriptions.at(static_cast<std::size_t>(kind)); }

const char* name(Kind kind) { return description(kind).name; }

std::optional<Kind> parse_kind(const std::string& text) {
  for (std::size_t i = 0; i < kDescriptions.size(); ++i)
    if (text == kDescriptions[i]->name) return static_cast<Kind>(i);
  return std::nullopt;
}

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const auto* entry : kDescriptions) names.emplace_back(entry->name);
  return names;
}

core::Keys procedure_keys() {
  core::Keys all;
  for (const auto* entry : kDescriptions) {
    for (const auto& key : entry->keys().list) add(all, key, entry->name);
    if (entry->choice != Choice::listed) add(all, runs_key(), entry->name);
  }
  // When it ends stands last, as in the pages' examples.
  std::ranges::stable_partition(all.list, [](const core::Key& key) { return key.name != "stop"; });
  return all;
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

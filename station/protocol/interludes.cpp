#include "station/protocol/interludes.hpp"

#include <algorithm>
#include <filesystem>

#include "station/core/number.hpp"
#include "station/protocol/sources.hpp"
#include "station/protocol/visits.hpp"

namespace turnpoint::protocol {

namespace {

const std::string& name_of(const std::variant<Block, Sequence>& part) { return block_of(part).name; }

bool compares(Relation relation, double a, double b) {
  switch (relation) {
    case Relation::less:
      return a < b;
    case Relation::less_equal:
      return a <= b;
    case Relation::equal:
      return a == b;
    case Relation::greater_equal:
      return a >= b;
    case Relation::greater:
      return a > b;
  }
  return false;
}

}  // namespace

const char* name(InterludeKind kind) {
  switch (kind) {
    case InterludeKind::questionnaire:
      return "questionnaire";
    case InterludeKind::consent:
      return "consent";
    case InterludeKind::explanation:
      return "explanation";
    case InterludeKind::screening:
      break;
  }
  return "screening";
}

bool holds(const AnswerCondition& rule, const Answers& answers) {
  const auto found = answers.find(rule.about);
  if (found == answers.end()) return false;
  const auto *given = std::get_if<double>(&found->second), *wanted = std::get_if<double>(&rule.value);
  if (given && wanted) return compares(rule.relation, *given, *wanted) != rule.unequal;
  return (found->second == rule.value) != rule.unequal;
}

bool holds(const std::vector<AnswerCondition>& rules, const Answers& answers) {
  return std::all_of(rules.begin(), rules.end(), [&](const auto& rule) { return holds(rule, answers); });
}

std::vector<const Interlude*> interludes_before(const Protocol& protocol, const std::vector<Block>& blocks,
                                                std::size_t next, const Visit& visit) {
  std::vector<const Interlude*> list;
  const bool begun = next > 0, over = next == blocks.size();
  const std::size_t done = begun ? blocks[next - 1].part + 1 : 0;
  const std::size_t coming = over ? protocol.plan.size() : blocks[next].part;
  for (const auto& interlude : protocol.interludes)
    if (begun && !interlude.after_each.empty() &&
        interlude.after_each == name_of(protocol.plan[blocks[next - 1].part]) &&
        is_for(interlude.audience, protocol, visit))
      list.push_back(&interlude);
  for (const auto& interlude : protocol.interludes)
    if (interlude.after_each.empty() && interlude.above >= done && interlude.above <= coming &&
        is_for(interlude.audience, protocol, visit))
      list.push_back(&interlude);
  return list;
}

FactorValue answer_value(const Item& item, const std::string& answer) {
  if (!item.value && !item.rating) return answer;
  const auto number = core::read_number(answer);
  return number ? FactorValue(*number) : FactorValue(answer);
}

std::string picture_path(const Protocol& protocol, const std::string& picture) {
  return (std::filesystem::absolute(protocol.path).parent_path() / picture).lexically_normal().string();
}

std::vector<Picture> pictures(const Protocol& protocol) {
  std::vector<Picture> all;
  for (const auto& interlude : protocol.interludes)
    for (const auto& page : interlude.pages)
      if (!page.picture.empty()) all.push_back({picture_path(protocol, page.picture), page.picture_place});
  return all;
}

}  // namespace turnpoint::protocol

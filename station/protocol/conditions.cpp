#include "station/protocol/conditions.hpp"

#include <algorithm>
#include <set>

#include "station/core/number.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/combinations.hpp"
#include "station/protocol/sources.hpp"
#include "station/protocol/visits.hpp"

namespace turnpoint::protocol {

namespace {

/// For factor number `next` in `by` and all factors after it: adds each combination of their levels.
void combine(const protocol::Protocol& protocol, std::size_t next, protocol::Factors& factors,
             std::vector<protocol::Factors>& all) {
  const auto& by = protocol.analysis.by;
  if (next == by.size()) return all.push_back(factors);
  for (const auto& factor : protocol.factors)
    if (factor.name == by[next])
      for (const auto& level : factor.levels) {
        factors[factor.name] = level;
        combine(protocol, next + 1, factors, all);
      }
}

std::vector<protocol::Factors> combinations_of_by(const protocol::Protocol& protocol) {
  std::vector<protocol::Factors> all;
  protocol::Factors factors;
  combine(protocol, 0, factors, all);
  return all;
}

}  // namespace

std::string presented(const Protocol& protocol, const procedure::Spec& spec,
                      const std::vector<std::string>& scenes) {
  std::set<std::string> found;
  for (const auto& part : parts_of(protocol.task, scenes))
    for (const auto& scene : part.scenes)
      if (const auto known = protocol.scenes.find(scene); known != protocol.scenes.end()) {
        auto felt = known->second;
        // The tones of a zone are laid out for the friction of its base, but it presents its own.
        if (felt.zone) felt.zone->design_friction = felt.zone->friction;
        for (const auto& name : factors_of(felt))
          if (name == spec.level || std::ranges::find(spec.against, name) != spec.against.end())
            found.insert(name);
      }
  return found.size() == 1 ? *found.begin() : "";
}

std::vector<double> compared(const procedure::Spec& spec, const Factors& factors) {
  std::vector<std::string> names{spec.level};
  names.insert(names.end(), spec.against.begin(), spec.against.end());
  std::vector<double> stimuli;
  for (const auto& name : names) {
    const auto found = factors.find(name);
    const auto* value = found == factors.end() ? nullptr : std::get_if<double>(&found->second);
    if (!value) return {};
    stimuli.push_back(*value);
  }
  return stimuli;
}

FactorWords words_of(const std::string& factor) {
  FactorWords words{factor, ""};
  for (const auto* suffix : {"_dB", "_mm", "_um", "_Hz", "_kHz", "_s", "_ms"})
    if (factor.ends_with(suffix)) {
      words.unit = std::string(suffix) == "_um" ? "\u00b5m" : suffix + 1;
      words.name.resize(factor.size() - std::string(suffix).size());
      break;
    }
  std::replace(words.name.begin(), words.name.end(), '_', ' ');
  return words;
}

std::string level_in_words(const std::string& factor, const protocol::FactorValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  const auto words = words_of(factor);
  return words.name + " " + core::number(std::get<double>(value)) +
         (words.unit.empty() ? "" : " " + words.unit);
}

std::string condition_of(const protocol::Protocol& protocol, const protocol::Factors& factors,
                         const std::string& instruction) {
  if (protocol.analysis.by.empty()) return instruction;
  std::string name;
  for (const auto& factor : protocol.analysis.by)
    if (const auto found = factors.find(factor); found != factors.end())
      name += (name.empty() ? "" : ", ") + level_in_words(factor, found->second);
  return name;
}

std::map<std::string, std::string> groups_of_conditions(const protocol::Protocol& protocol) {
  std::map<std::string, std::string> groups;
  for (const auto& factors : combinations_of_by(protocol)) {
    std::string group;
    for (const auto& factor : protocol.factors)
      if (const auto found = factors.find(factor.name); is_group(factor) && found != factors.end())
        group += (group.empty() ? "" : ", ") + level_in_words(factor.name, found->second);
    if (!group.empty()) groups.emplace(condition_of(protocol, factors, ""), group);
  }
  return groups;
}

std::vector<std::string> conditions(const protocol::Protocol& protocol) {
  std::vector<std::string> names;
  if (!protocol.analysis.by.empty()) {
    for (const auto& factors : combinations_of_by(protocol))
      names.push_back(condition_of(protocol, factors, ""));
    return names;
  }
  for (const auto& block : protocol::all_blocks(protocol))
    if (const auto found = block.fixed.find("instruction"); found != block.fixed.end())
      if (const auto* text = std::get_if<std::string>(&found->second);
          text && std::find(names.begin(), names.end(), *text) == names.end())
        names.push_back(*text);
  return names;
}

}  // namespace turnpoint::protocol

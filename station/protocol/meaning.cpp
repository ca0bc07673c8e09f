#include "station/protocol/meaning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "station/core/number.hpp"
#include "station/procedure/description.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/conditions.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/sources.hpp"

namespace turnpoint::protocol {

namespace {

bool decibel(const Meaning& meaning) { return meaning.level.ends_with("_dB"); }

Design design_of(const Protocol& protocol, const AnswerRule& rule) {
  const auto& task = protocol.task;
  if (task.kind == TaskKind::adjustment) return Design::adjustment;
  if (task.kind == TaskKind::comparison)
    return task.intervals.size() == 2 ? Design::pairs : Design::differences;
  if (task.value && task.value->typed) return Design::numbers;
  if (judges(task)) return Design::ratings;
  if (task.kind == TaskKind::same_different) return Design::same_different;
  switch (rule.kind) {
    case AnswerKind::presence:
      return Design::yes_no;
    case AnswerKind::side:
      return Design::two_sided;
    case AnswerKind::category:
      return Design::categories;
    case AnswerKind::right_answer:
      break;
  }
  return !scored(task) && task.choices.size() > 2 ? Design::categories : Design::forced_choice;
}

/// The factors that a procedure fixes to values of its own, as far as the conditions of the report do not
/// separate them already. Procedures that differ in them measure different things.
std::map<std::string, FactorValue> settings_of(const Source& source, const Protocol& protocol) {
  std::map<std::string, FactorValue> settings;
  if (!source.spec) return settings;
  const auto& by = protocol.analysis.by;
  for (const auto& [name, value] : source.spec->with)
    if (std::find(by.begin(), by.end(), name) == by.end()) settings.emplace(name, value);
  return settings;
}

void include(const Source& source, const Protocol& protocol, Meaning& meaning) {
  const auto add = [](const std::string& name, std::vector<std::string>& names) {
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  add(source.block->name, meaning.blocks);
  if (source.spec) add(source.spec->name, meaning.procedures);
  auto& [low, high] = meaning.levels;
  const auto reach = [&low = low, &high = high](double level) {
    low = std::min(low, level), high = std::max(high, level);
  };
  for (const double level : source.levels) reach(level);
  const auto* spec = source.spec;
  if (!spec) return;
  const auto& by = protocol.analysis.by;
  for (const auto& name : spec->against) add(name, meaning.against);
  if (spec->second && std::find(by.begin(), by.end(), spec->second->level) == by.end())
    meaning.along = spec->second->level;
  // a procedure without limits can go anywhere within the range of its factor
  const auto* factor = find_factor(protocol.factors, spec->level);
  if (procedure::follows_answers(*spec) && spec->stimuli.values.empty() && !(spec->min && spec->max) &&
      factor && factor->range)
    reach(factor->range->first), reach(factor->range->second);
}

/// Chooses the function to fit: the one that the protocol's procedure assumes. If no procedure assumes one,
/// chooses a function that suits the levels.
void choose_function(const Protocol& protocol, Meaning& meaning) {
  const bool rises = meaning.design == Design::forced_choice || has_noise(meaning.design);
  const bool positive = meaning.levels.first >= 0 && meaning.levels.second > 0;
  const bool weibull = rises && (decibel(meaning) || positive);
  meaning.function = weibull ? core::Function::weibull : core::Function::normal;
  meaning.log_axis = rises && positive && !decibel(meaning);
  for (const auto& name : meaning.procedures) {
    const auto* spec = find_procedure(protocol, name);
    if (procedure::description(spec->kind).choice != procedure::Choice::posterior) continue;
    if (spec->signal_detection) continue;  // the fit has no criterion, but a rate of false alarms
    // A Weibull function needs levels above 0, or levels in dB. Its 63 % point is not a PSE.
    if (spec->function != core::Function::weibull || weibull) meaning.function = spec->function;
    return;
  }
}

void decide(const Protocol& protocol, Meaning& meaning) {
  meaning.rule = answer_rule(protocol, meaning.level);
  meaning.design = design_of(protocol, meaning.rule);
  meaning.scored = scored(protocol.task);
  meaning.alternatives = std::max(2, static_cast<int>(protocol.task.choices.size()));
  auto& [low, high] = meaning.levels;
  if (low > high) low = high = 0;
  const bool both = low < 0 && high > 0 && !decibel(meaning);
  meaning.size = meaning.rule.size || (meaning.design == Design::yes_no && low < 0) ||
                 (both && (meaning.design == Design::forced_choice || has_noise(meaning.design)));
  if (meaning.size) {
    const double nearest = low <= 0 && high >= 0 ? 0 : std::min(std::fabs(low), std::fabs(high));
    high = std::max(std::fabs(low), std::fabs(high)), low = nearest;
  }
  choose_function(protocol, meaning);
  if (meaning.design == Design::pairs) meaning.function = protocol.analysis.pairs;
}

/// Gives the analyses different names: the factor's name or, if analyses have the same factor, what their
/// procedures set.
void name_all(std::vector<Meaning>& all, const std::vector<std::map<std::string, FactorValue>>& settings) {
  if (all.size() < 2) return;
  std::set<std::string> factors;
  for (const auto& meaning : all) factors.insert(meaning.level);
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].name = factors.size() > 1 ? all[i].level : "";
    const auto same = std::count_if(all.begin(), all.end(),
                                    [&](const Meaning& other) { return other.level == all[i].level; });
    if (same > 1)
      for (const auto& [factor, value] : settings[i])
        all[i].name += (all[i].name.empty() ? "" : ", ") + level_in_words(factor, value);
  }
  std::map<std::string, int> times;
  for (const auto& meaning : all) ++times[meaning.name];
  for (auto& meaning : all)
    if (times[meaning.name] > 1 || meaning.name.empty()) {
      std::string names;
      for (const auto& name : meaning.procedures) names += (names.empty() ? "" : ", ") + name;
      meaning.name = names.empty() ? "fixed levels of " + meaning.level : names;
    }
}

std::string code(const std::string& name) { return "`" + name + "`"; }

std::string function_in_words(const Meaning& meaning) {
  std::string words = meaning.function == core::Function::weibull  ? "Weibull"
                      : meaning.function == core::Function::normal ? "cumulative normal"
                                                                   : "logistic";
  if (meaning.log_axis) words += " on a log scale";
  return words;
}

std::string choice_of(const Protocol& protocol, int index) {
  const auto& choices = protocol.task.choices;
  const auto place = static_cast<std::size_t>(index);
  if (protocol.task.kind == TaskKind::two_interval && place < 2) return scene_of(protocol.task, index);
  return place < choices.size() ? choices[place].id : std::to_string(index + 1);
}

}  // namespace

bool scored(const Task& task) {
  if (task.kind == TaskKind::comparison) return false;
  return task.kind != TaskKind::single_interval || !task.correct_answer.empty();
}

std::vector<Meaning> meanings_of(const Protocol& protocol) {
  std::vector<Meaning> all;
  std::vector<std::map<std::string, FactorValue>> settings;
  const auto sources = sources_of(protocol);
  // Practice and catch trials are not analysed. If there is nothing else, they are what the protocol
  // measures.
  for (const bool practice : {false, true}) {
    for (const auto& source : sources) {
      if (source.block->practice != practice || source.level.empty()) continue;
      const bool caught =
          !source.spec && (source.block->level.empty() || source.level != source.block->level);
      if (caught) continue;
      const auto set = settings_of(source, protocol);
      std::size_t place = 0;
      while (place < all.size() && !(all[place].level == source.level && settings[place] == set)) ++place;
      if (place == all.size()) {
        all.emplace_back().level = source.level;
        constexpr double infinite = std::numeric_limits<double>::infinity();
        all.back().levels = {infinite, -infinite};
        settings.push_back(set);
      }
      include(source, protocol, all[place]);
    }
    if (!all.empty()) break;
  }
  if (all.empty()) all.emplace_back(), settings.emplace_back();
  for (auto& meaning : all) {
    decide(protocol, meaning);
    meaning.middle = middle_level(protocol, meaning.level);
  }
  name_all(all, settings);
  return all;
}

std::vector<Meaning> meanings_of_tasks(const Protocol& protocol) {
  std::vector<Meaning> all;
  for (const auto& one : protocol.by_task)
    for (auto meaning : one.meanings) {
      meaning.name = one.task.name + (meaning.name.empty() ? "" : ", ") + meaning.name;
      all.push_back(std::move(meaning));
    }
  return all;
}

std::size_t meaning_of(const Protocol& protocol, const std::string& procedure, const std::string& block) {
  const auto& all = protocol.meanings;
  const auto has = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (std::size_t i = 0; i < all.size(); ++i)
    if (procedure.empty() ? has(all[i].blocks, block) : has(all[i].procedures, procedure)) return i;
  return 0;
}

std::string condition_in(const Meaning& meaning, const std::string& condition) {
  if (meaning.name.empty() || condition.empty()) return meaning.name + condition;
  return meaning.name + ", " + condition;
}

std::vector<std::string> analysed_conditions(const Protocol& protocol) {
  std::vector<std::string> all;
  const auto names = conditions(protocol);
  for (const auto& meaning : protocol.meanings) {
    for (const auto& name : names) all.push_back(condition_in(meaning, name));
    if (names.empty() && !meaning.name.empty()) all.push_back(meaning.name);
  }
  return all;
}

std::optional<std::string> common_level(const Protocol& protocol) {
  std::optional<std::string> level;
  for (const auto& spec : protocol.procedures) {
    if (level && *level != spec.level) return std::nullopt;
    level = spec.level;
  }
  return level;
}

std::optional<double> threshold_proportion(const Meaning& meaning) {
  if (meaning.design != Design::forced_choice || !meaning.scored) return std::nullopt;
  const double core = meaning.function == core::Function::weibull ? 1 - std::exp(-1.0) : 0.5;
  const double guess = 1.0 / meaning.alternatives;
  return guess + (1 - guess) * core;
}

std::string in_words(const Meaning& meaning, const Protocol& protocol) {
  if (meaning.level.empty()) return "no level, so there is no function of it";
  const auto level = (meaning.size ? "the size of " : "") + code(meaning.level);
  const auto function = ", " + function_in_words(meaning);
  std::string words;
  switch (meaning.design) {
    case Design::adjustment:
      return "settings of " + level + ", their mean (PSE) and scatter";
    case Design::ratings:
      return "mean rating at each " + level +
             (protocol.task.present ? "; d\u2032 and the ROC of the ratings" : "");
    case Design::numbers:
      return "magnitude of " + level + ", geometric means and the exponent of Stevens\u2019 law";
    case Design::categories:
      return meaning.scored
                 ? "confusions of " + std::to_string(meaning.alternatives) + " answers at each " + level
                 : "how often each of " + std::to_string(meaning.alternatives) +
                       " answers is given at each " + level;
    case Design::pairs:
    case Design::differences:
      words = "places on a scale of the values of " + level;
      for (std::size_t i = 0; i < meaning.against.size(); ++i)
        words += (i + 1 < meaning.against.size() ? ", " : " and ") + code(meaning.against[i]);
      if (meaning.design == Design::pairs)
        return words + ", from all pairs (" +
               (meaning.function == core::Function::logistic ? "Bradley and Terry)" : "Thurstone, case V)");
      return words + ", from all " + (meaning.against.size() == 2 ? "triads" : "quadruples") +
             " (maximum-likelihood difference scaling)";
    case Design::two_sided:
      words = "PSE and spread of " + level;
      if (meaning.scored)
        words += " around " + core::number(meaning.rule.cut, 6) +
                 (protocol.task.kind == TaskKind::two_interval
                      ? " by the interval with `" + choice_of(protocol, meaning.rule.positive) + "`"
                      : "");
      else
        words += " by the answer \u201c" + choice_of(protocol, meaning.rule.positive) + "\u201d";
      break;
    case Design::yes_no:
    case Design::same_different:
      words = "threshold of " + level + " half-way from the false alarms to 100 % \u201c" +
              choice_of(protocol, meaning.rule.positive) + "\u201d";
      if (meaning.design == Design::yes_no) words += ", d\u2032 and criterion";
      break;
    case Design::forced_choice:
      words = "threshold of " + level + " at " +
              core::number(100 * threshold_proportion(meaning).value_or(0.5), 3) + " % correct, guess rate " +
              core::number(1.0 / meaning.alternatives, 3);
      if (!protocol.task.unsure.empty()) words += " (the answer \u201cunsure\u201d counts as a guess)";
      break;
  }
  if (!meaning.along.empty())
    return words + ", which changes along " + code(meaning.along) + " (the procedure\u2019s own estimate)";
  words += function;
  if (protocol.timing.signal) words += "; d\u2032 as a function of the time of the response signal";
  return words;
}

std::string line_of(const Meaning& meaning, const Protocol& protocol) {
  std::string line = protocol.task.name;
  for (const auto& block : meaning.blocks) line += (line.empty() ? "" : ", ") + block;
  if (!meaning.name.empty()) line += (line.empty() ? "" : ", ") + meaning.name;
  return line + (line.empty() ? "" : ": ") + in_words(meaning, protocol);
}

}  // namespace turnpoint::protocol

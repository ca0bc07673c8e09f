#include <algorithm>
#include <cmath>
#include <map>

#include "station/core/number.hpp"
#include "station/protocol/advice_list.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/tasks.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

namespace {

using core::number;
using procedure::Spec;

/// For each answer, the number of cases in which it is right (`times`); the number of cases in which some
/// answer is right (`scored`); and the number of all cases (`all`).
struct Right {
  std::map<std::string, int> times;
  int scored = 0, all = 0;
};

// Largest number of cases that are checked. A case is one level, combined with one value of each other factor
// that the comparisons in `correct` use. Larger designs are not checked.
constexpr std::size_t most_cases = 20000;

std::vector<Factors> cases_of(const Protocol& protocol, const std::string& level,
                              const std::vector<double>& levels) {
  const auto any = any_factors(protocol);
  Factors needed;
  for (const auto& [id, comparison] : protocol.task.correct_answer)
    for (const auto* side : {&comparison.left, &comparison.right})
      for (const auto& name : factors_in(*side)) needed[name] = any.at(name);
  std::vector<Factors> cases(levels.size(), needed);
  for (std::size_t i = 0; i < levels.size(); ++i) cases[i][level] = levels[i];
  for (const auto& factor : protocol.factors) {
    if (!needed.count(factor.name) || factor.name == level || factor.levels.size() < 2) continue;
    if (cases.size() * factor.levels.size() > most_cases) return {};
    std::vector<Factors> next;
    for (const auto& one : cases)
      for (const auto& value : factor.levels) next.push_back(one), next.back()[factor.name] = value;
    cases = std::move(next);
  }
  return cases;
}

Right right_at(const Protocol& protocol, const std::string& level, const std::vector<double>& levels) {
  Right right;
  for (const auto& factors : cases_of(protocol, level, levels)) {
    ++right.all;
    bool scored = false;
    for (const auto& [id, comparison] : protocol.task.correct_answer)
      if (holds(comparison, factors)) ++right.times[id], scored = true;
    right.scored += scored;
  }
  return right;
}

Right& operator+=(Right& sum, const Right& other) {
  for (const auto& [id, times] : other.times) sum.times[id] += times;
  sum.scored += other.scored, sum.all += other.all;
  return sum;
}

// Reports an answer that is never right, or always right: scoring it would be pointless.
void check_each_answer(AdviceList& advice) {
  const auto& protocol = advice.protocol;
  Right right;
  for (const auto& source : sources_of(protocol)) right += right_at(protocol, source.level, source.levels);
  if (right.all == 0) return;
  for (const auto& [id, comparison] : protocol.task.correct_answer) {
    const int times = right.times[id];
    if (times == 0)
      advice.add(key_of(protocol.task, "correct.") + id,
                 phrase("the answer \"%1\" is never right", {plain(id)}),
                 phrase("write a comparison that is true for some levels"));
    else if (times == right.all)
      advice.add(key_of(protocol.task, "correct.") + id,
                 phrase("the answer \"%1\" is always right", {plain(id)}),
                 phrase("write a comparison that is false for some levels"));
  }
}

// Reports a block in which the same answer is always right: a participant who always gives it scores 100 %.
void check_block(AdviceList& advice, const std::variant<Block, Sequence>& part) {
  const auto& protocol = advice.protocol;
  const auto& block = block_of(part);
  Right right;
  std::string key;
  const auto count = [&](const std::string& at, const std::string& level, const std::vector<double>& levels) {
    const auto here = right_at(protocol, level, levels);
    if (here.all > 0 && here.scored == 0)
      advice.add(at, phrase("no answer is right at any of these levels"),
                 phrase("use levels for which \"correct\" makes one answer right"));
    if (key.empty()) key = at;
    right += here;
  };
  for (const auto& name : block.procedures) {
    const auto* spec = find_procedure(protocol, name);
    if (spec && spec->tracks.empty() && !spec->values.empty())
      count(levels_key(*spec), spec->level, spec->values);
    else
      return;  // the levels of an adaptive procedure depend on the answers, so they cannot be counted
  }
  if (!block.level.empty()) count(key_of(part, "levels"), block.level, block.levels);
  if (right.scored > 0 && right.times.size() == 1 && !block.pass)
    advice.add(key, phrase("\"%1\" is right at all of these levels", {plain(right.times.begin()->first)}),
               phrase("use levels at which each answer is right equally often"));
}

/// True if an answer names an interval; which of them has the target is drawn in each trial.
bool answers_are_places(const Task& task) {
  return task.kind != TaskKind::single_interval && task.kind != TaskKind::same_different &&
         task.kind != TaskKind::adjustment;
}

// Reports a procedure that follows an answer which no level makes more frequent.
void check_tracked(AdviceList& advice, const Spec& spec) {
  if (spec.tracks.empty() || !answers_are_places(advice.protocol.task)) return;
  advice.add(
      key_of(spec, "tracks"),
      phrase(
          "\"%1\" follows the answer \"%2\", but which interval has the target is drawn in each trial, so no "
          "level makes this answer more frequent",
          {plain(spec.name), plain(spec.tracks)}),
      phrase("leave out \"tracks\", so that the procedure follows right answers"));
}

// A staircase or a Bayesian procedure assumes that the task becomes easier in one direction only, either
// towards higher or towards lower levels. Reports one whose task is easy on both sides of zero.
void check_followed(AdviceList& advice, const Source& source) {
  const auto* spec = source.spec;
  if (!spec || !spec->tracks.empty() || !spec->values.empty()) return;
  const auto kind = answer_rule(advice.protocol, spec->level).kind;
  if (kind == AnswerKind::category)
    return advice.add(key_of(*spec, "level"),
                      phrase("\"%1\" follows right answers, but \"%2\" decides which answer is right, not "
                             "how difficult the trial is",
                             {plain(spec->name), plain(spec->level)}),
                      phrase("use %1", {plain("kind = \"constant-stimuli\"")}));
  const auto& levels = source.levels;
  if (levels.empty() || levels.front() >= 0 || levels.back() <= 0) return;
  if (kind == AnswerKind::side)
    advice.add(
        key_of(*spec, "level"),
        phrase("\"%1\" follows right answers over levels on both sides of zero, but the task is easy "
               "on both sides",
               {plain(spec->name)}),
        answers_are_places(advice.protocol.task)
            ? phrase("use levels on one side of zero only, or %1", {plain("kind = \"constant-stimuli\"")})
            : phrase("set \"tracks\" to the answer that the procedure should follow, or use levels on one "
                     "side of zero only"));
}

// Checks that some order of the trials of the procedure satisfies `max_run`. Only a trial with another right
// answer can end a run of trials with the same right answer. What else can make runs longer is simulated.
void check_runs(AdviceList& advice, const Spec& spec) {
  const auto limit = spec.max_run.find(procedure::kRightAnswer);
  if (limit == spec.max_run.end() || spec.values.empty()) return;
  const auto right = right_at(advice.protocol, spec.level, spec.values);
  for (const auto& [id, times] : right.times)
    if (times * spec.repeats > limit->second * ((right.all - times) * spec.repeats + 1))
      return advice.add(
          key_of(spec, "order.max_run"),
          phrase("\"%1\" is right in %2 of %3 trials: longer runs cannot be avoided",
                 {plain(id), plain(times), plain(right.all)}),
          phrase("set a larger \"max_run\", or use levels at which each answer is right equally often"));
}

// The fraction of practice trials that a participant gets right by always pressing the same key.
double one_key_share(const Protocol& protocol, const Block& block) {
  const auto& task = protocol.task;
  if (task.kind != TaskKind::single_interval || block.levels.empty()) return chance(protocol);
  const auto right = right_at(protocol, block.level, block.levels);
  int most = 0;
  for (const auto& [id, times] : right.times) most = std::max(most, times);
  return right.all > 0 ? static_cast<double>(most) / right.all : chance(protocol);
}

void check_pass(AdviceList& advice, const std::variant<Block, Sequence>& part) {
  const auto& block = block_of(part);
  if (!block.pass || block.kind != BlockKind::trials) return;
  const double share = one_key_share(advice.protocol, block);
  if (share >= block.pass->accuracy)
    advice.add(
        key_of(part, "pass"),
        phrase("practice \"%1\" can be passed by always pressing the same key (%2 % right)",
               {plain(block.name), plain(number(100 * share, 3))}),
        phrase("use levels at which each answer is right equally often, and require a higher accuracy"));
}

// Suggests the ends of the factor's range, which are its easiest levels, for catch trials.
core::Phrase easy_on_both_sides(const Protocol& protocol, const std::string& name) {
  const auto* factor = find_factor(protocol.factors, name);
  if (!factor || !factor->range) return phrase("include easy levels for each answer");
  return phrase("include easy levels for each answer, such as %1 = [%2, %3]",
                {plain(name), plain(number(factor->range->first)), plain(number(factor->range->second))});
}

void check_catch(AdviceList& advice, const std::variant<Block, Sequence>& part) {
  const auto& protocol = advice.protocol;
  const auto& trials = block_of(part).catch_trials;
  if (!trials) return;
  if (protocol.task.kind == TaskKind::single_interval) {
    const auto right = right_at(protocol, trials->factor, trials->levels);
    if (right.all > 0 && right.times.size() < 2)
      return advice.add(
          key_of(part, "catch"),
          right.times.empty()
              ? phrase("the catch trials of \"%1\" have no right answer", {plain(block_of(part).name)})
              : phrase("the catch trials of \"%1\" have only one right answer", {plain(block_of(part).name)}),
          easy_on_both_sides(protocol, trials->factor));
    // In two cases there is nothing to advise: catch trials without a signal are easy, and if the answers are
    // categories, no level is easier than another.
    const auto kind = answer_rule(protocol, trials->factor).kind;
    if (kind == AnswerKind::presence || kind == AnswerKind::category) return;
  }
  // The larger a level, the easier the trial. For levels in dB the value itself counts, for all others the
  // magnitude.
  const bool decibel = trials->factor.ends_with("_dB");
  const auto rule = answer_rule(protocol, trials->factor);
  const bool sides = rule.kind == AnswerKind::side;
  const auto sources = sources_of(protocol);
  const auto sets = [&](const Source& source) { return source.spec && source.level == trials->factor; };
  if (std::none_of(sources.begin(), sources.end(), sets)) return;
  const double middle = middle_level_of(protocol, trials->factor);
  for (const double level : trials->levels)
    if ((sides     ? std::fabs((rule.size ? std::fabs(level) : level) - rule.cut)
         : decibel ? level
                   : std::fabs(level)) < middle)
      return advice.add(key_of(part, "catch"),
                        phrase("catch trials at %1 are harder than most trials", {plain(number(level))}),
                        phrase("use easy levels, well above %1", {plain(number(middle))}));
}

}  // namespace

void advise_on_answers(AdviceList& advice) {
  const auto& protocol = advice.protocol;
  const bool compared = !protocol.task.correct_answer.empty();
  if (compared) check_each_answer(advice);
  if (compared)
    for (const auto& source : sources_of(protocol)) check_followed(advice, source);
  for (const auto& spec : protocol.procedures) check_tracked(advice, spec);
  if (compared)
    for (const auto& spec : protocol.procedures) check_runs(advice, spec);
  for (const auto& part : protocol.plan) {
    if (compared) check_block(advice, part);
    check_pass(advice, part);
    if (compared || protocol.task.kind != TaskKind::single_interval) check_catch(advice, part);
  }
}

}  // namespace turnpoint::protocol

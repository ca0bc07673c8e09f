#include <algorithm>
#include <set>

#include "station/protocol/answers.hpp"
#include "station/protocol/conditions.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/reading.hpp"
#include "station/protocol/visits.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

using core::Range;
using core::TableReader;

namespace {

void read_by(TableReader& reader, Reading& reading) {
  auto& by = reading.protocol.analysis.by;
  const auto* value = reader.take("by");
  if (!value) return;
  if (value->kind == core::Value::Kind::string)
    by = {reader.maybe_string("by").value_or("")};
  else
    by = reader.maybe_strings("by");
  const auto& factors = reading.protocol.factors;
  std::set<std::string> seen;
  for (const auto& name : by) {
    const auto* factor = find_factor(factors, name);
    if (!factor)
      reader.problem("by", phrase("unknown factor \"%1\"", {plain(name)}),
                     core::suggestion(name, names(factors)));
    else if (factor->levels.empty())
      reader.problem("by", phrase("the factor \"%1\" has a range, not levels", {plain(name)}),
                     phrase("use factors with \"levels\", because one curve is fitted for each level"));
    else if (!seen.insert(name).second)
      reader.problem("by", phrase("\"%1\" appears twice in %2", {plain(name), plain("\"by\"")}),
                     phrase("list each factor only once"));
    for (const auto& spec : reading.protocol.procedures)
      if (spec.level == name)
        reader.problem("by", phrase("the procedure \"%1\" sets \"%2\"", {plain(spec.name), plain(name)}),
                       phrase("use factors that no procedure sets, because each curve needs several levels "
                              "of the procedure's own factor"));
  }
  if (seen.size() != by.size()) return;
  // Reports name a condition by its levels, which may contain commas themselves.
  Protocol all = reading.protocol;
  for (const auto& factor : factors)
    if (is_group(factor) && !seen.count(factor.name))
      all.analysis.by.insert(all.analysis.by.begin(), factor.name);
  std::set<std::string> named;
  for (const auto& name : conditions(all))
    if (!named.insert(name).second)
      return reader.problem("by", phrase("two conditions have the name \"%1\"", {plain(name)}),
                            phrase("levels whose combinations have different names"));
}

/// The number of conditions that the report of a study has: those of `by` or the instructions, for each group
/// of participants.
std::size_t conditions_of_study(const Protocol& protocol) {
  const auto& by = protocol.analysis.by;
  std::size_t count = by.empty() ? std::max<std::size_t>(1, protocol.instructions.size()) : 1;
  for (const auto& factor : protocol.factors)
    if (is_group(factor) || std::find(by.begin(), by.end(), factor.name) != by.end())
      count *= factor.levels.size();
  return count;
}

/// Why a value of `show` would add nothing to the report of this protocol; empty if it would add something.
core::Phrase without_effect(const std::string& word, const Protocol& protocol) {
  const auto& task = protocol.task;
  // do not add a second message: the reader of [task] has reported a task without choices
  if (word == "trace" || task.choices.empty()) return {};
  if (task.kind == TaskKind::adjustment) return phrase("an adjustment task has settings instead of answers");
  if (task.kind == TaskKind::comparison) return phrase("in a comparison no answer is right or wrong");
  if (word == "dprime" && task.present) return {};
  if (judges(task)) return phrase("ratings and numbers are neither right nor wrong");
  const auto& procedures = protocol.procedures;
  if ((word == "psychometric" || word == "dprime") && !procedures.empty() &&
      std::all_of(procedures.begin(), procedures.end(), [&](const auto& spec) {
        return answer_rule(protocol, spec.level).kind == AnswerKind::category;
      }))
    return phrase("the level decides which answer is right, not how difficult the trial is");
  if (word == "ez" && task.choices.size() > 2 && task.kind != TaskKind::oddity)
    return phrase("the diffusion model is a model of two answers");
  if (word == "ez" && protocol.timing.signal)
    return phrase("the response signal decides when answers come, not the decision");
  const auto& by = protocol.analysis.by;
  for (const auto& spec : protocol.procedures)
    if (word == "psychometric" && spec.second &&
        std::find(by.begin(), by.end(), spec.second->level) == by.end())
      return phrase("the threshold depends on \"%1\", so one curve does not describe all trials",
                    {plain(spec.second->level)});
  if (word == "psychometric") return {};
  if (!scored(task)) return phrase("without \"correct\" in [task], no answer is right or wrong");
  if (word == "response-signal" && !protocol.timing.signal)
    return phrase("[timing] has no \"response_signal\"");
  if (word == "dprime" && (task.kind == TaskKind::oddity || task.kind == TaskKind::same_different))
    return phrase("d' is not estimated for \"oddity\" and \"same-different\"");
  if (word == "bis" && conditions_of_study(protocol) < 2)
    return phrase("BIS compares conditions, and there is only one");
  return {};
}

void read_show(TableReader& reader, Reading& reading) {
  auto& analysis = reading.protocol.analysis;
  if (!reader.has("show")) return;
  const auto& shown = reader.words("show");
  analysis.show = reader.maybe_strings("show");
  const auto all = as_tasks_see(reading);
  // why it would show nothing of any task
  const auto without_any_effect = [&all](const std::string& word) {
    core::Phrase reason;
    for (const auto& one : all) {
      const auto why = without_effect(word, one);
      if (why.empty()) return why;
      if (reason.empty()) reason = why;
    }
    return reason;
  };
  std::vector<std::string> useful;
  for (const auto& word : shown)
    if (without_any_effect(word).empty()) useful.push_back(word);
  for (const auto& word : *analysis.show) {
    if (std::find(shown.begin(), shown.end(), word) == shown.end()) {
      reader.problem("show", phrase("\"%1\" has \"%2\"", {plain("show"), plain(word)}),
                     core::suggestion(word, shown));
      continue;
    }
    const auto reason = without_any_effect(word);
    if (!reason.empty())
      reader.problem("show", phrase("\"%1\" would show nothing: %2", {plain(word), reason}),
                     phrase("allowed here: %1", {core::quoted_list(useful)}));
  }
}

}  // namespace

void read_analysis(TableReader& file, Reading& reading) {
  if (const auto& sessions = reading.protocol.sessions)
    reading.protocol.analysis.count_incomplete = sessions->incomplete == Unfinished::count;
  const auto* table = file.maybe_table("analysis");
  if (!table) return;
  TableReader reader(*table, "analysis", reading.findings, file.keys("analysis"));
  auto& analysis = reading.protocol.analysis;
  const auto& factors = reading.protocol.factors;
  read_by(reader, reading);
  if (const auto* difficulty = reader.take("difficulty"))
    analysis.difficulty =
        linear_from(*difficulty, "difficulty", reader.range("difficulty"), factors, reading.findings);
  read_show(reader, reading);
  const auto& sessions = reading.protocol.sessions;
  const auto incomplete = reader.maybe_word("incomplete_sessions");
  if (const auto holm = reader.maybe_word("holm")) analysis.holm = *holm == "all" ? Holm::all : Holm::measure;
  if (const auto pairs = reader.maybe_word("pairs")) {
    analysis.pairs = *pairs == "thurstone" ? core::Function::normal : core::Function::logistic;
    const auto all = as_tasks_see(reading);
    if (std::none_of(all.begin(), all.end(), [](const Protocol& one) {
          return one.task.kind == TaskKind::comparison && one.task.intervals.size() == 2;
        }))
      reader.problem("pairs", phrase("the task does not compare pairs"),
                     phrase("%1 with two intervals", {plain("kind = \"comparison\"")}));
  }
  if (incomplete) analysis.count_incomplete = *incomplete == "count";
  if (incomplete == "leave_out" && sessions && sessions->incomplete == Unfinished::count)
    reader.problem(
        "incomplete_sessions",
        phrase("the protocol counts unfinished sessions already ([sessions] incomplete = \"count\")"),
        plain("incomplete_sessions = \"count\""));
  if (const auto* exclude = reader.maybe_table("response_time_exclude")) {
    TableReader inner(*exclude, reader.path("response_time_exclude"), reading.findings,
                      reader.keys("response_time_exclude"));
    analysis.exclude_below_s = inner.number("below_s");
    analysis.exclude_mad = inner.maybe_number("mad");
    inner.finish();
  }
  reader.finish();
}

}  // namespace turnpoint::protocol

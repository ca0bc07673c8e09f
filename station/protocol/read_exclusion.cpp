#include <algorithm>

#include "station/protocol/answers.hpp"
#include "station/protocol/reading.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

using core::TableReader;

namespace {

/// Reports rules that could never exclude anyone.
void check_rules(TableReader& reader, const Reading& reading) {
  const auto& protocol = reading.protocol;
  const auto& rules = *protocol.exclusion;
  const auto all = as_tasks_see(reading);
  bool catches = false;
  for (const auto& part : protocol.plan)
    catches = catches ||
              (std::holds_alternative<Block>(part) ? std::get<Block>(part) : std::get<Sequence>(part).block)
                  .catch_trials.has_value();
  if (rules.catch_accuracy_below && !catches)
    reader.problem("catch_accuracy_below", phrase("no block has catch trials"),
                   protocol.task.kind == TaskKind::comparison
                       ? phrase("leave this rule out")
                       : phrase("add \"catch\" to a block, or leave this rule out"));
  // Do not report a task without choices again: the reader of [task] has reported that mistake.
  const auto judged = [](const Protocol& one) {
    const auto& task = one.task;
    const bool broken = task.kind == TaskKind::single_interval && !judges(task) && task.choices.empty();
    return broken || (task.kind != TaskKind::adjustment && scored(task));
  };
  if (rules.accuracy_below && std::none_of(all.begin(), all.end(), judged))
    reader.problem("accuracy_below", phrase("no answer of this task is right or wrong"),
                   phrase("leave this rule out"));
}

}  // namespace

void read_exclusion(TableReader& file, Reading& reading) {
  const auto* table = file.maybe_table("exclusion");
  if (!table) return;
  TableReader reader(*table, "exclusion", reading.findings, file.keys("exclusion"));
  auto& rules = reading.protocol.exclusion.emplace();
  rules.fewer_trials_than = reader.maybe_integer("fewer_trials_than");
  rules.accuracy_below = reader.maybe_number("accuracy_below");
  rules.catch_accuracy_below = reader.maybe_number("catch_accuracy_below");
  rules.timeouts_above = reader.maybe_number("timeouts_above");
  rules.anticipations_above = reader.maybe_number("anticipations_above");
  rules.median_time_below_s = reader.maybe_number("median_time_below_s");
  rules.median_time_above_s = reader.maybe_number("median_time_above_s");
  rules.incomplete = reader.boolean("incomplete");
  if (rules.median_time_below_s && rules.median_time_above_s &&
      *rules.median_time_below_s >= *rules.median_time_above_s)
    reader.problem("median_time_below_s", phrase("every median time would be excluded"),
                   phrase("write a value below \"median_time_above_s\""));
  check_rules(reader, reading);
  reader.finish();
  if (table->entries.empty())
    reading.findings.add(table->place, phrase("[exclusion] has no rule"),
                         phrase("state at least one, or leave the table out"));
}

}  // namespace turnpoint::protocol

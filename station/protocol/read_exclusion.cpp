#include "station/protocol/answers.hpp"
#include "station/protocol/reading.hpp"

namespace turnpoint::protocol {

using texts::phrase, texts::plain;

using text::Range;
using text::TableReader;

namespace {

/// Reports rules that could never exclude anyone.
void check_rules(TableReader& reader, const Reading& reading) {
  const auto& protocol = reading.protocol;
  const auto& rules = *protocol.exclusion;
  bool catches = false;
  for (const auto& part : protocol.plan)
    catches = catches ||
              (std::holds_alternative<Block>(part) ? std::get<Block>(part) : std::get<Sequence>(part).block)
                  .catch_trials.has_value();
  if (rules.catch_accuracy_below && !catches)
    reader.problem("catch_accuracy_below", phrase("no block has catch trials"),
                   phrase("add \"catch\" to a block, or leave this rule out"));
  const auto& task = protocol.task;
  // Do not report a task without choices again: the reader of [task] has reported that mistake.
  const bool unscored =
      judges(task) || task.kind == TaskKind::adjustment ||
      (task.kind == TaskKind::single_interval && !task.choices.empty() && task.correct_answer.empty());
  if (rules.accuracy_below && unscored)
    reader.problem("accuracy_below", phrase("no answer of this task is right or wrong"),
                   phrase("leave this rule out"));
}

}  // namespace

void read_exclusion(TableReader& file, Reading& reading) {
  const auto* table = file.maybe_table("exclusion");
  if (!table) return;
  TableReader reader(*table, "exclusion", reading.findings);
  auto& rules = reading.protocol.exclusion.emplace();
  const Range share{0, 1, Range::Ends::open};
  rules.fewer_trials_than = reader.maybe_integer("fewer_trials_than", 1, 100000);
  rules.accuracy_below = reader.maybe_number("accuracy_below", share);
  rules.catch_accuracy_below = reader.maybe_number("catch_accuracy_below", {0, 1, Range::Ends::open_low});
  rules.timeouts_above = reader.maybe_number("timeouts_above", {0, 1, Range::Ends::open_high});
  rules.anticipations_above = reader.maybe_number("anticipations_above", {0, 1, Range::Ends::open_high});
  rules.median_time_below_s =
      reader.maybe_number("median_time_below_s", {0, 600, Range::Ends::open_low, "s"});
  rules.median_time_above_s =
      reader.maybe_number("median_time_above_s", {0, 600, Range::Ends::open_low, "s"});
  rules.incomplete = reader.boolean("incomplete", "false");
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

#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "station/store/read.hpp"
#include "station/store/text_table.hpp"

namespace turnpoint::store {

/// How the codebook describes a column.
struct Column {
  std::string name, description, unit, values;  ///< unit and values are "" if the column has none
  std::vector<std::string> levels = {};         ///< of a factor whose values are texts
};

/// A factor of the protocol. Its levels are those that are texts, as presented in the exported trials.
struct ExportedFactor {
  std::string name;
  std::vector<std::string> levels;
};

/// The time from the start of a trial's first stimulus to the end of its last stimulus.
struct StimulusSpan {
  double onset_s = 0;  ///< start of the first stimulus, from the start of the program run (segment)
  double duration_s = 0;
};

/// Returns the spans of a session's trials by trial_index. The onset of a span is relative to the segment in
/// which its trial ended. A trial that ended before its first stimulus has no span.
std::map<int, StimulusSpan> stimulus_spans(const StoredSession& stored);
std::optional<StimulusSpan> span_of(const std::map<int, StimulusSpan>& spans, const TrialRow& trial);

/// Returns the length of the stimulus for an event that reports a stimulus; 0 for all other events.
double event_length_s(const EventRow& event);

/// Sorts the events of each segment by the time at which they happened. The database has them in the order in
/// which the session learned of them.
std::vector<EventRow> in_order_of_time(std::vector<EventRow> events);

/// The data from which the columns of one exported line are computed. Each table sets the pointers that its
/// columns need; the others are null.
struct ExportRow {
  const SessionRecord* session = nullptr;
  const BlockStart* block = nullptr;
  const TrialRow* trial = nullptr;
  const ToneRow* tone = nullptr;
  const EventRow* event = nullptr;
  std::int64_t origin_ns = 0;               ///< start of the program run of `event` (CLOCK_MONOTONIC)
  std::optional<StimulusSpan> span = {};    ///< time span of the trial's stimuli
  const CheckRow* check = nullptr;          ///< a check of the self-test in `event`
  const FrictionLevelRow* level = nullptr;  ///< a level of the friction table in `event`
  const ProgramRow* program = nullptr;      ///< a separate program in `event`
  const EstimateRow* estimate = nullptr;    ///< an estimate in `event`
  const AnswerRow* answer = nullptr;        ///< the answer in `event`
  const EventRow* self_test = nullptr;      ///< the newest self-test of the session; null if there was none
  const TrialRow* previous = nullptr;       ///< see previous_trial(); null if there was none
};

/// The trial of this block that was presented just before the trial at `index`, whatever became of it. Null
/// for the first trial of an attempt at the block, and for the first one after an interruption of the
/// session.
inline const TrialRow* previous_trial(const BlockRecord& block, std::size_t index) {
  if (index == 0) return nullptr;
  const auto &trial = block.trials[index], &before = block.trials[index - 1];
  return before.segment_index == trial.segment_index ? &before : nullptr;
}

/// A column of an exported table: its description, and the function that computes the column's value in a
/// line.
struct ExportColumn {
  Column column;
  std::function<Cell(const ExportRow&)> cell;
};
using ExportColumns = std::vector<ExportColumn>;

/// Return the columns of a table in their fixed order. Among the columns of `trials`, the protocol's factors
/// have a fixed place. A factor with the name of another column is exported as factor_NAME.
ExportColumns trial_columns(const std::vector<ExportedFactor>& factors);
ExportColumns interval_columns();
ExportColumns event_columns();
ExportColumns session_columns();
ExportColumns self_test_columns();
ExportColumns answer_columns();
ExportColumns friction_columns();
ExportColumns program_columns();
ExportColumns estimate_columns();

/// The newest self-test of a session; null if there was none.
const EventRow* newest_self_test(const StoredSession& stored);

std::vector<std::string> names_of(const ExportColumns& columns);
std::vector<std::string> names_of(const std::vector<Column>& columns);
std::vector<Cell> cells_of(const ExportColumns& columns, const ExportRow& row);

/// Returns the data dictionary (codebook) of an export folder as JSON. Columns are grouped by table.
std::string codebook_json(const std::string& protocol_id, const std::vector<ExportedFactor>& factors);

/// Returns only the columns as JSON, in the form of BIDS sidecars and codebooks: name -> Description, Units,
/// Values, Levels.
std::string columns_json(const std::vector<Column>& columns);
std::vector<Column> explanations(const ExportColumns& columns);

}  // namespace turnpoint::store

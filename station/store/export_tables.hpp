#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "station/store/read.hpp"
#include "station/store/text_table.hpp"

namespace turnpoint::store {

/// The description of a column in the codebook.
struct Column {
  std::string name, description, unit, values;  ///< unit and values are "" if there are none
};

/// The time span of a trial's stimuli, from the start of the first to the end of the last.
struct StimulusSpan {
  double onset_s = 0;  ///< start of the first stimulus, relative to the start of the segment
  double duration_s = 0;
};

/// The spans of a session's trials by trial_index, each relative to the segment in which the trial ended. A
/// trial that ended before its stimulus has no span.
std::map<int, StimulusSpan> stimulus_spans(const StoredSession& stored);
std::optional<StimulusSpan> span_of(const std::map<int, StimulusSpan>& spans, const TrialRow& trial);

/// The length of a stimulus, read from its event's value; 0 for every other event.
double event_length_s(const EventRow& event);

/// Sorts events by the time at which they happened, segment by segment. The database stores them by the time
/// at which they became known.
std::vector<EventRow> in_order_of_time(std::vector<EventRow> events);

/// The data from which one line of an export is made. Each table sets the pointers that it needs; the others
/// are null.
struct ExportRow {
  const SessionRecord* session = nullptr;
  const BlockStart* block = nullptr;
  const TrialRow* trial = nullptr;
  const ToneRow* tone = nullptr;
  const EventRow* event = nullptr;
  std::int64_t origin_ns = 0;             ///< CLOCK_MONOTONIC at the start of the event's segment
  std::optional<StimulusSpan> span = {};  ///< span of the trial's stimuli
};

/// A column of an exported table: its description, and the function that gives its value in a line.
struct ExportColumn {
  Column column;
  std::function<Cell(const ExportRow&)> cell;
};
using ExportColumns = std::vector<ExportColumn>;

/// The columns in their fixed order. The protocol's factors have a fixed place among the columns of `trials`;
/// a factor with the name of another column is exported as factor_NAME.
ExportColumns trial_columns(const std::vector<std::string>& factors);
ExportColumns interval_columns();
ExportColumns event_columns();
ExportColumns session_columns();

std::vector<std::string> names_of(const ExportColumns& columns);
std::vector<std::string> names_of(const std::vector<Column>& columns);
std::vector<Cell> cells_of(const ExportColumns& columns, const ExportRow& row);

/// The data dictionary of a folder as JSON, with columns grouped by table.
std::string codebook_json(const std::string& protocol_id, const std::vector<std::string>& factors);

/// Only the columns, as BIDS sidecars and codebooks describe them: name -> Description, Units, Values.
std::string columns_json(const std::vector<Column>& columns);
std::vector<Column> explanations(const ExportColumns& columns);

}  // namespace turnpoint::store

#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "station/store/read.hpp"
#include "station/store/text_table.hpp"

namespace turnpoint::store {

/// A column as the codebook explains it.
struct Column {
  std::string name, description, unit, values;  ///< unit and values "" where there is nothing to say
};

/// When a trial's stimuli were on the surface: from the start of the first to the end of the last.
struct StimulusSpan {
  double onset_s = 0;  ///< from the start of the segment
  double duration_s = 0;
};

/// The spans of a session's trials by trial_index, each in the segment that the trial ended in. A trial that
/// ended before its stimulus has none.
std::map<int, StimulusSpan> stimulus_spans(const StoredSession& stored);
std::optional<StimulusSpan> span_of(const std::map<int, StimulusSpan>& spans, const TrialRow& trial);

/// The length of a stimulus, which is what its event's value says; 0 for every other event.
double event_length_s(const EventRow& event);

/// The events in the order in which they happened, segment by segment. Stored is when each became known.
std::vector<EventRow> in_order_of_time(std::vector<EventRow> events);

/// What a line of an export is made from. Each table sets what it has; the rest is null.
struct ExportRow {
  const SessionRecord* session = nullptr;
  const BlockStart* block = nullptr;
  const TrialRow* trial = nullptr;
  const ToneRow* tone = nullptr;
  const EventRow* event = nullptr;
  std::int64_t origin_ns = 0;             ///< CLOCK_MONOTONIC at the start of the event's segment
  std::optional<StimulusSpan> span = {};  ///< of the trial's stimuli
};

/// A column of an exported table: what it is, and its value in a line.
struct ExportColumn {
  Column column;
  std::function<Cell(const ExportRow&)> cell;
};
using ExportColumns = std::vector<ExportColumn>;

/// The columns in their fixed order; those of `trials` have the protocol's factors in their place, a factor
/// that is called like another column as factor_NAME.
ExportColumns trial_columns(const std::vector<std::string>& factors);
ExportColumns interval_columns();
ExportColumns event_columns();
ExportColumns session_columns();

std::vector<std::string> names_of(const ExportColumns& columns);
std::vector<std::string> names_of(const std::vector<Column>& columns);
std::vector<Cell> cells_of(const ExportColumns& columns, const ExportRow& row);

/// The data dictionary of a folder as JSON, columns by table.
std::string codebook_json(const std::string& protocol_id, const std::vector<std::string>& factors);

/// The columns alone, as BIDS sidecars and codebooks explain them: name -> Description, Units, Values.
std::string columns_json(const std::vector<Column>& columns);
std::vector<Column> explanations(const ExportColumns& columns);

}  // namespace turnpoint::store

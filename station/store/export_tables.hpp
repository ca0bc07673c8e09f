#pragma once
#include <functional>
#include <string>
#include <vector>

#include "station/store/read.hpp"
#include "station/store/text_table.hpp"

namespace turnpoint::store {

/// A column as the codebook explains it.
struct Column {
  std::string name, description, unit, values;  ///< unit and values "" where there is nothing to say
};

/// What a line of an export is made from. Each table sets what it has; the rest is null.
struct ExportRow {
  const SessionRecord* session = nullptr;
  const BlockStart* block = nullptr;
  const TrialRow* trial = nullptr;
  const ToneRow* tone = nullptr;
  const EventRow* event = nullptr;
  std::int64_t origin_ns = 0;  ///< CLOCK_MONOTONIC at the start of the event's segment
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
std::vector<Cell> cells_of(const ExportColumns& columns, const ExportRow& row);

/// The data dictionary of a folder as JSON, columns by table.
std::string codebook_json(const std::string& protocol_id, const std::vector<std::string>& factors);

/// The same for one table as a BIDS sidecar.
std::string sidecar_json(const std::string& task, const std::vector<Column>& columns);
std::vector<Column> explanations(const ExportColumns& columns);

}  // namespace turnpoint::store

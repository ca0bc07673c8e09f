#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "station/store/export_files.hpp"
#include "station/store/export_tables.hpp"

namespace turnpoint::store {

// What a BIDS data set says about itself, beside its tables.

std::string bids_description(const ProtocolSelection& selection);
std::string bids_readme(const ProtocolSelection& selection);

/// The sidecar of a table, by the newest session: the task, what the participant read, and the program, then
/// each column.
std::string bids_sidecar(const SessionStart& start, const std::vector<Column>& columns);

/// The columns of trials.csv; onset and duration are called stimulus_onset and stimulus_duration, since BIDS
/// keeps the short names for tables of events.
ExportColumns bids_trial_columns(const std::vector<std::string>& factors);
std::vector<Column> bids_participant_columns();
std::vector<Column> bids_event_columns();

/// `origin_ns`: start of the segment on the station's clock.
std::vector<Cell> bids_event_cells(const EventRow& event, std::int64_t origin_ns);

/// Letters and digits of a text: what a BIDS label may have.
std::string bids_label(const std::string& text);

}  // namespace turnpoint::store

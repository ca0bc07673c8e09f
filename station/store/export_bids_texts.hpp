#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "station/store/export_files.hpp"
#include "station/store/export_tables.hpp"

namespace turnpoint::store {

// Texts that a BIDS data set contains in addition to its tables.

std::string bids_description(const ProtocolSelection& selection);
std::string bids_readme(const ProtocolSelection& selection);

/// Returns the BIDS sidecar file (JSON) of a table. It describes the task, the participant's instructions and
/// the program, as in the newest session, and then each column.
std::string bids_sidecar(const SessionStart& start, const std::vector<Column>& columns);

/// Returns the columns of trials.csv. Onset and duration are called stimulus_onset and stimulus_duration,
/// because BIDS reserves the short names for tables of events.
ExportColumns bids_trial_columns(const std::vector<std::string>& factors);
std::vector<Column> bids_participant_columns();
std::vector<Column> bids_event_columns();

/// Returns the values of an event's row in the table. `origin_ns` is the time on the station's clock at which
/// the event's run of the program (segment) began.
std::vector<Cell> bids_event_cells(const EventRow& event, std::int64_t origin_ns);

/// Returns only the letters and digits of a text. A BIDS label may contain no other characters.
std::string bids_label(const std::string& text);

}  // namespace turnpoint::store

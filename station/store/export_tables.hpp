#pragma once
#include <string>
#include <vector>

#include "station/store/read.hpp"
#include "station/store/text_table.hpp"

namespace turnpoint::store {

/// A column as the codebook explains it.
struct Column {
  std::string name, description, unit, values;  ///< unit and values "" where there is nothing to say
};

/// The columns in the fixed order; those of `trials` have the protocol's factors in their place, a
/// factor that is called like another column as factor_NAME.
std::vector<Column> trial_columns(const std::vector<std::string>& factors);
std::vector<Column> interval_columns();
std::vector<Column> event_columns();
std::vector<Column> session_columns();

std::vector<std::string> names_of(const std::vector<Column>& columns);

/// The cells of one row, in the order of the columns above.
std::vector<Cell> trial_cells(const SessionRecord& session, const BlockStart& block, const TrialRow& trial,
                              const std::vector<std::string>& factors);
std::vector<Cell> interval_cells(const SessionRecord& session, const BlockStart& block, const TrialRow& trial,
                                 const ToneRow& tone);
std::vector<Cell> event_cells(const SessionRecord& session, const EventRow& event, std::int64_t origin_ns);
std::vector<Cell> session_cells(const SessionRecord& session);

/// The data dictionary of a folder as JSON, columns by table.
std::string codebook_json(const std::string& protocol_id, const std::vector<std::string>& factors);

/// The same for one table as a BIDS sidecar.
std::string sidecar_json(const std::string& task, const std::vector<Column>& columns);

}  // namespace turnpoint::store

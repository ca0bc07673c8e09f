#pragma once
#include <string>

#include "station/records/records.hpp"

namespace turnpoint::store {

// The records keep their own names in the store.
using namespace records;

/// These functions convert the database's words back to enums. They throw StoreError (corrupt) for a word
/// that no release wrote.
RunMode run_mode_named(const std::string& word);
SessionStatus session_status_named(const std::string& word);
Outcome trial_outcome_named(const std::string& word);
TrialType trial_type_named(const std::string& word);

}  // namespace turnpoint::store

#pragma once
#include <string>

#include "station/store/records.hpp"

namespace turnpoint::store {

/// These functions convert the database's words back to enums. They throw StoreError (corrupt) for a word
/// that no release wrote.
RunMode run_mode_named(const std::string& word);
SessionStatus session_status_named(const std::string& word);
Outcome trial_outcome_named(const std::string& word);
TrialType trial_type_named(const std::string& word);

}  // namespace turnpoint::store

#pragma once
#include <string>

#include "station/store/records.hpp"

namespace turnpoint::store {

/// The words of the database back into enums. Throw StoreError (corrupt) for a word that no release wrote.
RunMode run_mode_named(const std::string& word);
SessionStatus session_status_named(const std::string& word);
Outcome trial_outcome_named(const std::string& word);
TrialType trial_type_named(const std::string& word);

}  // namespace turnpoint::store

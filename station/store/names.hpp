#pragma once
#include <string>

#include "station/core/records.hpp"

namespace turnpoint::store {

// Lets the code of the store use the names of the records without a prefix.
using namespace core;

/// Convert the database's words to enums. They throw StoreError (corrupt) for a word that no release has
/// written.
RunMode run_mode_named(const std::string& word);
SessionStatus session_status_named(const std::string& word);
Outcome trial_outcome_named(const std::string& word);
Proof proof_named(const std::string& word);
ProofCause proof_cause_named(const std::string& word);
TrialType trial_type_named(const std::string& word);
Verdict verdict_named(const std::string& word);

}  // namespace turnpoint::store

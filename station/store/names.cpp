#include "station/store/names.hpp"

#include <array>

#include "station/store/error.hpp"

namespace turnpoint::store {

namespace {

template <class Values>
auto named(const std::string& word, const Values& values) {
  for (const auto value : values)
    if (word == name(value)) return value;
  throw StoreError(ErrorKind::corrupt, "the database contains the word \"" + word +
                                           "\", which no release of Turnpoint has ever written");
}

}  // namespace

RunMode run_mode_named(const std::string& word) { return named(word, core::run_modes); }

SessionStatus session_status_named(const std::string& word) {
  return named(word, std::array{SessionStatus::running, SessionStatus::completed, SessionStatus::interrupted,
                                SessionStatus::stopped, SessionStatus::abandoned});
}

Outcome trial_outcome_named(const std::string& word) { return named(word, core::outcomes); }
Proof proof_named(const std::string& word) { return named(word, core::proofs); }
ProofCause proof_cause_named(const std::string& word) { return named(word, core::proof_causes); }

Verdict verdict_named(const std::string& word) { return named(word, core::verdicts); }

TrialType trial_type_named(const std::string& word) { return named(word, core::trial_types); }

}  // namespace turnpoint::store

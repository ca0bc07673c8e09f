#include "station/store/names.hpp"

#include <initializer_list>

#include "station/store/error.hpp"

namespace turnpoint::store {

const char* name(RunMode mode) {
  switch (mode) {
    case RunMode::live:
      return "live";
    case RunMode::pilot:
      return "pilot";
    case RunMode::simulated:
      return "simulated";
  }
  return "";
}

const char* name(SessionStatus status) {
  switch (status) {
    case SessionStatus::running:
      return "running";
    case SessionStatus::completed:
      return "completed";
    case SessionStatus::interrupted:
      return "interrupted";
    case SessionStatus::stopped:
      return "stopped";
    case SessionStatus::abandoned:
      return "abandoned";
  }
  return "";
}

const char* name(TrialOutcome outcome) {
  switch (outcome) {
    case TrialOutcome::answered:
      return "answered";
    case TrialOutcome::timeout:
      return "timeout";
    case TrialOutcome::anticipation:
      return "anticipation";
    case TrialOutcome::aborted:
      return "aborted";
    case TrialOutcome::fault:
      return "fault";
  }
  return "";
}

const char* name(TrialType type) {
  switch (type) {
    case TrialType::experimental:
      return "experimental";
    case TrialType::catch_trial:
      return "catch";
    case TrialType::practice:
      return "practice";
    case TrialType::warmup:
      return "warmup";
  }
  return "";
}

namespace {

template <class Enum>
Enum named(const std::string& word, std::initializer_list<Enum> values) {
  for (const auto value : values)
    if (word == name(value)) return value;
  throw StoreError(Fault::corrupt,
                   "the database holds the word \"" + word + "\", which no release has written");
}

}  // namespace

RunMode run_mode_named(const std::string& word) {
  return named(word, {RunMode::live, RunMode::pilot, RunMode::simulated});
}

SessionStatus session_status_named(const std::string& word) {
  return named(word, {SessionStatus::running, SessionStatus::completed, SessionStatus::interrupted,
                      SessionStatus::stopped, SessionStatus::abandoned});
}

TrialOutcome trial_outcome_named(const std::string& word) {
  return named(word, {TrialOutcome::answered, TrialOutcome::timeout, TrialOutcome::anticipation,
                      TrialOutcome::aborted, TrialOutcome::fault});
}

TrialType trial_type_named(const std::string& word) {
  return named(word,
               {TrialType::experimental, TrialType::catch_trial, TrialType::practice, TrialType::warmup});
}

}  // namespace turnpoint::store

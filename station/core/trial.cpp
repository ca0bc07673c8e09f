#include "station/core/trial.hpp"

namespace turnpoint::core {

namespace {

// The words are in the order of the enumerators.
constexpr const char* kOutcomes[] = {"answered", "timeout", "anticipation", "aborted", "fault"};
constexpr const char* kTypes[] = {"experimental", "catch", "practice", "warmup"};
constexpr const char* kZeros[] = {"go_cue", "change", "interval_off", "first_contact", "lift_off"};
constexpr const char* kModes[] = {"live", "pilot", "simulated"};
static_assert(std::size(kOutcomes) == outcomes.size() && std::size(kTypes) == trial_types.size() &&
              std::size(kZeros) == response_zeros.size() && std::size(kModes) == run_modes.size());

}  // namespace

const char* name(Outcome outcome) { return kOutcomes[static_cast<int>(outcome)]; }
const char* name(TrialType type) { return kTypes[static_cast<int>(type)]; }
const char* name(ResponseZero zero) { return kZeros[static_cast<int>(zero)]; }
const char* name(RunMode mode) { return kModes[static_cast<int>(mode)]; }

}  // namespace turnpoint::core

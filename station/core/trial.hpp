#pragma once
#include <array>
#include <string_view>

namespace turnpoint::core {

/// How a trial ended.
enum class Outcome { answered, timeout, anticipation, aborted, fault };

/// The purpose of a trial. Only experimental trials are used in fits. Catch trials are easy; they test
/// whether the participant pays attention.
enum class TrialType { experimental, catch_trial, practice, warmup };

/// The moment from which response times are measured.
enum class ResponseZero { go_cue, change, interval_off, first_contact, lift_off };

/// Who answers, and for what. live: a person, for the study. pilot: a person, not for the study. simulated: a
/// simulated observer.
enum class RunMode { live, pilot, simulated };

inline constexpr std::array outcomes{Outcome::answered, Outcome::timeout, Outcome::anticipation,
                                     Outcome::aborted, Outcome::fault};
inline constexpr std::array trial_types{TrialType::experimental, TrialType::catch_trial, TrialType::practice,
                                        TrialType::warmup};
inline constexpr std::array response_zeros{ResponseZero::go_cue, ResponseZero::change,
                                           ResponseZero::interval_off, ResponseZero::first_contact,
                                           ResponseZero::lift_off};
inline constexpr std::array run_modes{RunMode::live, RunMode::pilot, RunMode::simulated};

/// Return the words used in protocols, databases and exports: "answered", "catch", "go_cue", "live", ...
const char* name(Outcome outcome);
const char* name(TrialType type);
const char* name(ResponseZero zero);
const char* name(RunMode mode);

}  // namespace turnpoint::core

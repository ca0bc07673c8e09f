#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/plot/chart.hpp"
#include "station/protocol/protocol.hpp"
#include "station/records/records.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::desk {

/// What the live view keeps about a finished trial.
struct LiveTrial {
  std::string procedure;
  std::optional<double> level;
  std::optional<bool> correct;
  std::optional<double> response_time_s, threshold_est, threshold_sd;
  terms::Outcome outcome = terms::Outcome::answered;
  terms::TrialType type = terms::TrialType::experimental;
  double onset_s = 0, ended_s = 0;  ///< s from the start of the session
  double stimulus_s = 0;            ///< duration for which the stimulus was presented
  int xruns = 0, extra_touches = 0;
  records::Proof proof = records::Proof::unproven;
  records::ProofCause proof_cause = records::ProofCause::none;
};

/// The functions below say everything in a language such as "de".

/// Describes the progress of the session in words: accuracy, response times, lost frames. Pure.
std::vector<std::pair<std::string, std::string>> course_of(const std::vector<LiveTrial>& trials,
                                                           const std::string& language = "en");

/// Describes how much of the rig's limits is used up. It considers the stimuli of the last 60 s and the
/// largest displacement of the current trial (m).
std::vector<std::pair<std::string, std::string>> limits_used(const std::vector<LiveTrial>& trials,
                                                             std::optional<double> peak_displacement_m,
                                                             const rig::Rig& rig,
                                                             const std::string& language = "en");

/// Describes what the sensors measured in a trial, next to the ranges that the protocol asks for. Pure.
std::vector<std::pair<std::string, std::string>> sensors_of(const records::TrialRow& row,
                                                            const std::optional<protocol::Sensing>& asked,
                                                            const std::string& language = "en");

/// live_trace() plots the levels in the order of the trials, one series per procedure. Open markers are wrong
/// answers; a line shows the running estimate. live_times() plots the response times. Both are empty if there
/// are no data.
std::optional<plot::Figure> live_trace(const std::vector<LiveTrial>& trials, const std::string& label,
                                       const std::string& language = "en");
std::optional<plot::Figure> live_times(const std::vector<LiveTrial>& trials,
                                       const std::string& language = "en");
/// A figure of one chart, in the size that the live view uses.
plot::Figure alone(const char* title, const plot::Chart& panel);

}  // namespace turnpoint::desk

#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/core/records.hpp"
#include "station/protocol/protocol.hpp"
#include "station/report/chart.hpp"
#include "station/rig/rig.hpp"
#include "station/session/monitor.hpp"

namespace turnpoint::view {

/// The finger at this moment, as the operator sees it: a value along a scale, and the value in figures.
struct Gauge {
  std::optional<double> value;  ///< place on the scale, from 0 to 1; empty while no finger is on the surface
  double low = 0, high = 0;     ///< the range that the protocol asks for, from 0 to 1; equal if there is none
  std::string figure;           ///< such as "0.45 N"; "" while there is no value
  bool operator==(const Gauge&) const = default;
};

/// What the force cells say of the finger. Unlike the bars on the participant's page, these gauges need
/// nothing in the protocol, and they include the place of the finger.
struct FingerGauges {
  Gauge force, speed, position;
  bool operator==(const FingerGauges&) const = default;
};

/// Reads the gauges for a finger. Scales end at one and a half times the range that the protocol asks for; at
/// 2 N and 200 mm/s without such a range; and at the end of the strip. Pure.
FingerGauges finger_gauges(const std::optional<session::FingerSeen>& finger,
                           const std::optional<protocol::Sensing>& asked, const rig::Rig& rig);

/// What the live view keeps about a finished trial: its row without tones and signals.
struct LiveTrial : core::TrialRow {
  double stimulus_s = 0;  ///< duration for which the stimulus was presented
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
std::vector<std::pair<std::string, std::string>> sensors_of(const core::TrialRow& row,
                                                            const std::optional<protocol::Sensing>& asked,
                                                            const std::string& language = "en");

/// live_trace() plots the levels in the order of the trials, one series per procedure. Open markers are wrong
/// answers; a line shows the running estimate. live_times() plots the response times. Both are empty if there
/// are no data.
std::optional<report::Figure> live_trace(const std::vector<LiveTrial>& trials, const std::string& label,
                                         const std::string& language = "en");
std::optional<report::Figure> live_times(const std::vector<LiveTrial>& trials,
                                         const std::string& language = "en");
/// A figure of one chart, in the size that the live view uses.
report::Figure alone(const char* title, const report::Chart& panel);

}  // namespace turnpoint::view

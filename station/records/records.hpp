#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "station/terms/trial.hpp"

namespace turnpoint::records {

using terms::name;
using terms::Outcome;
using terms::RunMode;
using terms::TrialType;

enum class SessionStatus { running, completed, interrupted, stopped, abandoned };
/// The status reason that opening a database writes for a session whose process died.
inline constexpr const char* kLostReason = "the process ended without a word";
inline constexpr const char* kAbandonedReason = "no trial was made";

const char* name(SessionStatus status);

/// The value of a factor in a trial, as exported in the factor's column.
using FactorValue = std::variant<double, std::string>;

/// The provenance of a session: everything needed to run or explain it later.
struct SessionStart {
  std::string participant;  ///< participant code
  RunMode run_mode = RunMode::live;
  std::string protocol_id, protocol_version, protocol_path, protocol_text, protocol_sha256,
      protocol_canonical;
  std::vector<std::string> factor_columns;  ///< in the order of the protocol
  std::string level_unit;
  std::string rig_name, rig_path, rig_text, rig_sha256;
  std::optional<std::string> calibration_id;  ///< SHA-256 of the calibration file; absent on a simulated rig
  /// the calibration file itself, stored once; "" if there is none
  std::string calibration_text;
  std::uint64_t seed = 0;
  std::string language, observer;  ///< observer: "" or the argument of `--observer`
  std::string software_version, columns_version, kernel, station_id, realtime_rights;
  std::string started_local;  ///< ISO 8601 with zone
  std::string consent_version;
};

/// One process run of a session, with the origin of its monotonic clock. Each resume opens another segment.
struct SegmentStart {
  std::string boot_id, reason;  ///< reason: "start", "resume" or "fault"
  std::int64_t monotonic_ns = 0, boottime_ns = 0, realtime_ns = 0;
};

struct BlockStart {
  int block_index = 0;  ///< from 0, in the order in which blocks are run
  int attempt = 0;      ///< incremented with each restart of the same block
  std::string name, instruction;
  bool practice = false;
};

/// One tone of one interval, as it was driven.
struct ToneRow {
  int interval_index = 0;  ///< from 0, in the order of presentation
  int scene_index = 0;     ///< position within the interval's sequence
  int tone_index = 0;
  std::string scene;
  std::optional<double> boundary_mm;
  double frequency_Hz = 0;
  double amplitude_um = 0;  ///< amplitude at the drive edge
  std::optional<double> displacement_um, friction;
  double rove_dB = 0;
  std::string model;
  double error_bound_mm = 0, uncertainty_mm = 0;
  std::string reason;
  std::int64_t onset_frame = 0, length_frames = 0;
};

/// The result of one trial, committed as a whole before the next one begins.
struct TrialRow {
  int segment_index = 1;   ///< from 1; set by the log, not by the caller
  int trial_index = 0;     ///< from 0 within the session; counts every presented trial
  int trial_in_block = 0;  ///< key of the trial's random draws
  TrialType type = TrialType::experimental;
  std::string procedure;
  std::optional<double> level;
  std::map<std::string, FactorValue> factors;
  std::optional<double> boundary_mm, frequency_Hz, amplitude;
  std::optional<std::string> correct_response, response;
  std::optional<bool> correct;
  Outcome outcome = Outcome::answered;
  std::int64_t onset_ns = 0;  ///< CLOCK_MONOTONIC (or virtual time) at response_zero
  double onset_s = 0;         ///< the same from the start of the segment
  double duration_s = 0;
  std::optional<double> response_time_s, decision_time_s, movement_time_s;
  std::string response_zero, response_time_quality;  ///< quality: kernel | toolkit | simulated
  double response_offset_s = 0;
  std::optional<double> deadline_s;
  int xruns = 0, extra_touches = 0;
  std::optional<double> threshold_est, threshold_sd;
  /// slope and residual of the regression between frames and time
  std::optional<double> clock_slope_ns_per_frame, clock_residual_ns;
  std::uint64_t state_hash = 0;  ///< state of the block's procedures after this trial
  std::vector<ToneRow> tones;
};

/// A block of a stored session with its finished trials, in the order in which they were run.
struct BlockRecord {
  BlockStart start;
  std::vector<TrialRow> trials;
};

/// Any event with a time stamp: touches, button edges, xruns, presentations, faults.
struct EventRow {
  std::int64_t time_ns = 0;
  std::string kind;
  std::string value;
  std::optional<int> trial_index;
  int segment_index = 1;  ///< from 1; set by the log
};

}  // namespace turnpoint::records

#pragma once
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <span>
#include <sstream>
#include <string>

#include "station/store/session_log.hpp"
#include "station/store/signal_code.hpp"
#include "station/store/sqlite.hpp"
#include "tests/support/temporary_folder.hpp"

namespace sample {

using namespace turnpoint::store;

inline SessionStart start(const std::string& participant = "P01") {
  SessionStart s;
  s.participant = participant;
  s.run_mode = RunMode::simulated;
  s.protocol_id = "two-boundaries";
  s.protocol_version = "1.2.0";
  s.protocol_path = "protocols/two.toml";
  s.protocol_text = "format = \"friction-protocol/1\"\n";
  s.protocol_sha256 = std::string(64, 'a');
  s.protocol_canonical = "canonical";
  s.factor_columns = {"contrast", "instruction"};
  s.level_unit = "dB";
  s.rig_name = "plate";
  s.rig_path = "rigs/plate.toml";
  s.rig_text = "format = \"friction-rig/1\"\n[output]\nrate_Hz = 192000\n";
  s.rig_sha256 = std::string(64, 'b');
  s.seed = 20240229;
  s.language = "en";
  s.observer = "sim:threshold=0.1";
  s.software_version = "0.1.0";
  s.columns_version = "1";
  s.kernel = "Linux 6.1";
  s.station_id = "bench-a";
  s.realtime_rights = "none";
  s.started_local = "2024-02-29T10:00:00+01:00";
  s.consent_version = "c1";
  s.planned_session = 2;
  s.groups = {"trained", "untrained"};
  return s;
}

inline SegmentStart segment(const std::string& reason = "start") {
  return {"boot-1", reason, 1'000'000'000, 2'000'000'000, 1'709'197'200'000'000'000};
}

inline ToneRow tone(int interval, int index) {
  ToneRow t;
  t.interval_index = interval;
  t.tone_index = index;
  t.scene = interval == 0 ? "reference" : "comparison";
  t.boundary_mm = 150.25;
  t.frequency_Hz = 30123.4567890123;
  t.amplitude_um = 0.75;
  t.displacement_um = 2.5;
  t.friction = 0.62;
  t.model = "mode";
  t.error_bound_mm = 0.1;
  t.uncertainty_mm = 0.4;
  t.level_uncertainty_dB = 2.75;
  t.reason = "cheapest inside the tolerance";
  t.onset_frame = 192000 + interval * 96000;
  t.length_frames = 96000;
  t.measured_dB = -0.5;
  t.measured_phase_deg = 3.25;
  t.of_interval = interval;
  return t;
}

/// Half a second of a finger's forces, position and speed; position and speed are missing at first.
inline SignalRow finger_signal(int index) {
  SignalRow s;
  s.stream = "finger";
  s.start_frame = 192000 * (1 + index);
  s.start_s = 1.5 + index;
  s.rate_Hz = 1000;
  s.channels = {
      {"normal", "N", 1e-4}, {"lateral", "N", 1e-4}, {"position", "mm", 0.01}, {"speed", "mm/s", 0.1}};
  constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::vector<double>> values(4);
  for (int k = 0; k < 500; ++k) {
    values[0].push_back(0.5 + 0.1 * std::sin(0.02 * k + index));
    values[1].push_back(0.3 * std::cos(0.01 * k));
    values[2].push_back(k < 20 ? missing : 100 + 0.08 * k);
    values[3].push_back(k < 20 ? missing : 80 - 0.3 * k);
  }
  encode(s, values);
  return s;
}

/// Captured samples of two channels, with the extreme values and a sample that was lost.
inline SignalRow raw_signal(int index) {
  SignalRow s;
  s.stream = kRawStream;
  s.start_frame = 192000 * (1 + index);
  s.start_s = 1.5 + index;
  s.rate_Hz = 192000;
  s.channels = {{"channel_0", "", 1}, {"channel_1", "", 1}};
  constexpr auto most = std::numeric_limits<std::int32_t>::max(), least = -most;
  const std::vector<std::int32_t> samples{0, most, -256, least, std::numeric_limits<std::int32_t>::min(), 77};
  encode(s, std::span(samples));
  return s;
}

inline TrialRow answered(int index, int tones = 2) {
  TrialRow t;
  t.trial_index = index;
  t.trial_in_block = index;
  t.procedure = "staircase";
  t.level = -12.5 + 0.1 * index;
  t.factors = {{"contrast", 0.1 + 0.2}, {"instruction", std::string("speed")}};
  t.presented.boundary_mm = 150.25;
  t.presented.frequency_Hz = 30123.4567890123;
  t.presented.amplitude = 2.5;
  t.correct_response = "first";
  t.given.response = index % 3 == 0 ? "second" : "first";
  t.given.correct = index % 3 != 0;
  t.timing.onset_ns = 3'000'000'000 + 1'000'000'000LL * index;
  t.timing.onset_s = 2.0 + index;
  t.timing.duration_s = 3.5;
  t.timing.response_time_s = 0.4375 + 0.001 * index;
  t.timing.response_zero = "go_cue";
  t.timing.response_time_quality = "simulated";
  t.timing.deadline_s = 2.0;
  t.learned.threshold_est = -10.0;
  t.learned.threshold_sd = 1.5;
  t.timing.clock_slope_ns_per_frame = 5208.333;
  t.timing.clock_residual_ns = 42;
  t.surface.proof = Proof::flagged;
  t.surface.proof_cause = ProofCause::level;
  t.surface.drive_ratio_dB = -0.75;
  t.surface.drive_residual_dB = -55;
  t.surface.onset_error_us = 12.5;
  t.surface.silence_dB = -57.5;
  t.surface.silence_tone_dB = -82.25;
  t.given.confidence = 1 + index % 4;
  t.given.confidence_time_s = 0.75;
  t.given.points = 2.5;
  t.given.again = 6;
  t.finger.sensing = "ok";
  t.finger.contact_s = 2.25;
  t.finger.strokes = 9;
  t.finger.normal_N = 0.5;
  t.finger.normal_sd_N = 0.0625;
  t.finger.normal_in_window = 0.875;
  t.finger.speed_mm_s = 80.5;
  t.finger.speed_in_window = 0.6875;
  t.finger.mu_low = 0.25;
  t.finger.mu_high = 0.8125;
  t.finger.boundary_felt_mm = 150.5;
  t.finger.boundary_se_mm = 0.375;
  t.finger.lag_mm = 0.625;
  t.finger.tare_mN = -1.5;
  t.finger.mu = 0.625;
  t.follow = {"late lifted", 0.5, 0.5625, 0.59375, 1.75, 0.875, 0.9375, -32.5, 62.5};
  t.signal_rows.push_back(finger_signal(index));
  t.learned.state_hash = 0xfedcba9876543210ULL + static_cast<unsigned>(index);
  for (int i = 0; i < 2; ++i)
    for (int k = 0; k < tones; ++k) t.tones.push_back(tone(i, k));
  return t;
}

inline TrialRow timeout(int index) {
  auto t = answered(index);
  t.outcome = Outcome::timeout;
  t.given.response.reset();
  t.given.correct.reset();
  t.timing.response_time_s.reset();
  t.timing.response_time_quality = "n/a";
  t.given.confidence.reset();
  t.given.confidence_time_s.reset();
  return t;
}

/// A void trial, with what was captured in it.
inline TrialRow failed(int index) {
  auto t = timeout(index);
  t.outcome = Outcome::fault;
  t.given.points.reset();
  t.signal_rows.push_back(raw_signal(index));
  return t;
}

inline BlockStart block(int index = 0, int attempt = 0) { return {index, attempt, "main", "speed", false}; }

/// Makes a finished session of `trials` trials with all events. Returns its id.
inline std::string session(const std::string& database, int trials, const SessionStart& with = start(),
                           SessionStatus status = SessionStatus::completed) {
  auto log = SessionLog::begin(database, with, segment());
  log.begin_block(block());
  for (int i = 0; i < trials; ++i) {
    log.presented(i, 3'000'000'000 + 1'000'000'000LL * i);
    log.event({3'100'000'000 + 1'000'000'000LL * i, "answer", "1", i});
    log.append(i % 5 == 4 ? timeout(i) : answered(i));
  }
  log.finish(status, "");
  return log.session().session_id;
}

inline std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream all;
  all << file.rdbuf();
  return all.str();
}

/// Opens a connection with which a test bypasses the access rules of the store.
inline Database raw(const std::string& path) { return Database(path, Database::Access::read_write); }

/// Returns the kind and message of the error that `action` throws. If it throws nothing, returns
/// ErrorKind::io and "".
template <class Action>
std::pair<ErrorKind, std::string> failure(Action&& action) {
  try {
    action();
  } catch (const StoreError& error) {
    return {error.kind(), error.what()};
  }
  return {ErrorKind::io, ""};
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace sample

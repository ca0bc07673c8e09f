#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "station/limits/exposure.hpp"
#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"
#include "station/session/devices.hpp"
#include "station/session/inputs.hpp"
#include "station/session/monitor.hpp"
#include "station/session/page.hpp"
#include "station/store/session_log.hpp"

namespace turnpoint::session {

/// Where an interrupted session continues. Completed trials stay in the log in any case.
enum class ResumeAt { next_trial, block_start, session_start };

/// Everything needed to run a session, loaded and checked.
struct Setup {
  rig::Rig rig;
  protocol::Protocol protocol;
  std::string participant;
  std::string database;
  terms::RunMode run_mode = terms::RunMode::pilot;
  std::string language;
  /// how the simulated observer is described: "sim" or "sim:threshold=..."; "" for a person
  std::string observer;
  std::optional<std::uint64_t> seed;
  std::string resume_session;  ///< the session to continue; "" begins a new one
  ResumeAt resume_at = ResumeAt::next_trial;
  /// The current calibration, already applied to `rig`: the SHA-256 of its file, and the file's text; "" if
  /// there is none.
  std::string calibration_id, calibration_text;
  std::vector<limits::SoundLevel> sound;  ///< measured levels at full scale, in order of frequency
  /// version of the consent form that the participant signed; "" if none was required
  std::string consent_version;
  /// The touch panel's own latency, stored with each answer by touch, never subtracted.
  double response_offset_s = 0;
  /// Source of the time stamps for which response_offset_s was measured (kernel | toolkit). Answers with
  /// another source do not get the offset; "" means that all do.
  std::string response_offset_quality;
};

/// The result of a run, for people and for --json.
struct Summary {
  std::string session_id, participant, protocol_id, database, run_mode;
  records::SessionStatus status = records::SessionStatus::running;
  std::string reason;
  std::uint64_t seed = 0;
  int blocks = 0, trials = 0, answered = 0, timeouts = 0, anticipations = 0, voided = 0;
  std::optional<double> accuracy;  ///< proportion correct of scored, answered, experimental trials
  double duration_s = 0;           ///< duration on the session's clock
  int xruns = 0;
  /// how much pauses between trials were extended to keep the limit on the duty cycle
  double stretched_s = 0;
  std::string realtime_rights;  ///< what the operating system granted to the audio thread
  std::string checksum;         ///< last link of the chain over the session's rows (`turnpoint verify`)
  std::vector<trial::ProcedureEstimate> estimates;
};

/// Runs a session to its end on the calling thread, with the real clock, pages on `display` and input from
/// `inputs`. If the amplifier is real or the session is live, nothing is presented before an operator has
/// pushed InputKind::arm, and again after each fault of the amplifier. With an observer in the setup it runs
/// on the virtual clock and uses no hardware; of `inputs` only a stop is honoured, and only between trials;
/// `display` may be null. `monitor` may be null. Throws text::BadInput for a setup that cannot run,
/// store::StoreError, and std::system_error for devices.
Summary run(const Setup& setup, Display* display, Inputs& inputs, Monitor* monitor = nullptr);

/// Runs a session with devices that are already open (for a real session only).
Summary run(const Setup& setup, Display* display, Inputs& inputs, Devices devices,
            Monitor* monitor = nullptr);

}  // namespace turnpoint::session

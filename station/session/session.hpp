#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"
#include "station/session/devices.hpp"
#include "station/session/exposure.hpp"
#include "station/session/inputs.hpp"
#include "station/session/monitor.hpp"
#include "station/session/page.hpp"
#include "station/store/session_log.hpp"

namespace turnpoint::session {

/// Where an interrupted session continues. In all cases the completed trials stay in the log.
enum class ResumeAt { next_trial, block_start, session_start };

/// Everything needed to run a session, loaded and checked.
struct Setup {
  rig::Rig rig;
  protocol::Protocol protocol;
  std::string participant;
  std::string database;
  core::RunMode run_mode = core::RunMode::pilot;
  std::string language;
  /// the text that describes the simulated observer: "sim" or "sim:threshold=..."; "" for a person
  std::string observer;
  std::optional<std::uint64_t> seed;
  std::string resume_session;  ///< id of the session to continue; "" begins a new session
  ResumeAt resume_at = ResumeAt::next_trial;
  /// The current calibration, which is already applied to `rig`: the SHA-256 of its file, and the file's
  /// text. Both are "" if there is no calibration.
  std::string calibration_id, calibration_text;
  /// measured sound levels of tones at full scale, in order of frequency
  std::vector<SoundLevel> sound;
  /// version of the consent form that the participant signed; "" if the study needs none
  std::string consent_version;
  /// The latency of the touch panel. It is stored with each answer that was given by touch, but never
  /// subtracted.
  double response_offset_s = 0;
  /// The source of time stamps (kernel | toolkit) for which response_offset_s was measured. Answers with time
  /// stamps from another source are stored without the offset. "" means that all answers by touch get it.
  std::string response_offset_quality;
  /// The delay from a touch to the light on the screen; empty if it was not measured. It is stored in a
  /// session with flashes, but never subtracted.
  std::optional<double> display_latency_s = {};
  /// what is known about room, surface and finger; stored with the session
  core::Conditions conditions = {};
  /// run the self-test before the first block; in a session with a person, it runs after the operator has
  /// armed the amplifier
  bool self_test = false;
  /// the operator's reason to continue if a check of the self-test fails; with "", the operator is asked
  std::string despite = {};
  /// the planned session to run; empty: the participant's next one
  std::optional<int> planned_session = {};
  /// the operator's reason to begin before the protocol's minimum number of days has passed; "" if there is
  /// none
  std::string early = {};
  /// where the kernel lists its temperature sensors
  std::string thermometers = "/sys/class/hwmon";
};

/// The result of a run, for people and for --json.
struct Summary {
  std::string session_id, participant, protocol_id, database, run_mode;
  core::SessionStatus status = core::SessionStatus::running;
  std::string reason;
  std::uint64_t seed = 0;
  int blocks = 0, trials = 0, answered = 0, timeouts = 0, anticipations = 0, voided = 0;
  std::optional<double> accuracy;  ///< proportion correct of scored, answered, experimental trials
  std::optional<double> points;    ///< the participant's score; empty if the protocol gives no points
  double duration_s = 0;           ///< duration of the session on its own clock
  int xruns = 0;
  /// number of trigger codes that were sent; of codes that were sent but not found in the captured signal;
  /// and of codes that were found but not sent
  int triggers = 0, triggers_missed = 0, triggers_extra = 0;
  /// time by which pauses between trials were extended to keep the limits on exposure
  double stretched_s = 0;
  std::string realtime_rights;  ///< rights that the operating system granted to the audio thread
  /// last link of the checksum chain over the session's rows (`turnpoint verify`)
  std::string checksum;
  std::vector<trial::ProcedureEstimate> estimates;
  std::vector<core::Phrase> early_ends;  ///< see Director::early_ends()
};

/// Runs a session to its end on the calling thread, with the real clock, pages on `display` and input from
/// `inputs`. If the amplifier is real or the session is live, the surface stays silent until an operator has
/// pushed input::Arm; the same holds after each fault of the amplifier. `monitor` may be null.
///
/// If the setup has an observer, the session runs on the virtual clock and uses no hardware. The only input
/// with an effect is a request to stop, and it is read only between trials. `display` may then be null.
///
/// Throws core::BadInput for a setup that cannot run, store::StoreError, and std::system_error for devices.
Summary run(const Setup& setup, Display* display, Inputs& inputs, Monitor* monitor = nullptr);

class SimulatedRoom;

/// Runs a simulated session with this simulated room, to which a test may have given faults. A null room
/// means that nothing is captured.
Summary run(const Setup& setup, Display* display, Inputs& inputs, std::unique_ptr<SimulatedRoom> room,
            Monitor* monitor = nullptr);

/// Runs a real session with devices that are already open.
Summary run(const Setup& setup, Display* display, Inputs& inputs, Devices devices,
            Monitor* monitor = nullptr);

}  // namespace turnpoint::session

#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "station/core/check.hpp"
#include "station/core/proof.hpp"
#include "station/core/trial.hpp"

namespace turnpoint::core {

enum class SessionStatus { running, completed, interrupted, stopped, abandoned };
/// The reason stored for a session whose process died. It is written when the database is next opened. Do not
/// change the text: old databases contain it, and the checksums compare with it.
inline constexpr const char* kLostReason = "the process ended without a word";
inline constexpr const char* kAbandonedReason = "no trial was made";
/// The reasons stored for a session that somebody stopped, and for one that stopped itself. After the latter,
/// kVoidsLast and a fault may follow.
inline constexpr const char* kStoppedReason = "stopped by the participant or the operator";
inline constexpr const char* kVoidsReason = "three trials in a row were void";
inline constexpr const char* kVoidsLast = "; the last: ";

const char* name(SessionStatus status);

/// The value of a factor in a trial: a number or a word.
using FactorValue = std::variant<double, std::string>;

/// What is known about room, surface and finger before a session. Empty members were not stated.
struct Conditions {
  std::optional<double> humidity_percent;    ///< relative humidity of the room
  std::optional<double> room_temperature_C;  ///< temperature of the room
  std::optional<bool> surface_cleaned;       ///< whether the surface was cleaned just before the session
  /// hand and finger on the surface, such as "right-index" (core::fingers); "" if not stated
  std::string finger;
  /// moisture of the fingertip, as read on a meter, in the meter's unit
  std::optional<double> skin_moisture;
};

/// How new participants get their places in the counterbalancing if those who drop out are replaced
/// (store/places.hpp). It follows from the protocol.
struct Assignment {
  double dropout_after_h = 0;  ///< how long after the last session a participant is still expected
  /// number of different places: those whose difference is a multiple of it have the same group and orders
  int rows = 1;
  int sessions = 1;               ///< number of planned sessions, after which a participant has completed
  bool incomplete_count = false;  ///< whether a session that has trials but was not completed counts as done
};

/// Where the data of a session come from: everything that is needed to run the session again or to explain it
/// later.
struct SessionStart {
  std::string participant;
  RunMode run_mode = RunMode::live;
  std::string protocol_id, protocol_version, protocol_path, protocol_text, protocol_sha256,
      protocol_canonical;
  std::vector<std::string> factor_columns;  ///< names of the protocol's factors, in the order of the file
  std::string level_unit;
  std::string rig_name, rig_path, rig_text, rig_sha256;
  std::optional<std::string> calibration_id;  ///< SHA-256 of the calibration file; absent on a simulated rig
  /// text of the calibration file, stored once per file; "" if there is none
  std::string calibration_text;
  std::uint64_t seed = 0;
  std::string language, observer;  ///< observer: "" or the argument of `--observer`
  std::string software_version, columns_version, kernel, station_id, realtime_rights;
  std::string started_local;  ///< local time at which the session started (ISO 8601 with time zone)
  std::string consent_version;
  Conditions conditions = {};
  std::optional<int> planned_session =
      {};  ///< number of the planned session, from 1; empty if the protocol plans no sessions
  /// The group of the participant; "" if there are no groups. The store takes it from `groups` when the
  /// participant's place is known: a participant at place p belongs to group number p modulo their count.
  std::string group = {};
  std::vector<std::string> groups = {};  ///< names of all groups; not stored
  /// empty if the lowest place that nobody has had goes to the next participant; not stored
  std::optional<Assignment> assignment = {};
};

/// One process run of a session, with readings of the clocks at its start. Each resume opens another segment.
struct SegmentStart {
  std::string boot_id, reason;  ///< reason for starting this run: "start", "resume" or "fault"
  std::int64_t monotonic_ns = 0, boottime_ns = 0, realtime_ns = 0;
  std::string machine = {};  ///< identity of the machine (store/station.hpp); "" if it is not known
};

/// One check of the self-test: what was measured, and how it was judged.
struct CheckRow {
  std::string name;  ///< name of the check, such as "gate" or "tone main"
  Verdict verdict = Verdict::passed;
  std::optional<double> value,
      limit;         ///< measured value and its limit; empty if the check measures no number
  std::string unit;  ///< unit of value and limit; "" if there is no number
  std::string what;  ///< what was found, as a sentence for the operator
};

/// The answer to one item of a questionnaire, to a consent form (item "consent"), or the result of a
/// screening (item "screening").
struct AnswerRow {
  std::string questionnaire, item;
  int occasion = 0;            ///< number of blocks before the questionnaire; tells repeated uses of it apart
  std::string answer;          ///< id of the chosen answer, or the number that was given
  double response_time_s = 0;  ///< time from the appearance of the question to the answer
  bool operator==(const AnswerRow&) const = default;
};

/// Measured friction at one displacement, relative to the surface at rest (sensing/friction_table.hpp).
struct FrictionLevelRow {
  /// planned displacement without a finger, rms over the measured part of the surface
  double displacement_um = 0;
  std::int64_t trials = 0;  ///< number of trials that count for this displacement
  double measured = 1;      ///< relative friction: geometric mean of the trials
  /// relative friction after the monotone regression, and its standard error
  double relative_friction = 1, sd = 0;
  double low = 0, high = 1;  ///< 95 % interval of relative_friction
};

/// A separate program that took part in a session, whenever it was started.
struct ProgramRow {
  std::string role;              ///< "procedure" or "observer"
  std::string procedure;         ///< name of the procedure; "" for an observer
  std::string program, version;  ///< as the program says itself
  std::string path, sha256;      ///< of the file that was started
  bool operator==(const ProgramRow&) const = default;
};

/// An estimate that the program of a procedure gave at the end of a block.
struct EstimateRow {
  int block_index = 0, attempt = 0;  ///< of the block
  std::string procedure, parameter;
  double mean = 0;
  std::optional<double> sd;
  std::string basis;  ///< the data from which the program computed it, in words; may be ""
};

struct BlockStart {
  int block_index = 0;  ///< number of the block, from 0, in the order in which blocks are run
  int attempt = 0;      ///< number of earlier attempts at this block
  std::string name, instruction;
  bool practice = false;
};

/// One tone of one interval, as it was driven.
struct ToneRow {
  /// number of the interval, from 0, in the order of presentation; the parts of an interval of several parts
  /// count one by one
  int interval_index = 0;
  int scene_index = 0;  ///< from 0, position of the tone's scene in the interval
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
  /// amplitude at the pick-up relative to the plan, and its phase relative to the calibration; empty if the
  /// tone was not measured
  std::optional<double> measured_dB, measured_phase_deg;
  /// standard deviation of the level that the rig's parameters cause; empty if the rig does not say theirs
  std::optional<double> level_uncertainty_dB;
  /// the interval of the task to which the interval belongs, from 0; differs from interval_index if an
  /// interval of the task has several parts, or is presented again; -1 before the first interval
  int of_interval = 0;
};

/// The channels of a signal: one number per channel and point.
struct SignalChannel {
  std::string name;
  std::string unit;
  double resolution = 0;  ///< stored values are whole multiples of this resolution
  bool operator==(const SignalChannel&) const = default;
};

/// A binary value. It is stored as it is, and not exported.
struct Bytes {
  std::string bytes;
  bool operator==(const Bytes&) const = default;
};

/// The stream with all captured channels of a void trial, sample by sample.
inline constexpr const char* kRawStream = "raw";

/// The stream with the updates of a scene that follows the finger, and the one with the gains that they gave:
/// the envelope of the drive as it was commanded, of which a point is the gain at its frame.
inline constexpr const char* kFollowStream = "follow";
inline constexpr const char* kEnvelopeStream = "envelope";

/// What a sensor recorded during one trial: points at a fixed rate, compressed
/// (station/store/signal_code.hpp).
struct SignalRow {
  /// what recorded the signal: "finger" (the force cells), kFollowStream, kEnvelopeStream or kRawStream
  std::string stream;
  std::int64_t start_frame = 0;  ///< playback frame of the first point
  double start_s = 0;            ///< time of the first point from the start of the program run (segment)
  double rate_Hz = 0;            ///< points of the signal per second
  std::int64_t points = 0;
  std::vector<SignalChannel> channels;
  std::string encoding;
  Bytes data;
};

/// What force sensors say about the finger in one trial (station/sensing/trial_finger.hpp). `sensing` is ""
/// if the rig has no force sensors; otherwise "ok", or why the forces are not known. A value that could not
/// be measured is empty.
struct FingerRow {
  std::string sensing;
  std::optional<double> contact_s;
  std::optional<std::int64_t> strokes;
  std::optional<double> normal_N, normal_sd_N, normal_in_window, speed_mm_s, speed_in_window;
  std::optional<double> mu_low, mu_high, boundary_felt_mm, boundary_se_mm, lag_mm, tare_mN;
  /// Coefficient of friction over all strokes of the last interval. In trials that measure a friction table,
  /// only the part of the surface that the table describes counts.
  std::optional<double> mu;
};

/// What the last scene of a trial presented, as it was planned.
struct PresentedRow {
  std::optional<double> boundary_mm, frequency_Hz, amplitude;
  int xruns = 0;
};

/// What the participant answered.
struct ResponseRow {
  std::optional<std::string> response;
  std::optional<bool> correct;
  /// how sure the participant was, from 1 (guessed) up; only if the task asks for it
  std::optional<int> confidence;
  std::optional<double> confidence_time_s;  ///< time from the answer to the statement of confidence
  /// what the result was worth to the participant; empty without points in the protocol, and for void trials
  std::optional<double> points;
  int extra_touches = 0;
  /// how often the intervals were presented again because the participant asked for it; empty where nobody
  /// can
  std::optional<int> again = {};
};

/// When a trial happened, and how its times were measured.
struct TimingRow {
  /// time of response_zero, from which response times count, on CLOCK_MONOTONIC or in virtual time
  std::int64_t onset_ns = 0;
  double onset_s = 0;  ///< time of response_zero from the start of the program run (segment)
  double duration_s = 0;
  std::optional<double> response_time_s, decision_time_s, movement_time_s;
  /// response_time_quality: "kernel", "toolkit" or "simulated", by the origin of the time stamp
  std::string response_zero, response_time_quality;
  double response_offset_s = 0;
  std::optional<double> deadline_s;
  /// slope and residual of the line that is fitted to times over frames (audio/frame_clock.hpp)
  std::optional<double> clock_slope_ns_per_frame, clock_residual_ns;
};

/// What the procedures of the block know after a trial.
struct LearnedRow {
  std::optional<double> threshold_est, threshold_sd;
  std::uint64_t state_hash = 0;  ///< hash of the state of the block's procedures
};

/// What pick-ups say about the stimuli of a trial.
struct SurfaceRow {
  /// The verdict on the stimuli of the trial; of several intervals, the worst verdict counts.
  Proof proof = Proof::unproven;
  ProofCause proof_cause = ProofCause::none;
  /// measured amplitude divided by planned amplitude; of several values, the one furthest from 0 dB
  std::optional<double> drive_ratio_dB;
  /// the part of the measured vibration that was not planned, relative to the planned vibration
  std::optional<double> drive_residual_dB;
  std::optional<double> onset_error_us;  ///< measured minus planned onset of the vibration
  /// What the pick-up captured in the silence before the first stimulus, relative to the planned vibration:
  /// everything (rms), and the strongest tone; the latter is empty if no tone stands out of the noise.
  std::optional<double> silence_dB, silence_tone_dB;
};

/// What a scene that follows the finger presented in the interval presented last (station/follow/record.hpp).
/// `followed` is "" if no scene of the trial follows the finger; otherwise "ok", or the names of the faults
/// of all intervals that have interrupted following, with spaces between them. A value that could not be
/// measured is empty.
struct FollowRow {
  std::string followed;
  std::optional<double> mu_asked, mu_commanded, mu_felt;  ///< means of the coefficient of friction
  std::optional<double> lag_ms;                           ///< of felt behind asked friction
  std::optional<double> inside;  ///< share of that time in which felt friction is within 10 % of the asked
  std::optional<double> share;   ///< share of the interval in which the surface followed the finger
  /// measured minus commanded envelope at the pick-up, relative to the commanded (rms), and its lag; of
  /// several intervals, the worst
  std::optional<double> envelope_error_dB, envelope_lag_us;
};

/// The result of one trial. It is committed as a whole before the next trial begins.
struct TrialRow {
  int segment_index = 1;   ///< number of the program run, from 1; set by the session log, not by the caller
  int trial_index = 0;     ///< number of the trial within the session, from 0; every presented trial counts
  int trial_in_block = 0;  ///< number of the trial within its block; part of the key of its random draws
  TrialType type = TrialType::experimental;
  std::string procedure;
  std::optional<double> level;
  std::map<std::string, FactorValue> factors;
  std::optional<std::string> correct_response;
  Outcome outcome = Outcome::answered;
  PresentedRow presented;
  ResponseRow given;
  TimingRow timing;
  LearnedRow learned;
  SurfaceRow surface;
  FingerRow finger;
  std::vector<ToneRow> tones;
  std::vector<SignalRow> signal_rows;  ///< signals of the trial; written, but not read back with the trial
  FollowRow follow;
};

/// A block of a stored session with its finished trials, in the order in which they were run.
struct BlockRecord {
  BlockStart start;
  std::vector<TrialRow> trials;
};

/// An event with a time stamp: a touch, a button edge, an xrun, a presentation, a fault, ...
struct EventRow {
  std::int64_t time_ns = 0;
  std::string kind;
  std::string value;
  std::optional<int> trial_index;
  int segment_index = 1;                ///< number of the program run, from 1; set by the session log
  std::vector<CheckRow> checks = {};    ///< the checks of a self-test, for an event of the kind self_test
  std::vector<AnswerRow> answers = {};  ///< the answer, for an event of the kind questionnaire
  /// The levels of a friction table, for an event of the kind friction_table.
  std::vector<FrictionLevelRow> friction_levels = {};
  std::vector<ProgramRow> programs =
      {};  ///< the programs that were started, for an event of the kind program
  std::vector<EstimateRow> estimates = {};  ///< for an event of the kind estimates
};

/// Kinds of events that belong to separate programs.
inline constexpr const char* kProgramEvent = "program";
inline constexpr const char* kEstimatesEvent = "estimates";
/// An event that says how a procedure ended whose stopping rules were not met.
inline constexpr const char* kEndedEarlyEvent = "ended_early";

/// Kinds of events of a flash (a response signal): when its frame was handed to the screen, and how many
/// seconds after the flash was due. The second kind is for flashes that were too late (core::kSignalLate_s).
inline constexpr const char* kSignalShownEvent = "signal_shown";
inline constexpr const char* kSignalLateEvent = "signal_late";
/// The delay in seconds from a touch to the light on the screen, as measured with a photodiode.
inline constexpr const char* kDisplayLatencyEvent = "display_latency";

/// Kinds of events around the trials: an answer; the withdrawal of an answer by the Back button, whose value
/// names questionnaire and occasion; and the end of a questionnaire, consent, explanation or screening.
inline constexpr const char* kAnswerEvent = "questionnaire";
inline constexpr const char* kBackEvent = "questionnaire_back";
inline constexpr const char* kDoneEvent = "around_done";
/// Returns the value of events of the kinds kBackEvent and kDoneEvent. It names one use of an interlude by
/// the interlude's name and `occasion`, the number of blocks before it.
std::string place_name(const std::string& name, int occasion);

/// Returns the valid answers of a session, with their events; answers that the participant withdrew with the
/// Back button are left out. The pointers point into `events`, which must be in the order of the log.
std::vector<const EventRow*> standing_answers(const std::vector<EventRow>& events);

}  // namespace turnpoint::core

#include "station/store/fields.hpp"

#include <nlohmann/json.hpp>

namespace turnpoint::store {

namespace {

void parse(const std::string& word, RunMode& mode) { mode = run_mode_named(word); }
void parse(const std::string& word, SessionStatus& status) { status = session_status_named(word); }
void parse(const std::string& word, Outcome& outcome) { outcome = trial_outcome_named(word); }
void parse(const std::string& word, TrialType& type) { type = trial_type_named(word); }
void parse(const std::string& word, Proof& proof) { proof = proof_named(word); }
void parse(const std::string& word, ProofCause& cause) { cause = proof_cause_named(word); }

template <class Value>
struct Optional : std::false_type {};
template <class Value>
struct Optional<std::optional<Value>> : std::true_type {};

/// Returns the SQLite type in which a C++ type is stored.
template <class Value>
constexpr const char* sql_type() {
  if constexpr (Optional<Value>::value)
    return sql_type<typename Value::value_type>();
  else if constexpr (std::is_integral_v<Value>)
    return "INTEGER";
  else if constexpr (std::is_floating_point_v<Value>)
    return "REAL";
  else
    return "TEXT";
}

template <class Value>
void bind(Statement& statement, int index, const Value& value) {
  if constexpr (Optional<Value>::value) {
    if (value)
      bind(statement, index, *value);
    else
      statement.bind_value(index, std::nullopt);
  } else if constexpr (std::is_same_v<Value, std::uint64_t>) {
    statement.bind_value(index, std::bit_cast<std::int64_t>(value));
  } else if constexpr (std::is_enum_v<Value>) {
    statement.bind_value(index, std::string(name(value)));
  } else if constexpr (std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string>) {
    statement.bind_value(index, value);
  } else {
    statement.bind_value(index, to_json(value));
  }
}

template <class Value>
void read(const Statement& row, int column, Value& value) {
  if constexpr (Optional<Value>::value) {
    value.reset();
    if (!row.is_null(column)) read(row, column, value.emplace());
  } else if constexpr (std::is_same_v<Value, bool>) {
    value = row.integer(column) != 0;
  } else if constexpr (std::is_same_v<Value, std::uint64_t>) {
    value = std::bit_cast<std::uint64_t>(row.integer(column));
  } else if constexpr (std::is_integral_v<Value>) {
    value = static_cast<Value>(row.integer(column));
  } else if constexpr (std::is_floating_point_v<Value>) {
    value = row.real(column);
  } else if constexpr (std::is_enum_v<Value>) {
    parse(row.text(column), value);
  } else if constexpr (std::is_same_v<Value, std::string>) {
    value = row.text(column);
  } else {
    from_json(row.text(column), value);
  }
}

template <class Value>
Cell cell_of(const Value& value) {
  if constexpr (Optional<Value>::value)
    return value ? cell_of(*value) : Cell{};
  else if constexpr (std::is_same_v<Value, std::uint64_t>)
    // The number uses all 64 bits. SQLite stores a large one as a negative number, so print it as unsigned.
    return cell(std::to_string(value));
  else if constexpr (std::is_integral_v<Value>)
    return cell(static_cast<std::int64_t>(value));
  else if constexpr (std::is_enum_v<Value>)
    return cell(std::string(name(value)));
  else if constexpr (std::is_floating_point_v<Value> || std::is_same_v<Value, std::string>)
    return cell(value);
  else
    return cell(to_json(value));
}

template <class Member>
struct MemberOf;
template <class Class, class Value>
struct MemberOf<Value Class::*> {
  using Record = Class;
};

/// Applies pointers to members one after another: member<&A::b, &B::c>(a) is a.b.c.
template <auto First, auto... Rest, class Record>
auto& member(Record& record) {
  if constexpr (sizeof...(Rest) == 0)
    return record.*First;
  else
    return member<Rest...>(record.*First);
}

/// The names and texts of a column. field() derives the type and the functions of the column from the pointer
/// to the data member.
struct About {
  const char* name;
  const char* csv = "";
  const char* description = "";
  const char* unit = "";
  const char* values = "";
};

template <auto First, auto... Rest>
Field<typename MemberOf<decltype(First)>::Record> field(const About& about) {
  using Record = typename MemberOf<decltype(First)>::Record;
  using Value = std::remove_reference_t<decltype(member<First, Rest...>(std::declval<Record&>()))>;
  return {about.name,
          about.csv,
          about.description,
          about.unit,
          about.values,
          sql_type<Value>(),
          Optional<Value>::value,
          [](Statement& s, int i, const Record& r) { bind(s, i, member<First, Rest...>(r)); },
          [](const Statement& s, int i, Record& r) { read(s, i, member<First, Rest...>(r)); },
          [](const Record& r) { return cell_of(member<First, Rest...>(r)); }};
}

/// Marks a column that the checksum covers since this version of its rule (kEncoding in checksum.hpp).
template <class Record>
Field<Record> since(int encoding, Field<Record> field) {
  field.since = encoding;
  return field;
}

/// Describes the database column that stores one data member of SessionRecord::start.
template <auto Member>
Field<SessionRecord> start(const About& about) {
  return field<&SessionRecord::start, Member>(about);
}

/// This column is NULL if there is no response time: then no clock was read.
Field<TrialRow> response_time_quality() {
  auto quality = field<&TrialRow::response_time_quality>({"response_time_quality", "response_time_quality",
                                                          "Clock that gave the time stamp of the answer", "",
                                                          "kernel | toolkit | simulated | n/a"});
  quality.nullable = true;
  quality.bind = [](Statement& s, int i, const TrialRow& row) {
    const auto& word = row.response_time_quality;
    if (!row.response_time_s || word.empty() || word == "n/a")
      s.bind_value(i, std::nullopt);
    else
      s.bind_value(i, word);
  };
  return quality;
}

}  // namespace

const Table<SegmentStart>& segment_table() {
  static const Table<SegmentStart> table{
      "segment",
      {"session_id", "segment_index"},
      {field<&SegmentStart::boot_id>({"boot_id"}), field<&SegmentStart::reason>({"reason"}),
       field<&SegmentStart::monotonic_ns>({"monotonic_ns"}),
       field<&SegmentStart::boottime_ns>({"boottime_ns"}),
       field<&SegmentStart::realtime_ns>({"realtime_ns"})}};
  return table;
}

const Table<BlockStart>& block_table() {
  using B = BlockStart;
  static const Table<B> table{
      "block",
      {"session_id", "run_order"},
      {field<&B::block_index>({"block_index", "block_index",
                               "Number of the block, from 0, in the order in which blocks are run"}),
       field<&B::attempt>({"attempt", "attempt",
                           "Number of earlier attempts at this block (rows of earlier attempts are kept)"}),
       field<&B::name>({"name", "block_name", "Name of the block"}),
       field<&B::instruction>({"instruction", "instruction",
                               "Name of the instruction that applies to the block", "",
                               "speed | accuracy | ... | n/a"}),
       field<&B::practice>({"practice", "practice", "1 in a practice block, otherwise 0", "", "0 | 1"})}};
  return table;
}

const Table<TrialRow>& trial_table() {
  using T = TrialRow;
  static const Table<T> table{
      "trial",
      {"session_id", "block_index", "attempt", "recorded_realtime_ns"},
      {field<&T::segment_index>({"segment_index", "segment_id",
                                 "Run of the program within the session, from 1; each time the session is "
                                 "resumed, another run begins"}),
       field<&T::trial_index>({"trial_index", "trial_index",
                               "Index of the trial among all trials presented in the session, from 0"}),
       field<&T::trial_in_block>({"trial_in_block"}),
       field<&T::type>({"trial_type", "trial_type",
                        "Type of the trial; only experimental trials are used by procedures and fits", "",
                        "experimental | catch | practice | warmup"}),
       field<&T::procedure>(
           {"procedure", "procedure", "Procedure that chose the level; n/a if no procedure did"}),
       field<&T::level>({"level", "level", "Stimulus level that was presented", "see level_unit"}),
       field<&T::factors>({"factors"}),
       field<&T::boundary_mm>(
           {"boundary_mm", "boundary_mm",
            "Position of the boundary presented last in the trial, measured from the wide end of the surface",
            "mm"}),
       field<&T::frequency_Hz>({"frequency_Hz", "frequency_hz",
                                "Frequency of the first tone of the scene presented last in the trial",
                                "Hz"}),
       field<&T::amplitude>(
           {"amplitude", "amplitude",
            "Predicted displacement, at its last maximum, of the scene presented last in the trial", "um"}),
       field<&T::correct_response>(
           {"correct_response", "correct_response", "Correct choice; n/a if no choice is correct"}),
       field<&T::response>(
           {"response", "response",
            "Choice of the participant; in an adjustment task the setting, in the unit of the level"}),
       field<&T::correct>({"correct", "correct",
                           "1 if the choice was correct, 0 if not; n/a if the answer is not scored", "",
                           "0 | 1 | n/a"}),
       field<&T::outcome>(
           {"outcome", "outcome",
            "How the trial ended; only answered trials have a response, a score and a response time", "",
            "answered | timeout | anticipation | aborted | fault"}),
       field<&T::onset_ns>({"onset_ns"}),
       field<&T::onset_s>({"onset_s", "response_zero_onset",
                           "Time from which the response time counts, measured from the start of the segment",
                           "s"}),
       field<&T::duration_s>({"duration_s", "trial_duration", "Duration of the whole trial", "s"}),
       field<&T::response_time_s>({"response_time_s", "response_time",
                                   "Time from response_zero to the answer, without corrections", "s"}),
       field<&T::decision_time_s>({"decision_time_s", "decision_time",
                                   "Time from response_zero to the moment when the finger leaves the surface",
                                   "s"}),
       field<&T::movement_time_s>({"movement_time_s", "movement_time",
                                   "Time from when the finger leaves the surface to the answer", "s"}),
       field<&T::response_zero>({"response_zero", "response_zero",
                                 "Event from which response times are measured", "",
                                 "go_cue | change | interval_off | first_contact | lift_off"}),
       response_time_quality(),
       field<&T::response_offset_s>(
           {"response_offset_s", "response_offset_s",
            "Latency measured by the calibration; it is not subtracted from response_time", "s"}),
       field<&T::deadline_s>({"deadline_s", "deadline",
                              "Longest time allowed for the answer, measured from response_zero", "s"}),
       field<&T::xruns>({"xruns", "xruns", "Number of interruptions of the drive signal during the trial"}),
       field<&T::extra_touches>(
           {"extra_touches", "extra_touches", "Number of touches and button presses that were not answers"}),
       field<&T::threshold_est>({"threshold_est", "threshold_est",
                                 "Threshold estimated by the trial's procedure after this trial",
                                 "see level_unit"}),
       field<&T::threshold_sd>(
           {"threshold_sd", "threshold_sd", "Standard deviation of threshold_est", "see level_unit"}),
       field<&T::clock_slope_ns_per_frame>({"clock_slope_ns_per_frame"}),
       field<&T::clock_residual_ns>({"clock_residual_ns"}),
       field<&T::state_hash>({"state_hash"}),
       since(2, field<&T::proof>({"proof", "proof",
                                  "What the pick-up on the surface says about the trial's stimuli", "",
                                  "unproven | ok | flagged | refused | stopped | lost"})),
       since(2, field<&T::proof_cause>({"proof_cause", "proof_cause",
                                        "Why the stimuli are not proven to be as planned", "",
                                        "gap | clipped | dead | frequency | half | late | phase | level | "
                                        "residual | noisy | n/a"})),
       since(2,
             field<&T::drive_ratio_dB>(
                 {"drive_ratio_dB", "drive_ratio_db",
                  "Measured over planned amplitude of the vibration, of the tone that differs most", "dB"})),
       since(2, field<&T::drive_residual_dB>({"drive_residual_dB", "drive_residual_db",
                                              "Vibration that was not planned, relative to the plan", "dB"})),
       since(2, field<&T::onset_error_us>(
                    {"onset_error_us", "onset_error_us",
                     "Measured minus planned onset of the stimulus; of several, the largest", "us"}))}};
  return table;
}

const Table<ToneRow>& tone_table() {
  using T = ToneRow;
  static const Table<T> table{
      "tone",
      {"session_id", "trial_index"},
      {field<&T::interval_index>(
           {"interval_index", "interval_index", "Number of the interval in the order presented, from 0"}),
       field<&T::scene_index>(
           {"scene_index", "scene_index", "Number of the scene within the interval, from 0"}),
       field<&T::tone_index>({"tone_index", "tone_index", "Number of the tone within the scene, from 0"}),
       field<&T::scene>({"scene", "scene", "Name of the scene in the protocol"}),
       field<&T::boundary_mm>({"boundary_mm", "boundary_mm",
                               "Position of the scene's boundary, measured from the wide end of the surface",
                               "mm"}),
       field<&T::frequency_Hz>({"frequency_Hz", "frequency_hz", "Frequency of the tone", "Hz"}),
       field<&T::amplitude_um>({"amplitude_um", "amplitude_um",
                                "Peak displacement of the tone at the driven edge of the surface", "um"}),
       field<&T::displacement_um>(
           {"displacement_um", "displacement_um", "Predicted displacement at the tone's last maximum", "um"}),
       field<&T::friction>(
           {"friction", "friction", "Predicted friction of the scene, relative to the still surface"}),
       field<&T::rove_dB>(
           {"rove_dB", "rove_db", "Random change of level (roving) added to this interval", "dB"}),
       field<&T::model>({"model", "model", "Physical model that planned the tone"}),
       field<&T::error_bound_mm>({"error_bound_mm", "error_bound_mm",
                                  "Bound of the model's error in the position of the boundary", "mm"}),
       field<&T::uncertainty_mm>({"uncertainty_mm", "uncertainty_mm",
                                  "Uncertainty of the boundary's position that the rig's parameters cause",
                                  "mm"}),
       field<&T::reason>({"reason", "reason", "Why this model was chosen"}),
       field<&T::onset_frame>({"onset_frame", "onset_frame",
                               "Output frame at which the tone starts, counted from the start of the segment",
                               "frames"}),
       field<&T::length_frames>(
           {"length_frames", "length_frames", "Length of the tone, including both ramps", "frames"}),
       since(2,
             field<&T::measured_dB>(
                 {"measured_dB", "measured_db",
                  "Amplitude of the tone at the pick-up, relative to the plan; n/a if not measured", "dB"})),
       since(2, field<&T::measured_phase_deg>(
                    {"measured_phase_deg", "measured_phase_deg",
                     "Phase of the tone at the pick-up, relative to the calibration", "deg"}))}};
  return table;
}

const Table<EventRow>& event_table() {
  using E = EventRow;
  static const Table<E> table{
      "event",
      {"session_id", "event_index"},
      {field<&E::segment_index>(
           {"segment_index", "segment_id", "Run of the program within the session, from 1"}),
       field<&E::time_ns>({"time_ns", "time_ns", "Time of the event on the station's monotonic clock", "ns"}),
       field<&E::kind>(
           {"kind", "kind", "What happened: presented, answer, touch, contact, xrun, fault, aborted, ..."}),
       field<&E::value>({"value", "value", "Detail"}),
       field<&E::trial_index>({"trial_index", "trial_index",
                               "Index of the trial among all trials presented in the session, from 0"})}};
  return table;
}

const Table<SessionRecord>& session_table() {
  using R = SessionRecord;
  using S = SessionStart;
  static const Table<R> table{
      "session",
      {"session_id", "protocol_key", "rig_key"},
      {start<&S::participant>(
           {"participant", "participant_code", "Participant code under which the session was run"}),
       start<&S::protocol_path>({"protocol_path", "protocol_path", "Path of the protocol file"}),
       start<&S::rig_path>({"rig_path", "rig_path", "Path of the rig file"}),
       start<&S::calibration_id>({"calibration_id", "calibration_id",
                                  "Hash of the calibration that was used; n/a on a simulated rig"}),
       start<&S::run_mode>({"run_mode", "run_mode", "Kind of session: only live sessions are data of a study",
                            "", "live | pilot | simulated"}),
       field<&R::session_index>(
           {"session_index", "session_index",
            "Number of the session among this participant's sessions with this protocol, from 1"}),
       field<&R::sequence_index>(
           {"sequence_index", "sequence_index", "Participant's place in the counterbalancing, from 0"}),
       start<&S::seed>({"seed", "seed", "Seed of the session's random numbers"}),
       start<&S::language>({"language", "language", "Language shown"}),
       start<&S::observer>({"observer", "observer", "Simulated observer that gave the answers, if any"}),
       start<&S::factor_columns>({"factor_columns"}),
       start<&S::level_unit>({"level_unit", "level_unit", "Unit of the stimulus level"}),
       start<&S::software_version>({"software_version", "software_version", "Version of the program"}),
       start<&S::columns_version>({"columns_version"}),
       start<&S::kernel>({"kernel", "kernel", "Version of the Linux kernel on the station"}),
       start<&S::station_id>({"station_id", "station_id", "Identifier of the station"}),
       start<&S::realtime_rights>({"realtime_rights", "realtime_rights",
                                   "Real-time priorities and memory locks that the kernel granted"}),
       start<&S::started_local>(
           {"started_local", "started", "Start of the session in local time, with time zone", "ISO 8601"}),
       start<&S::consent_version>({"consent_version", "consent_version", "Version of the consent form"}),
       field<&R::status>({"status", "status", "State of the session", "",
                          "running | completed | interrupted | stopped | abandoned"}),
       field<&R::status_reason>({"status_reason", "status_reason", "Why the session has this state"})}};
  return table;
}

const Table<SessionRecord>& protocol_table() {
  using S = SessionStart;
  static const Table<SessionRecord> table{
      "protocol",
      {"protocol_key"},
      {start<&S::protocol_id>({"protocol_id", "protocol_id", "Identifier of the protocol"}),
       start<&S::protocol_version>({"version", "protocol_version", "Version given in the protocol file"}),
       start<&S::protocol_sha256>({"sha256", "protocol_sha256", "Hash of the protocol as it was run"}),
       start<&S::protocol_text>({"text"}), start<&S::protocol_canonical>({"canonical"})}};
  return table;
}

const Table<SessionRecord>& rig_table() {
  using S = SessionStart;
  static const Table<SessionRecord> table{
      "rig",
      {"rig_key"},
      {start<&S::rig_name>({"name", "rig_name", "Name of the rig"}),
       start<&S::rig_sha256>({"sha256", "rig_sha256", "Hash of the rig file"}),
       start<&S::rig_text>({"text"})}};
  return table;
}

const Table<SessionRecord>& calibration_table() {
  static const Table<SessionRecord> table{
      "calibration", {"calibration_id"}, {start<&SessionStart::calibration_text>({"text"})}};
  return table;
}

std::string to_json(const std::map<std::string, FactorValue>& factors) {
  auto object = nlohmann::json::object();
  for (const auto& [key, value] : factors) std::visit([&, &k = key](const auto& v) { object[k] = v; }, value);
  return object.dump();
}

void from_json(const std::string& text, std::map<std::string, FactorValue>& factors) {
  factors.clear();
  const auto object = nlohmann::json::parse(text);
  for (const auto& [key, value] : object.items())
    factors[key] =
        value.is_string() ? FactorValue(value.get<std::string>()) : FactorValue(value.get<double>());
}

std::string to_json(const std::vector<std::string>& list) { return nlohmann::json(list).dump(); }

void from_json(const std::string& text, std::vector<std::string>& list) {
  list = nlohmann::json::parse(text).get<std::vector<std::string>>();
}

}  // namespace turnpoint::store

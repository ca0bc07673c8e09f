#include "station/store/fields.hpp"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>

namespace turnpoint::store {

// How fields.cpp and fields_trial.cpp make a Field from a pointer to a data member.

inline void parse(const std::string& word, RunMode& mode) { mode = run_mode_named(word); }
inline void parse(const std::string& word, SessionStatus& status) { status = session_status_named(word); }
inline void parse(const std::string& word, Outcome& outcome) { outcome = trial_outcome_named(word); }
inline void parse(const std::string& word, TrialType& type) { type = trial_type_named(word); }
inline void parse(const std::string& word, Verdict& verdict) { verdict = verdict_named(word); }
inline void parse(const std::string& word, Proof& proof) { proof = proof_named(word); }
inline void parse(const std::string& word, ProofCause& cause) { cause = proof_cause_named(word); }

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
  else if constexpr (std::is_same_v<Value, Bytes>)
    return "BLOB";
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
  } else if constexpr (std::is_same_v<Value, Bytes>) {
    statement.bind_blob(index, value.bytes);
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
  } else if constexpr (std::is_same_v<Value, Bytes>) {
    value.bytes = row.text(column);
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
  else if constexpr (std::is_same_v<Value, Bytes>)
    return Cell{};
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

namespace {

/// Describes the database column that stores one data member of SessionRecord::start.
template <auto Member>
Field<SessionRecord> start(const About& about) {
  return field<&SessionRecord::start, Member>(about);
}

/// Describes the database column that stores one of a session's conditions, such as the humidity.
template <auto Member>
Field<SessionRecord> condition(const About& about) {
  return field<&SessionRecord::start, &SessionStart::conditions, Member>(about);
}

}  // namespace

const Table<SegmentStart>& segment_table() {
  static const Table<SegmentStart> table{
      "segment",
      {"session_id", "segment_index"},
      {field<&SegmentStart::boot_id>({"boot_id"}), field<&SegmentStart::reason>({"reason"}),
       field<&SegmentStart::monotonic_ns>({"monotonic_ns"}),
       field<&SegmentStart::boottime_ns>({"boottime_ns"}), field<&SegmentStart::realtime_ns>({"realtime_ns"}),
       field<&SegmentStart::machine>({"machine"})}};
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

const Table<CheckRow>& check_table() {
  using C = CheckRow;
  static const Table<C> table{
      "self_test",
      {"session_id", "event_index", "check_index"},
      {field<&C::name>({"name", "check", "What the self-test checked: gate, stop, tone main, disk, ..."}),
       field<&C::verdict>(
           {"verdict", "verdict", "Result of the check", "", "passed | failed | not possible"}),
       field<&C::value>({"value", "value", "Measured value, in the unit of the row"}),
       field<&C::limit>({"limit_value", "limit", "Limit of the value, in the unit of the row"}),
       field<&C::unit>({"unit", "unit", "Unit of value and limit"}),
       field<&C::what>({"what", "what", "What was found"})}};
  return table;
}

const Table<AnswerRow>& answer_table() {
  using A = AnswerRow;
  static const Table<A> table{
      "answer",
      {"session_id", "event_index", "answer_index"},
      {field<&A::questionnaire>({"questionnaire", "questionnaire",
                                 "Name of the questionnaire, consent or screening in the protocol"}),
       field<&A::item>({"item", "item", "Item of the questionnaire; consent | screening"}),
       field<&A::occasion>({"occasion", "occasion",
                            "Number of blocks before the questionnaire; distinguishes repeated uses of the "
                            "same questionnaire"}),
       field<&A::answer>({"answer", "answer",
                          "Id of the chosen answer or, if the question asks for a number, that number"}),
       field<&A::response_time_s>({"response_time_s", "response_time",
                                   "Time from the appearance of the question to the answer", "s"})}};
  return table;
}

const Table<FrictionLevelRow>& friction_level_table() {
  using F = FrictionLevelRow;
  static const Table<F> table{
      "friction_level",
      {"session_id", "event_index", "level_index"},
      {field<&F::displacement_um>({"displacement_um", "displacement_um",
                                   "Displacement without a finger, rms over the measured part of the surface",
                                   "um"}),
       field<&F::trials>({"trials", "trials", "Number of valid trials at this displacement"}),
       field<&F::measured>({"measured", "measured",
                            "Friction relative to the surface at rest, geometric mean of the trials"}),
       field<&F::relative_friction>(
           {"relative_friction", "relative_friction",
            "Relative friction after a monotone regression over the displacements; plans use this value"}),
       field<&F::sd>({"sd", "sd", "Standard error of relative_friction"}),
       field<&F::low>({"low", "low", "Lower end of the 95 % interval of relative_friction"}),
       field<&F::high>({"high", "high", "Upper end of the 95 % interval of relative_friction"})}};
  return table;
}

const Table<ProgramRow>& program_table() {
  using P = ProgramRow;
  static const Table<P> table{
      "program",
      {"session_id", "event_index", "program_index"},
      {field<&P::role>({"role", "role", "What the program did in the session", "", "procedure | observer"}),
       field<&P::procedure>({"procedure", "procedure", "Procedure whose levels the program chose"}),
       field<&P::program>({"name", "program", "Name of the program, as it says itself"}),
       field<&P::version>({"version", "version", "Version of the program, as it says itself"}),
       field<&P::path>({"path", "path", "File that was started"}),
       field<&P::sha256>({"sha256", "sha256", "Hash of the file"})}};
  return table;
}

const Table<EstimateRow>& estimate_table() {
  using E = EstimateRow;
  static const Table<E> table{
      "estimate",
      {"session_id", "event_index", "estimate_index"},
      {field<&E::block_index>({"block_index", "block_index", "Number of the block, from 0"}),
       field<&E::attempt>({"attempt", "attempt", "Number of earlier attempts at this block"}),
       field<&E::procedure>({"procedure", "procedure", "Procedure whose program gave the estimate"}),
       field<&E::parameter>({"parameter", "parameter", "What was estimated: threshold, ..."}),
       field<&E::mean>({"mean", "mean", "Estimate of the program at the end of the block"}),
       field<&E::sd>({"sd", "sd", "Standard deviation of the estimate, as the program gave it"}),
       field<&E::basis>({"basis", "basis", "Data from which the program computed it, in its own words"})}};
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
       condition<&Conditions::humidity_percent>(
           {"humidity_percent", "humidity_percent",
            "Relative humidity of the room, as stated before the session", "%"}),
       condition<&Conditions::room_temperature_C>({"room_temperature_C", "room_temperature_c",
                                                   "Temperature of the room, as stated before the session",
                                                   "degC"}),
       condition<&Conditions::surface_cleaned>({"surface_cleaned", "surface_cleaned",
                                                "1 if the surface was cleaned just before the session", "",
                                                "0 | 1"}),
       condition<&Conditions::finger>({"finger", "finger", "Hand and finger that touched the surface", "",
                                       "left-thumb | ... | right-index | ... | n/a"}),
       condition<&Conditions::skin_moisture>({"skin_moisture", "skin_moisture",
                                              "Moisture of the fingertip, as a moisture meter read it before "
                                              "the session, in the meter's unit"}),
       field<&R::leased_place>({"leased_place"}),
       start<&S::planned_session>(
           {"planned_session", "planned_session",
            "Number of this session in the protocol's plan of sessions, from 1; n/a without a plan"}),
       start<&S::group>({"participant_group", "participant_group",
                         "Group of the participant: a level of the factor that is drawn per participant"}),
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

std::string to_json(const std::vector<SignalChannel>& channels) {
  auto list = nlohmann::json::array();
  for (const auto& channel : channels)
    list.push_back({{"name", channel.name}, {"unit", channel.unit}, {"resolution", channel.resolution}});
  return list.dump();
}

void from_json(const std::string& text, std::vector<SignalChannel>& channels) {
  channels.clear();
  const auto list = nlohmann::json::parse(text);
  for (const auto& channel : list)
    channels.push_back({channel.at("name"), channel.at("unit"), channel.at("resolution")});
}

std::string to_json(const std::vector<std::string>& list) { return nlohmann::json(list).dump(); }

void from_json(const std::string& text, std::vector<std::string>& list) {
  list = nlohmann::json::parse(text).get<std::vector<std::string>>();
}

namespace {

/// This column is NULL if there is no response time, because no clock was read then.
Field<TrialRow> response_time_quality() {
  auto quality = field<&TrialRow::timing, &TimingRow::response_time_quality>(
      {"response_time_quality", "response_time_quality", "Clock that gave the time stamp of the answer", "",
       "kernel | toolkit | simulated | n/a"});
  quality.nullable = true;
  quality.bind = [](Statement& s, int i, const TrialRow& row) {
    const auto& word = row.timing.response_time_quality;
    if (!row.timing.response_time_s || word.empty() || word == "n/a")
      s.bind_value(i, std::nullopt);
    else
      s.bind_value(i, word);
  };
  return quality;
}

}  // namespace

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
       field<&T::presented, &PresentedRow::boundary_mm>(
           {"boundary_mm", "boundary_mm",
            "Position of the boundary presented last in the trial, measured from the wide end of the surface",
            "mm"}),
       field<&T::presented, &PresentedRow::frequency_Hz>(
           {"frequency_Hz", "frequency_hz",
            "Frequency of the first tone of the scene presented last in the trial", "Hz"}),
       field<&T::presented, &PresentedRow::amplitude>(
           {"amplitude", "amplitude",
            "Predicted displacement of the surface at its last maximum, for the scene "
            "presented last in the trial",
            "um"}),
       field<&T::correct_response>(
           {"correct_response", "correct_response", "Correct choice; n/a if no choice is correct"}),
       field<&T::given, &ResponseRow::response>(
           {"response", "response",
            "Choice of the participant; unsure if the participant did not want to guess; in "
            "an adjustment task the setting, in the unit of the level; on a "
            "scale or with a number pad the number that was given"}),
       field<&T::given, &ResponseRow::correct>(
           {"correct", "correct", "1 if the choice was correct, 0 if not; n/a if the answer is not scored",
            "", "0 | 1 | n/a"}),
       field<&T::outcome>(
           {"outcome", "outcome",
            "How the trial ended; only answered trials have a response, a score and a response time", "",
            "answered | timeout | anticipation | aborted | fault"}),
       field<&T::timing, &TimingRow::onset_ns>({"onset_ns"}),
       field<&T::timing, &TimingRow::onset_s>(
           {"onset_s", "response_zero_onset",
            "Time from which the response time counts, measured from the start of the segment", "s"}),
       field<&T::timing, &TimingRow::duration_s>(
           {"duration_s", "trial_duration", "Duration of the whole trial", "s"}),
       field<&T::timing, &TimingRow::response_time_s>(
           {"response_time_s", "response_time", "Time from response_zero to the answer, without corrections",
            "s"}),
       field<&T::timing, &TimingRow::decision_time_s>(
           {"decision_time_s", "decision_time",
            "Time from response_zero to the moment when the finger leaves the surface", "s"}),
       field<&T::timing, &TimingRow::movement_time_s>(
           {"movement_time_s", "movement_time", "Time from when the finger leaves the surface to the answer",
            "s"}),
       field<&T::timing, &TimingRow::response_zero>(
           {"response_zero", "response_zero", "Event from which response times are measured", "",
            "go_cue | change | interval_off | first_contact | lift_off"}),
       response_time_quality(),
       field<&T::timing, &TimingRow::response_offset_s>(
           {"response_offset_s", "response_offset_s",
            "Latency measured by the calibration; it is not subtracted from response_time", "s"}),
       field<&T::timing, &TimingRow::deadline_s>(
           {"deadline_s", "deadline", "Longest time allowed for the answer, measured from response_zero",
            "s"}),
       field<&T::presented, &PresentedRow::xruns>(
           {"xruns", "xruns", "Number of interruptions of the drive signal during the trial"}),
       field<&T::given, &ResponseRow::extra_touches>(
           {"extra_touches", "extra_touches", "Number of touches and button presses that were not answers"}),
       field<&T::learned, &LearnedRow::threshold_est>(
           {"threshold_est", "threshold_est", "Threshold estimated by the trial's procedure after this trial",
            "see level_unit"}),
       field<&T::learned, &LearnedRow::threshold_sd>(
           {"threshold_sd", "threshold_sd", "Standard deviation of threshold_est", "see level_unit"}),
       field<&T::timing, &TimingRow::clock_slope_ns_per_frame>({"clock_slope_ns_per_frame"}),
       field<&T::timing, &TimingRow::clock_residual_ns>({"clock_residual_ns"}),
       field<&T::learned, &LearnedRow::state_hash>({"state_hash"}),
       field<&T::surface, &SurfaceRow::proof>(
           {"proof", "proof", "What the pick-up on the surface says about the trial's stimuli", "",
            "unproven | ok | flagged | refused | stopped | lost"}),
       field<&T::surface, &SurfaceRow::proof_cause>(
           {"proof_cause", "proof_cause", "Why the stimuli are not proven to be as planned", "",
            "gap | clipped | dead | frequency | half | late | phase | level | "
            "residual | noisy | n/a"}),
       field<&T::surface, &SurfaceRow::drive_ratio_dB>(
           {"drive_ratio_dB", "drive_ratio_db",
            "Measured over planned amplitude of the vibration, of the tone that differs most", "dB"}),
       field<&T::surface, &SurfaceRow::drive_residual_dB>(
           {"drive_residual_dB", "drive_residual_db", "Vibration that was not planned, relative to the plan",
            "dB"}),
       field<&T::surface, &SurfaceRow::onset_error_us>(
           {"onset_error_us", "onset_error_us",
            "Measured minus planned onset of the stimulus; of several, the largest", "us"}),
       field<&T::given, &ResponseRow::confidence>(
           {"confidence", "confidence",
            "How sure the participant was of the answer, from 1 (least) up; n/a "
            "if the task does not ask"}),
       field<&T::given, &ResponseRow::confidence_time_s>(
           {"confidence_time_s", "confidence_time",
            "Time from the answer to the participant's statement of confidence", "s"}),
       field<&T::given, &ResponseRow::points>(
           {"points", "points",
            "Points that the result of the trial was worth to the participant; n/a if the "
            "protocol gives none, and for void trials"}),
       field<&T::given, &ResponseRow::again>(
           {"again", "again",
            "How often the intervals were presented again because the participant asked for it; all times of "
            "the trial are those of the last time. n/a if the task does not offer it"}),
       field<&T::finger, &FingerRow::sensing>(
           {"sensing", "sensing",
            "Whether the touch met the requirements of the protocol's [sensing]: ok, or too few "
            "strokes, too light, too hard, too slow, too fast. If that is not known: lost (samples "
            "were lost), wire (fault of a cell's wire), tare (no valid tare); n/a without force sensors",
            "", "ok | strokes | light | hard | slow | fast | lost | wire | tare | n/a"}),
       field<&T::finger, &FingerRow::contact_s>(
           {"contact_s", "contact_s", "Time during which a finger touched the surface", "s"}),
       field<&T::finger, &FingerRow::strokes>({"strokes", "strokes", "Number of strokes along the surface"}),
       field<&T::finger, &FingerRow::normal_N>(
           {"normal_N", "normal_n", "Mean normal force during the strokes", "N"}),
       field<&T::finger, &FingerRow::normal_sd_N>(
           {"normal_sd_N", "normal_sd_n", "Standard deviation of the normal force during the strokes", "N"}),
       field<&T::finger, &FingerRow::normal_in_window>(
           {"normal_in_window", "normal_in_window",
            "Fraction of the strokes' time with a normal force that the protocol asks for"}),
       field<&T::finger, &FingerRow::speed_mm_s>(
           {"speed_mm_s", "speed_mm_s", "Mean speed of the finger during the strokes", "mm/s"}),
       field<&T::finger, &FingerRow::speed_in_window>(
           {"speed_in_window", "speed_in_window",
            "Fraction of the strokes' time with a speed that the protocol asks for"}),
       field<&T::finger, &FingerRow::mu_low>(
           {"mu_low", "mu_low",
            "Measured coefficient of friction on the smooth side of the felt boundary, in the "
            "scene presented last"}),
       field<&T::finger, &FingerRow::mu_high>(
           {"mu_high", "mu_high",
            "Measured coefficient of friction on the rough side of the felt boundary, in the "
            "scene presented last"}),
       field<&T::finger, &FingerRow::boundary_felt_mm>(
           {"boundary_felt_mm", "boundary_felt_mm",
            "Measured position at which friction crosses the planned edge's level "
            "(for other edges: half-way up the step), in the scene presented "
            "last, from the wide end of the surface",
            "mm"}),
       field<&T::finger, &FingerRow::boundary_se_mm>(
           {"boundary_se_mm", "boundary_se_mm", "Standard error of boundary_felt_mm", "mm"}),
       field<&T::finger, &FingerRow::lag_mm>(
           {"lag_mm", "lag_mm",
            "Distance by which the skin lags behind the finger: half the difference between the "
            "positions of the felt step in the two directions of stroking",
            "mm"}),
       field<&T::finger, &FingerRow::tare_mN>(
           {"tare_mN", "tare_mn", "Change of the force sensors' zero since the previous trial", "mN"}),
       field<&T::finger, &FingerRow::mu>(
           {"mu", "mu",
            "Measured coefficient of friction over all strokes during the interval presented last; "
            "in a block that measures a friction table, over its part of the surface"}),
       field<&T::surface, &SurfaceRow::silence_dB>(
           {"silence_dB", "silence_db",
            "Level of the pick-up in the silence before the first stimulus (rms of "
            "the loudest 50 ms), relative to the planned vibration",
            "dB"}),
       field<&T::surface, &SurfaceRow::silence_tone_dB>(
           {"silence_tone_dB", "silence_tone_db",
            "Level of the strongest tone in this silence, relative to the planned vibration; n/a if "
            "no tone stands out of the noise",
            "dB"}),
       field<&T::follow, &FollowRow::followed>(
           {"followed", "followed",
            "Whether the surface followed the finger: ok, or what has interrupted it (late, reference, "
            "force, "
            "lifted, position, saturated; several with spaces between them), or unrecorded; n/a if no scene "
            "of the trial "
            "follows the finger"}),
       field<&T::follow, &FollowRow::mu_asked>(
           {"mu_asked", "mu_asked",
            "Mean coefficient of friction that the scene presented last asks for at the finger, over the "
            "times at which the surface followed it and it slid; n/a if the scene asks for a displacement. "
            "Without resting_friction in the protocol, friction at rest is the one with which mu_commanded "
            "equals mu_felt"}),
       field<&T::follow, &FollowRow::mu_commanded>(
           {"mu_commanded", "mu_commanded",
            "Mean coefficient of friction at these times by the friction table and the commanded envelope"}),
       field<&T::follow, &FollowRow::mu_felt>(
           {"mu_felt", "mu_felt",
            "Mean coefficient of friction at these times as the force cells measured it"}),
       field<&T::follow, &FollowRow::lag_ms>({"follow_lag_ms", "follow_lag_ms",
                                              "Time by which felt friction is behind what was asked for at "
                                              "the finger; n/a if that varied by less "
                                              "than 5 %",
                                              "ms"}),
       field<&T::follow, &FollowRow::inside>({"follow_inside", "follow_inside",
                                              "Fraction of these times at which felt friction differs by "
                                              "less than 10 % from what was asked for"}),
       field<&T::follow, &FollowRow::share>(
           {"follow_share", "follow_share",
            "Fraction of the interval presented last in which the surface followed the finger"}),
       field<&T::follow, &FollowRow::envelope_error_dB>({"envelope_error_dB", "envelope_error_db",
                                                         "Difference between the vibration's envelope at the "
                                                         "pick-up and the commanded one, relative to the "
                                                         "commanded (rms); of several intervals, the largest",
                                                         "dB"}),
       field<&T::follow, &FollowRow::envelope_lag_us>({"envelope_lag_us", "envelope_lag_us",
                                                       "Time by which the envelope at the pick-up is behind "
                                                       "the commanded one; of several intervals, the "
                                                       "one furthest from 0",
                                                       "us"})}};
  return table;
}

const Table<ToneRow>& tone_table() {
  using T = ToneRow;
  static const Table<T> table{
      "tone",
      {"session_id", "trial_index"},
      {field<&T::interval_index>({"interval_index", "interval_index",
                                  "Number of the interval in the order presented, from 0; the scenes of an "
                                  "interval of several parts count one by one"}),
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
       field<&T::model>({"model", "model", "Physical model with which the tone was planned"}),
       field<&T::error_bound_mm>({"error_bound_mm", "error_bound_mm",
                                  "Bound of the model's error in the position of the boundary", "mm"}),
       field<&T::uncertainty_mm>({"uncertainty_mm", "uncertainty_mm",
                                  "Uncertainty of the boundary's position that the rig's parameters cause",
                                  "mm"}),
       field<&T::level_uncertainty_dB>(
           {"level_uncertainty_dB", "level_uncertainty_db",
            "Standard deviation of the level at the tone's last maximum that the rig's parameters cause, "
            "computed at a frequency that differs by at most 0.25 %",
            "dB"}),
       field<&T::reason>({"reason", "reason", "Why this model was chosen"}),
       field<&T::onset_frame>({"onset_frame", "onset_frame",
                               "Output frame at which the tone starts, counted from the start of the segment",
                               "frames"}),
       field<&T::length_frames>(
           {"length_frames", "length_frames", "Length of the tone, including both ramps", "frames"}),
       field<&T::measured_dB>(
           {"measured_dB", "measured_db",
            "Amplitude of the tone at the pick-up, relative to the plan; n/a if not measured", "dB"}),
       field<&T::measured_phase_deg>({"measured_phase_deg", "measured_phase_deg",
                                      "Phase of the tone at the pick-up, relative to the calibration",
                                      "deg"}),
       field<&T::of_interval>({"of_interval", "of_interval",
                               "Number of the task's interval to which this one belongs, in the order "
                               "presented, from 0; differs from interval_index if an interval of the task "
                               "has several parts, or is presented again; -1 for what comes before the first "
                               "interval"})}};
  return table;
}

const Table<SignalRow>& signal_table() {
  using S = SignalRow;
  static const Table<S> table{
      "signal",
      {"session_id", "trial_index"},
      {field<&S::stream>({"stream"}), field<&S::start_frame>({"start_frame"}),
       field<&S::start_s>({"start_s"}), field<&S::rate_Hz>({"rate_Hz"}), field<&S::points>({"points"}),
       field<&S::channels>({"channels"}), field<&S::encoding>({"encoding"}), field<&S::data>({"data"})}};
  return table;
}

}  // namespace turnpoint::store

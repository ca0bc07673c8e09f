#include <nlohmann/json.hpp>

#include "station/store/field.hpp"

namespace turnpoint::store {

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

}  // namespace turnpoint::store

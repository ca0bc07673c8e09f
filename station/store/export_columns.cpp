#include <algorithm>
#include <nlohmann/json.hpp>

#include "station/store/export_tables.hpp"

namespace turnpoint::store {

namespace {

using Json = nlohmann::ordered_json;

const Column kParticipant{"participant_id", "Participant code", "", ""};
const Column kSession{"session_id", "UUID of the sitting, unique over all stations", "", ""};
const Column kRunMode{"run_mode", "Whether these are data of a study", "", "live | pilot | simulated"};
const Column kTrial{"trial_index", "Trial of the session, counting every presented one, from 0", "", ""};
const Column kColumnsVersion{"columns_version", "Version of this set of columns", "", ""};

Json explained(const Column& column) {
  Json json;
  json["Description"] = column.description;
  if (!column.unit.empty()) json["Units"] = column.unit;
  if (!column.values.empty()) json["Values"] = column.values;
  return json;
}

Json explained(const std::vector<Column>& columns) {
  Json json = Json::object();
  for (const auto& column : columns) json[column.name] = explained(column);
  return json;
}

}  // namespace

std::vector<std::string> names_of(const std::vector<Column>& columns) {
  std::vector<std::string> names;
  for (const auto& column : columns) names.push_back(column.name);
  return names;
}

std::vector<Column> trial_columns(const std::vector<std::string>& factors) {
  std::vector<Column> columns = {
      kParticipant,
      kSession,
      {"session_index", "Sitting of this participant with this protocol, from 1", "", ""},
      kRunMode,
      {"protocol_id", "Identifier of the protocol", "", ""},
      {"protocol_version", "Version that the protocol file states", "", ""},
      {"protocol_sha256", "Hash of the protocol as it was run", "", ""},
      {"block_index", "Block in the order run, from 0", "", ""},
      {"block_name", "Name of the block", "", ""},
      {"instruction", "Instruction in force", "", "speed | accuracy | ... | n/a"},
      {"practice", "1 in a practice block", "", "0 | 1"},
      {"attempt", "How often this block was begun before; rows of earlier attempts stay", "", ""},
      {"segment_id", "Process run within the session, from 1; rises with each resume", "", ""},
      kTrial,
      {"trial_type", "Only experimental trials belong to procedures and fits", "",
       "experimental | catch | practice | warmup"},
      {"procedure", "Procedure that chose the level; n/a outside procedures", "", ""},
      {"onset", "Zero of the response time, from the start of the segment", "s", ""},
      {"duration", "Of the whole trial", "s", ""},
      {"level", "Level that was presented", "see level_unit", ""},
      {"level_unit", "Unit of the level", "", ""},
  };
  const auto at = static_cast<std::ptrdiff_t>(columns.size());
  const std::vector<Column> rest = {
      {"boundary_mm", "Boundary presented last in the trial, from the wide end", "mm", ""},
      {"frequency_hz", "First tone of the scene presented last", "Hz", ""},
      {"amplitude", "Predicted displacement of that scene at its last maximum", "um", ""},
      {"model", "Model that planned that scene", "", ""},
      {"correct_response", "Right choice; n/a where nothing is right", "", ""},
      {"response", "Choice made; in an adjustment the setting, in the unit of the level", "", ""},
      {"correct", "1 where the choice was right; only for scored answers", "", "0 | 1 | n/a"},
      {"outcome", "How the trial ended; only answered trials have a response, a score and a response time",
       "", "answered | timeout | anticipation | aborted | fault"},
      {"response_time", "From response_zero to the answer, raw", "s", ""},
      {"decision_time", "From response_zero to the lift-off of the finger", "s", ""},
      {"movement_time", "From lift-off to the answer", "s", ""},
      {"response_zero", "Where response times count from", "",
       "go_cue | change | interval_off | first_contact | lift_off"},
      {"response_time_quality", "Whose time stamp the answer bears", "",
       "kernel | toolkit | simulated | n/a"},
      {"response_offset_s", "Latency found by calibration; not subtracted from response_time", "s", ""},
      {"deadline", "Time allowed from response_zero", "s", ""},
      {"xruns", "Interruptions of the drive signal during the trial", "", ""},
      {"extra_touches", "Touches and presses that were not answers", "", ""},
      {"threshold_est", "Estimate of the trial's procedure after it", "see level_unit", ""},
      {"threshold_sd", "Standard deviation of that estimate", "see level_unit", ""},
      {"seed", "Seed of all random draws of the session", "", ""},
      {"station_id", "Identifier of the station", "", ""},
      {"calibration_id", "Hash of the calibration in force; n/a on a simulated rig", "", ""},
      {"software_version", "Version of the program", "", ""},
      kColumnsVersion,
  };
  columns.insert(columns.end(), rest.begin(), rest.end());
  const auto fixed = names_of(columns);
  std::vector<Column> own;
  for (const auto& factor : factors) {
    // Two columns of one name are read differently by every program.
    const bool clash = std::find(fixed.begin(), fixed.end(), factor) != fixed.end();
    own.push_back(
        {clash ? "factor_" + factor : factor, "Factor of the protocol: its value in this trial", "", ""});
  }
  columns.insert(columns.begin() + at, own.begin(), own.end());
  return columns;
}

std::vector<Column> interval_columns() {
  return {kParticipant,
          kSession,
          kRunMode,
          {"block_index", "Block in the order run, from 0", "", ""},
          {"attempt", "Attempt at the block", "", ""},
          kTrial,
          {"interval_index", "Interval in the order presented, from 0", "", ""},
          {"scene_index", "Scene within the interval's sequence, from 0", "", ""},
          {"tone_index", "Tone of the scene, from 0", "", ""},
          {"scene", "Scene of the protocol", "", ""},
          {"boundary_mm", "Boundary of the scene, from the wide end", "mm", ""},
          {"frequency_hz", "Frequency of the tone", "Hz", ""},
          {"amplitude_um", "Peak displacement of the drive edge", "um", ""},
          {"displacement_um", "Predicted displacement at the tone's last maximum", "um", ""},
          {"friction", "Predicted friction of the scene, relative to the still surface", "", ""},
          {"rove_db", "Roving of the level added to this interval", "dB", ""},
          {"model", "Model that planned the tone", "", ""},
          {"error_bound_mm", "Bound of the model's error", "mm", ""},
          {"uncertainty_mm", "From the uncertainty of the rig's parameters", "mm", ""},
          {"reason", "Why this model", "", ""},
          {"onset_frame", "First frame at the output, from the start of the segment", "frames", ""},
          {"length_frames", "Length with both ramps", "frames", ""},
          kColumnsVersion};
}

std::vector<Column> event_columns() {
  return {kParticipant,
          kSession,
          kRunMode,
          {"segment_id", "Process run within the session, from 1", "", ""},
          {"onset", "Time of the event, from the start of the segment", "s", ""},
          {"time_ns", "The same on the station's monotonic clock", "ns", ""},
          {"kind", "What happened: presented, answer, touch, contact, xrun, fault, aborted, ...", "", ""},
          {"value", "Detail", "", ""},
          kTrial,
          kColumnsVersion};
}

std::vector<Column> session_columns() {
  return {kParticipant,
          kSession,
          {"session_index", "Sitting of this participant with this protocol, from 1", "", ""},
          {"sequence_index", "Participant's place in the counterbalancing, from 0", "", ""},
          kRunMode,
          {"status", "How it stands", "", "running | completed | interrupted | stopped | abandoned"},
          {"status_reason", "Why it ended so", "", ""},
          {"started", "Local time with zone", "ISO 8601", ""},
          {"segments", "Process runs; above 1 the session was resumed", "", ""},
          {"trials", "Trials of every type and outcome", "", ""},
          {"protocol_id", "Identifier of the protocol", "", ""},
          {"protocol_version", "Version that the protocol file states", "", ""},
          {"protocol_sha256", "Hash of the protocol as it was run", "", ""},
          {"protocol_path", "File it was read from", "", ""},
          {"rig_name", "Name of the rig", "", ""},
          {"rig_sha256", "Hash of the rig file", "", ""},
          {"rig_path", "File it was read from", "", ""},
          {"calibration_id", "Hash of the calibration; n/a on a simulated rig", "", ""},
          {"seed", "Seed of all random draws", "", ""},
          {"language", "Language shown", "", ""},
          {"observer", "Simulated observer, if one answered", "", ""},
          {"software_version", "Version of the program", "", ""},
          {"kernel", "Kernel of the station", "", ""},
          {"station_id", "Identifier of the station", "", ""},
          {"realtime_rights", "What the kernel granted to the real-time threads", "", ""},
          {"consent_version", "Version of the consent form", "", ""},
          {"annotations", "Notes of the researchers, oldest first", "", ""},
          kColumnsVersion};
}

std::string codebook_json(const std::string& protocol_id, const std::vector<std::string>& factors) {
  Json json;
  json["protocol_id"] = protocol_id;
  json["missing"] = "n/a";
  json["trials.csv"] = explained(trial_columns(factors));
  json["intervals.csv"] = explained(interval_columns());
  json["events.csv"] = explained(event_columns());
  json["sessions.csv"] = explained(session_columns());
  return json.dump(2) + "\n";
}

std::string sidecar_json(const std::string& task, const std::vector<Column>& columns) {
  Json json;
  json["TaskName"] = task;
  for (const auto& column : columns) json[column.name] = explained(column);
  return json.dump(2) + "\n";
}

}  // namespace turnpoint::store

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "station/store/export_tables.hpp"
#include "station/store/fields.hpp"

namespace turnpoint::store {

namespace {

using Json = nlohmann::ordered_json;

/// Makes the exported column `csv` from the field of `table` that has this export name.
template <class Record>
ExportColumn exported(const Table<Record>& table, const std::string& csv, const Record* ExportRow::*record) {
  for (const auto& field : table.fields)
    if (field.csv == csv)
      return {{csv, field.description, field.unit, field.values},
              [cell = field.cell, record](const ExportRow& row) { return cell(*(row.*record)); }};
  throw std::logic_error("export: table " + std::string(table.name) + " has no column " + csv);
}

ExportColumn session(const std::string& csv) {
  for (const auto* table : {&session_table(), &protocol_table(), &rig_table()})
    for (const auto& field : table->fields)
      if (field.csv == csv) return exported(*table, csv, &ExportRow::session);
  throw std::logic_error("export: a session has no column " + csv);
}
ExportColumn block(const std::string& csv) { return exported(block_table(), csv, &ExportRow::block); }
ExportColumn trial(const std::string& csv) { return exported(trial_table(), csv, &ExportRow::trial); }
/// A column of the trial before, with the same meaning as in its own line.
ExportColumn previous(const std::string& csv) {
  auto column = exported(trial_table(), csv, &ExportRow::trial);
  column.column.name = "previous_" + csv;
  column.column.description =
      "The same column of the trial presented just before in this block; n/a for the first trial of an "
      "attempt "
      "or after an interruption";
  column.cell = [cell = std::move(column.cell)](const ExportRow& row) {
    ExportRow before = row;
    before.trial = row.previous;
    return row.previous ? cell(before) : Cell{};
  };
  return column;
}
ExportColumn tone(const std::string& csv) { return exported(tone_table(), csv, &ExportRow::tone); }
ExportColumn event(const std::string& csv) { return exported(event_table(), csv, &ExportRow::event); }

ExportColumn check(const std::string& csv) { return exported(check_table(), csv, &ExportRow::check); }

ExportColumn answer(const std::string& csv) { return exported(answer_table(), csv, &ExportRow::answer); }

ExportColumn level(const std::string& csv) {
  return exported(friction_level_table(), csv, &ExportRow::level);
}

ExportColumn program(const std::string& csv) { return exported(program_table(), csv, &ExportRow::program); }

ExportColumn estimate(const std::string& csv) {
  return exported(estimate_table(), csv, &ExportRow::estimate);
}

template <class Make>
void add(ExportColumns& columns, Make make, std::initializer_list<const char*> names) {
  for (const auto* name : names) columns.push_back(make(name));
}

ExportColumn session_id() {
  return {{"session_id", "UUID of the session, unique over all stations", "", ""},
          [](const ExportRow& row) { return cell(row.session->session_id); }};
}

ExportColumn participant_id() {
  return {
      {"participant_id", "Code of the participant, or CODE@STATION if several people have this code", "", ""},
      [](const ExportRow& row) { return cell(row.session->person); }};
}

/// In version 2 of the columns, onset and duration describe the stimulus, as in BIDS. Response zero (the
/// moment from which response times count) and the length of the trial have separate columns. The participant
/// column names a person.
ExportColumn columns_version() {
  return {{"columns_version", "Version of this set of columns", "", ""},
          [](const ExportRow&) { return cell(std::string("2")); }};
}

ExportColumn stimulus_onset() {
  return {{"onset",
           "Start of the trial's first stimulus, from the start of the segment; n/a if no stimulus began",
           "s", ""},
          [](const ExportRow& row) { return row.span ? cell(row.span->onset_s) : Cell{}; }};
}

ExportColumn stimulus_duration() {
  return {{"duration", "Time from the start of the trial's first stimulus to the end of its last stimulus",
           "s", ""},
          [](const ExportRow& row) { return row.span ? cell(row.span->duration_s) : Cell{}; }};
}

ExportColumn last_model() {
  return {{"model", "Physical model with which the scene presented last in the trial was planned", "", ""},
          [](const ExportRow& row) {
            const auto& tones = row.trial->tones;
            return tones.empty() ? Cell{} : cell(tones.back().model);
          }};
}

ExportColumn event_onset() {
  return {
      {"onset", "Time of the event, from the start of the segment; rows are in order of this time", "s", ""},
      [](const ExportRow& row) {
        return cell(static_cast<double>(row.event->time_ns - row.origin_ns) * 1e-9);
      }};
}

ExportColumn segments() {
  return {{"segments", "Number of times the program ran this session; more than 1 if the session was resumed",
           "", ""},
          [](const ExportRow& row) { return cell(row.session->segments); }};
}

ExportColumn trials() {
  return {{"trials", "Number of trials, of every type and outcome", "", ""},
          [](const ExportRow& row) { return cell(row.session->trials); }};
}

ExportColumn annotations() {
  return {{"annotations", "Notes of the researchers, oldest first", "", ""}, [](const ExportRow& row) {
            std::string all;
            for (const auto& text : row.session->annotations) all += (all.empty() ? "" : "; ") + text;
            return cell(all);
          }};
}

ExportColumn checksum() {
  return {{"checksum",
           "Last link of the chain of checksums over the session's rows; `turnpoint verify --against` "
           "compares this checksum with a database",
           "", ""},
          [](const ExportRow& row) { return cell(row.session->checksum); }};
}

ExportColumn self_test() {
  return {{"self_test",
           "Result of the newest self-test before the session, with the operator's reason to continue if a "
           "check failed; self_tests.csv has the checks",
           "", "passed | failed | failed; continued: ... | n/a"},
          [](const ExportRow& row) { return row.self_test ? cell(row.self_test->value) : Cell{}; }};
}

ExportColumn factor_value(const ExportedFactor& factor, const std::string& name) {
  return {{name, "Value of this factor of the protocol in the trial", "", "", factor.levels},
          [factor = factor.name](const ExportRow& row) {
            const auto found = row.trial->factors.find(factor);
            if (found == row.trial->factors.end()) return Cell{};
            return std::visit([](const auto& value) { return cell(value); }, found->second);
          }};
}

/// Adds a column for each factor. A factor with the name of another column gets the prefix factor_, because
/// programs disagree on how to read two columns with the same name.
void add_factors(ExportColumns& columns, std::ptrdiff_t at, const std::vector<ExportedFactor>& factors) {
  const auto fixed = names_of(columns);
  ExportColumns own;
  for (const auto& factor : factors) {
    const bool clash = std::find(fixed.begin(), fixed.end(), factor.name) != fixed.end();
    own.push_back(factor_value(factor, clash ? "factor_" + factor.name : factor.name));
  }
  columns.insert(columns.begin() + at, own.begin(), own.end());
}

Json explained(const Column& column) {
  Json json;
  json["Description"] = column.description;
  if (!column.unit.empty()) json["Units"] = column.unit;
  if (!column.values.empty()) json["Values"] = column.values;
  for (const auto& level : column.levels) json["Levels"][level] = level;
  return json;
}

Json explained(const ExportColumns& columns) {
  Json json = Json::object();
  for (const auto& [column, cell] : columns) json[column.name] = explained(column);
  return json;
}

}  // namespace

std::vector<std::string> names_of(const ExportColumns& columns) {
  std::vector<std::string> names;
  for (const auto& [column, cell] : columns) names.push_back(column.name);
  return names;
}

std::vector<std::string> names_of(const std::vector<Column>& columns) {
  std::vector<std::string> names;
  for (const auto& column : columns) names.push_back(column.name);
  return names;
}

std::vector<Cell> cells_of(const ExportColumns& columns, const ExportRow& row) {
  std::vector<Cell> cells;
  cells.reserve(columns.size());
  for (const auto& [column, cell] : columns) cells.push_back(cell(row));
  return cells;
}

std::vector<Column> explanations(const ExportColumns& columns) {
  std::vector<Column> list;
  for (const auto& [column, cell] : columns) list.push_back(column);
  return list;
}

ExportColumns trial_columns(const std::vector<ExportedFactor>& factors) {
  ExportColumns columns{participant_id(), session_id()};
  add(columns, session, {"session_index", "run_mode", "protocol_id", "protocol_version", "protocol_sha256"});
  add(columns, block, {"block_index", "block_name", "instruction", "practice", "attempt"});
  add(columns, trial, {"segment_id", "trial_index", "trial_type", "procedure"});
  columns.push_back(stimulus_onset());
  columns.push_back(stimulus_duration());
  add(columns, trial, {"level"});
  add(columns, session, {"level_unit"});
  const auto at = static_cast<std::ptrdiff_t>(columns.size());
  add(columns, trial, {"boundary_mm", "frequency_hz", "amplitude"});
  columns.push_back(last_model());
  add(columns, trial,
      {"correct_response", "response", "correct", "outcome", "response_time", "decision_time",
       "movement_time", "response_zero", "response_time_quality", "response_offset_s", "deadline", "xruns",
       "extra_touches", "threshold_est", "threshold_sd"});
  add(columns, session, {"seed", "station_id", "calibration_id", "software_version"});
  add(columns, trial,
      {"response_zero_onset",
       "trial_duration",
       "proof",
       "proof_cause",
       "drive_ratio_db",
       "drive_residual_db",
       "onset_error_us",
       "confidence",
       "confidence_time",
       "points",
       "sensing",
       "contact_s",
       "strokes",
       "normal_n",
       "normal_sd_n",
       "normal_in_window",
       "speed_mm_s",
       "speed_in_window",
       "mu_low",
       "mu_high",
       "boundary_felt_mm",
       "boundary_se_mm",
       "lag_mm",
       "tare_mn",
       "mu",
       "silence_db",
       "silence_tone_db",
       "followed",
       "mu_asked",
       "mu_commanded",
       "mu_felt",
       "follow_lag_ms",
       "follow_inside",
       "follow_share",
       "envelope_error_db",
       "envelope_lag_us"});
  add(columns, previous, {"level", "correct_response", "response", "correct", "outcome"});
  add(columns, trial, {"again"});
  add(columns, previous, {"procedure"});
  columns.push_back(columns_version());
  add_factors(columns, at, factors);
  return columns;
}

ExportColumns interval_columns() {
  ExportColumns columns{participant_id(), session_id(), session("run_mode")};
  add(columns, block, {"block_index", "attempt"});
  add(columns, trial, {"trial_index"});
  add(columns, tone, {"interval_index",
                      "scene_index",
                      "tone_index",
                      "scene",
                      "boundary_mm",
                      "frequency_hz",
                      "amplitude_um",
                      "displacement_um",
                      "friction",
                      "rove_db",
                      "model",
                      "error_bound_mm",
                      "uncertainty_mm",
                      "level_uncertainty_db",
                      "reason",
                      "onset_frame",
                      "length_frames",
                      "measured_db",
                      "measured_phase_deg",
                      "of_interval"});
  columns.push_back(columns_version());
  return columns;
}

ExportColumns event_columns() {
  ExportColumns columns{participant_id(), session_id(), session("run_mode"), event("segment_id"),
                        event_onset()};
  add(columns, event, {"time_ns", "kind", "value", "trial_index"});
  columns.push_back(columns_version());
  return columns;
}

ExportColumns session_columns() {
  ExportColumns columns{participant_id(), session_id()};
  add(columns, session,
      {"session_index", "sequence_index", "planned_session", "participant_group", "run_mode", "status",
       "status_reason", "started"});
  columns.push_back(segments());
  columns.push_back(trials());
  add(columns, session,
      {"protocol_id", "protocol_version", "protocol_sha256", "protocol_path", "rig_name", "rig_sha256",
       "rig_path", "calibration_id", "seed", "language", "observer", "software_version", "kernel",
       "station_id", "realtime_rights", "consent_version"});
  columns.push_back(annotations());
  columns.push_back(checksum());
  add(columns, session,
      {"participant_code", "humidity_percent", "room_temperature_c", "surface_cleaned", "finger",
       "skin_moisture"});
  columns.push_back(self_test());
  columns.push_back(columns_version());
  return columns;
}

ExportColumns self_test_columns() {
  ExportColumns columns{participant_id(), session_id(), session("run_mode"), event("segment_id"),
                        event_onset()};
  add(columns, check, {"check", "verdict", "value", "limit", "unit", "what"});
  columns.push_back(columns_version());
  return columns;
}

ExportColumns answer_columns() {
  ExportColumns columns{participant_id(),    session_id(),        session("session_index"),
                        session("run_mode"), event("segment_id"), event_onset()};
  add(columns, answer, {"questionnaire", "item", "occasion", "answer", "response_time"});
  columns.push_back(columns_version());
  return columns;
}

ExportColumns friction_columns() {
  ExportColumns columns{participant_id(), session_id(), session("run_mode"), event("segment_id"),
                        event_onset()};
  add(columns, level, {"displacement_um", "trials", "measured", "relative_friction", "sd", "low", "high"});
  columns.push_back(columns_version());
  return columns;
}

ExportColumns program_columns() {
  ExportColumns columns{participant_id(), session_id(), session("run_mode"), event("segment_id"),
                        event_onset()};
  add(columns, program, {"role", "procedure", "program", "version", "path", "sha256"});
  columns.push_back(columns_version());
  return columns;
}

ExportColumns estimate_columns() {
  ExportColumns columns{participant_id(), session_id(), session("run_mode"), event("segment_id"),
                        event_onset()};
  add(columns, estimate, {"block_index", "attempt", "procedure", "parameter", "mean", "sd", "basis"});
  columns.push_back(columns_version());
  return columns;
}

const EventRow* newest_self_test(const StoredSession& stored) {
  const EventRow* newest = nullptr;
  for (const auto& event : stored.events)
    if (event.kind == "self_test") newest = &event;
  return newest;
}

std::string codebook_json(const std::string& protocol_id, const std::vector<ExportedFactor>& factors) {
  Json json;
  json["protocol_id"] = protocol_id;
  json["missing"] = "n/a";
  json["trials.csv"] = explained(trial_columns(factors));
  json["intervals.csv"] = explained(interval_columns());
  json["events.csv"] = explained(event_columns());
  json["sessions.csv"] = explained(session_columns());
  json["self_tests.csv"] = explained(self_test_columns());
  json["answers.csv"] = explained(answer_columns());
  json["friction_tables.csv"] = explained(friction_columns());
  json["programs.csv"] = explained(program_columns());
  json["estimates.csv"] = explained(estimate_columns());
  return json.dump(2) + "\n";
}

std::string columns_json(const std::vector<Column>& columns) {
  Json json = Json::object();
  for (const auto& column : columns) json[column.name] = explained(column);
  return json.dump(2) + "\n";
}

}  // namespace turnpoint::store

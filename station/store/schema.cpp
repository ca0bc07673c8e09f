#include "station/store/schema.hpp"

#include <fmt/format.h>

#include <map>
#include <utility>

namespace turnpoint::store {

namespace {

// Each text (protocol, rig, calibration) is stored only once. The keys of a session's rows contain the
// session's UUID, so databases of several stations can be merged without renumbering.
const char* const kTables = R"sql(
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) STRICT, WITHOUT ROWID;

CREATE TABLE participant (code TEXT PRIMARY KEY CHECK (code <> '')) STRICT, WITHOUT ROWID;

CREATE TABLE enrolment (
  station_id TEXT NOT NULL,
  protocol_id TEXT NOT NULL,
  participant TEXT NOT NULL REFERENCES participant (code),
  sequence_index INTEGER NOT NULL CHECK (sequence_index >= 0),
  PRIMARY KEY (station_id, protocol_id, participant),
  UNIQUE (station_id, protocol_id, sequence_index)
) STRICT, WITHOUT ROWID;

-- A code belongs to the station that assigned it. Two codes belong to one person only if a row here says so.
CREATE TABLE same_person (
  station_a TEXT NOT NULL,
  code_a TEXT NOT NULL,
  station_b TEXT NOT NULL,
  code_b TEXT NOT NULL,
  realtime_ns INTEGER NOT NULL,
  PRIMARY KEY (station_a, code_a, station_b, code_b),
  CHECK (station_a <> station_b OR code_a <> code_b)
) STRICT, WITHOUT ROWID;

-- A place in the counterbalancing that a collector has leased to this station.
CREATE TABLE lease (
  protocol_id TEXT NOT NULL,
  sequence_index INTEGER NOT NULL CHECK (sequence_index >= 0),
  PRIMARY KEY (protocol_id, sequence_index)
) STRICT, WITHOUT ROWID;

-- The mark of a session that its participant has withdrawn: its rows may be deleted and must never come back.
-- The participant's code is kept only as a salted hash, so that the code is not assigned again; the hash is ''
-- if a single session was withdrawn and the code stays in use.
CREATE TABLE tombstone (
  session_id TEXT PRIMARY KEY CHECK (length(session_id) = 36),
  salt TEXT NOT NULL,
  participant_sha256 TEXT NOT NULL,
  withdrawn_realtime_ns INTEGER NOT NULL,
  station_id TEXT NOT NULL CHECK (station_id <> '')
) STRICT, WITHOUT ROWID;

CREATE TABLE protocol (
  protocol_key TEXT PRIMARY KEY,
  protocol_id TEXT NOT NULL,
  version TEXT NOT NULL,
  sha256 TEXT NOT NULL,
  text TEXT NOT NULL,
  canonical TEXT NOT NULL
) STRICT, WITHOUT ROWID;

CREATE TABLE rig (
  rig_key TEXT PRIMARY KEY,
  name TEXT NOT NULL,
  sha256 TEXT NOT NULL,
  text TEXT NOT NULL
) STRICT, WITHOUT ROWID;

CREATE TABLE calibration (calibration_id TEXT PRIMARY KEY, text TEXT NOT NULL) STRICT, WITHOUT ROWID;

CREATE TABLE session (
  session_id TEXT PRIMARY KEY CHECK (length(session_id) = 36),
  participant TEXT NOT NULL REFERENCES participant (code),
  protocol_key TEXT NOT NULL REFERENCES protocol (protocol_key),
  protocol_path TEXT NOT NULL,
  rig_key TEXT NOT NULL REFERENCES rig (rig_key),
  rig_path TEXT NOT NULL,
  calibration_id TEXT REFERENCES calibration (calibration_id),
  run_mode TEXT NOT NULL CHECK (run_mode IN ('live', 'pilot', 'simulated')),
  session_index INTEGER NOT NULL CHECK (session_index >= 1),
  sequence_index INTEGER NOT NULL CHECK (sequence_index >= 0),
  leased_place INTEGER NOT NULL CHECK (leased_place IN (0, 1)),
  planned_session INTEGER CHECK (planned_session >= 1),
  participant_group TEXT NOT NULL,
  seed INTEGER NOT NULL,
  language TEXT NOT NULL,
  observer TEXT NOT NULL CHECK ((observer <> '') = (run_mode = 'simulated')),
  factor_columns TEXT NOT NULL CHECK (json_valid(factor_columns)),
  level_unit TEXT NOT NULL,
  software_version TEXT NOT NULL,
  columns_version TEXT NOT NULL,
  kernel TEXT NOT NULL,
  station_id TEXT NOT NULL CHECK (station_id <> ''),
  realtime_rights TEXT NOT NULL,
  started_local TEXT NOT NULL,
  consent_version TEXT NOT NULL,
  humidity_percent REAL CHECK (humidity_percent BETWEEN 0 AND 100),
  room_temperature_C REAL CHECK (room_temperature_C BETWEEN -20 AND 60),
  surface_cleaned INTEGER CHECK (surface_cleaned IN (0, 1)),
  finger TEXT NOT NULL,
  skin_moisture REAL CHECK (skin_moisture >= 0),
  status TEXT NOT NULL CHECK (status IN ('running', 'completed', 'interrupted', 'stopped', 'abandoned')),
  status_reason TEXT NOT NULL
) STRICT, WITHOUT ROWID;

CREATE TABLE segment (
  session_id TEXT NOT NULL REFERENCES session (session_id),
  segment_index INTEGER NOT NULL CHECK (segment_index >= 1),
  boot_id TEXT NOT NULL,
  reason TEXT NOT NULL,
  monotonic_ns INTEGER NOT NULL,
  boottime_ns INTEGER NOT NULL,
  realtime_ns INTEGER NOT NULL,
  machine TEXT NOT NULL,
  PRIMARY KEY (session_id, segment_index)
) STRICT, WITHOUT ROWID;

CREATE TABLE block (
  session_id TEXT NOT NULL REFERENCES session (session_id),
  block_index INTEGER NOT NULL CHECK (block_index >= 0),
  attempt INTEGER NOT NULL CHECK (attempt >= 0),
  run_order INTEGER NOT NULL,
  name TEXT NOT NULL,
  instruction TEXT NOT NULL,
  practice INTEGER NOT NULL CHECK (practice IN (0, 1)),
  PRIMARY KEY (session_id, block_index, attempt),
  UNIQUE (session_id, run_order)
) STRICT, WITHOUT ROWID;

CREATE TABLE trial (
  trial_id INTEGER PRIMARY KEY,
  session_id TEXT NOT NULL REFERENCES session (session_id),
  segment_index INTEGER NOT NULL,
  block_index INTEGER NOT NULL,
  attempt INTEGER NOT NULL,
  trial_index INTEGER NOT NULL CHECK (trial_index >= 0),
  trial_in_block INTEGER NOT NULL,
  trial_type TEXT NOT NULL CHECK (trial_type IN ('experimental', 'catch', 'practice', 'warmup')),
  procedure TEXT NOT NULL,
  level REAL,
  factors TEXT NOT NULL CHECK (json_valid(factors)),
  boundary_mm REAL,
  frequency_Hz REAL,
  amplitude REAL,
  correct_response TEXT,
  response TEXT,
  correct INTEGER CHECK (correct IN (0, 1)),
  outcome TEXT NOT NULL CHECK (outcome IN ('answered', 'timeout', 'anticipation', 'aborted', 'fault')),
  onset_ns INTEGER NOT NULL,
  onset_s REAL NOT NULL,
  duration_s REAL NOT NULL CHECK (duration_s >= 0),
  response_time_s REAL CHECK (response_time_s >= 0),
  decision_time_s REAL,
  movement_time_s REAL,
  response_zero TEXT NOT NULL,
  response_time_quality TEXT CHECK (response_time_quality IN ('kernel', 'toolkit', 'simulated')),
  response_offset_s REAL NOT NULL,
  deadline_s REAL,
  xruns INTEGER NOT NULL CHECK (xruns >= 0),
  extra_touches INTEGER NOT NULL CHECK (extra_touches >= 0),
  threshold_est REAL,
  threshold_sd REAL,
  clock_slope_ns_per_frame REAL,
  clock_residual_ns REAL,
  state_hash INTEGER NOT NULL,
  recorded_realtime_ns INTEGER NOT NULL,
  -- what a pick-up on the surface measured, and whether the stimuli were as planned
  proof TEXT NOT NULL CHECK (proof IN ('unproven', 'ok', 'flagged', 'refused', 'stopped', 'lost')),
  proof_cause TEXT NOT NULL,
  drive_ratio_dB REAL,
  drive_residual_dB REAL,
  onset_error_us REAL,
  silence_dB REAL,
  silence_tone_dB REAL,
  -- how sure the participant was, if the task asks
  confidence INTEGER CHECK (confidence IS NULL OR (confidence >= 1 AND outcome = 'answered')),
  confidence_time_s REAL
    CHECK ((confidence_time_s IS NULL) = (confidence IS NULL) AND coalesce(confidence_time_s, 0) >= 0),
  -- what the result was worth to the participant
  points REAL CHECK (points IS NULL OR outcome NOT IN ('aborted', 'fault')),
  -- how often the participant had the intervals presented again; NULL where nobody can
  again INTEGER CHECK (again >= 0),
  -- what force sensors measured
  sensing TEXT NOT NULL
    CHECK (sensing IN ('', 'ok', 'strokes', 'light', 'hard', 'slow', 'fast', 'lost', 'wire', 'tare')),
  contact_s REAL CHECK (contact_s >= 0),
  strokes INTEGER CHECK (strokes >= 0),
  normal_N REAL,
  normal_sd_N REAL,
  normal_in_window REAL,
  speed_mm_s REAL,
  speed_in_window REAL,
  mu REAL,
  mu_low REAL,
  mu_high REAL,
  boundary_felt_mm REAL,
  boundary_se_mm REAL,
  lag_mm REAL,
  tare_mN REAL,
  -- how the surface followed the finger
  followed TEXT NOT NULL,
  mu_asked REAL,
  mu_commanded REAL,
  mu_felt REAL,
  follow_lag_ms REAL,
  follow_inside REAL CHECK (follow_inside BETWEEN 0 AND 1),
  follow_share REAL CHECK (follow_share BETWEEN 0 AND 1),
  envelope_error_dB REAL,
  envelope_lag_us REAL,
  UNIQUE (session_id, trial_index),
  FOREIGN KEY (session_id, segment_index) REFERENCES segment (session_id, segment_index),
  FOREIGN KEY (session_id, block_index, attempt) REFERENCES block (session_id, block_index, attempt),
  CONSTRAINT no_answer_without_answering CHECK (outcome = 'answered' OR
    (response IS NULL AND correct IS NULL AND response_time_s IS NULL AND movement_time_s IS NULL
     AND response_time_quality IS NULL)),
  CONSTRAINT an_answer_has_its_time CHECK (outcome <> 'answered' OR
    response_time_s IS NOT NULL),
  CONSTRAINT score_agrees_with_answer CHECK (correct IS NULL OR
    (response IS NOT NULL AND correct_response IS NOT NULL AND correct = (response = correct_response)))
) STRICT;

CREATE TABLE tone (
  session_id TEXT NOT NULL,
  trial_index INTEGER NOT NULL,
  interval_index INTEGER NOT NULL,
  scene_index INTEGER NOT NULL,
  tone_index INTEGER NOT NULL,
  scene TEXT NOT NULL,
  boundary_mm REAL,
  frequency_Hz REAL NOT NULL,
  amplitude_um REAL NOT NULL,
  displacement_um REAL,
  friction REAL,
  rove_dB REAL NOT NULL,
  model TEXT NOT NULL,
  error_bound_mm REAL NOT NULL,
  uncertainty_mm REAL NOT NULL,
  level_uncertainty_dB REAL,
  reason TEXT NOT NULL,
  onset_frame INTEGER NOT NULL,
  length_frames INTEGER NOT NULL,
  measured_dB REAL,
  measured_phase_deg REAL,
  of_interval INTEGER NOT NULL,
  PRIMARY KEY (session_id, trial_index, interval_index, scene_index, tone_index),
  FOREIGN KEY (session_id, trial_index) REFERENCES trial (session_id, trial_index)
) STRICT, WITHOUT ROWID;

CREATE TABLE signal (
  session_id TEXT NOT NULL,
  trial_index INTEGER NOT NULL,
  stream TEXT NOT NULL CHECK (stream <> ''),
  start_frame INTEGER NOT NULL,
  start_s REAL NOT NULL,
  rate_Hz REAL NOT NULL CHECK (rate_Hz > 0),
  points INTEGER NOT NULL CHECK (points >= 0),
  channels TEXT NOT NULL CHECK (json_valid(channels)),
  encoding TEXT NOT NULL,
  data BLOB NOT NULL,
  PRIMARY KEY (session_id, trial_index, stream),
  FOREIGN KEY (session_id, trial_index) REFERENCES trial (session_id, trial_index)
) STRICT;

CREATE TABLE event (
  session_id TEXT NOT NULL,
  event_index INTEGER NOT NULL,
  segment_index INTEGER NOT NULL,
  time_ns INTEGER NOT NULL,
  kind TEXT NOT NULL CHECK (kind <> ''),
  value TEXT NOT NULL,
  trial_index INTEGER,
  PRIMARY KEY (session_id, event_index),
  FOREIGN KEY (session_id, segment_index) REFERENCES segment (session_id, segment_index)
) STRICT, WITHOUT ROWID;

CREATE TABLE self_test (
  session_id TEXT NOT NULL,
  event_index INTEGER NOT NULL,
  check_index INTEGER NOT NULL,
  name TEXT NOT NULL CHECK (name <> ''),
  verdict TEXT NOT NULL CHECK (verdict IN ('passed', 'failed', 'not possible')),
  value REAL,
  limit_value REAL,
  unit TEXT NOT NULL,
  what TEXT NOT NULL,
  PRIMARY KEY (session_id, event_index, check_index),
  FOREIGN KEY (session_id, event_index) REFERENCES event (session_id, event_index)
) STRICT, WITHOUT ROWID;

CREATE TABLE answer (
  session_id TEXT NOT NULL,
  event_index INTEGER NOT NULL,
  answer_index INTEGER NOT NULL,
  questionnaire TEXT NOT NULL CHECK (questionnaire <> ''),
  item TEXT NOT NULL CHECK (item <> ''),
  occasion INTEGER NOT NULL CHECK (occasion >= 0),
  answer TEXT NOT NULL CHECK (answer <> ''),
  response_time_s REAL NOT NULL CHECK (response_time_s >= 0),
  PRIMARY KEY (session_id, event_index, answer_index),
  FOREIGN KEY (session_id, event_index) REFERENCES event (session_id, event_index)
) STRICT, WITHOUT ROWID;

CREATE TABLE friction_level (
  session_id TEXT NOT NULL,
  event_index INTEGER NOT NULL,
  level_index INTEGER NOT NULL,
  displacement_um REAL NOT NULL CHECK (displacement_um > 0),
  trials INTEGER NOT NULL CHECK (trials > 0),
  measured REAL NOT NULL CHECK (measured > 0),
  relative_friction REAL NOT NULL CHECK (relative_friction > 0),
  sd REAL NOT NULL CHECK (sd >= 0),
  low REAL NOT NULL,
  high REAL NOT NULL,
  PRIMARY KEY (session_id, event_index, level_index),
  FOREIGN KEY (session_id, event_index) REFERENCES event (session_id, event_index)
) STRICT, WITHOUT ROWID;

CREATE TABLE program (
  session_id TEXT NOT NULL,
  event_index INTEGER NOT NULL,
  program_index INTEGER NOT NULL,
  role TEXT NOT NULL CHECK (role <> ''),
  procedure TEXT NOT NULL,
  name TEXT NOT NULL CHECK (name <> ''),
  version TEXT NOT NULL CHECK (version <> ''),
  path TEXT NOT NULL CHECK (path <> ''),
  sha256 TEXT NOT NULL CHECK (length(sha256) = 64),
  PRIMARY KEY (session_id, event_index, program_index),
  FOREIGN KEY (session_id, event_index) REFERENCES event (session_id, event_index)
) STRICT, WITHOUT ROWID;

CREATE TABLE estimate (
  session_id TEXT NOT NULL,
  event_index INTEGER NOT NULL,
  estimate_index INTEGER NOT NULL,
  block_index INTEGER NOT NULL CHECK (block_index >= 0),
  attempt INTEGER NOT NULL CHECK (attempt >= 0),
  procedure TEXT NOT NULL CHECK (procedure <> ''),
  parameter TEXT NOT NULL CHECK (parameter <> ''),
  mean REAL NOT NULL,
  sd REAL CHECK (sd >= 0),
  basis TEXT NOT NULL,
  PRIMARY KEY (session_id, event_index, estimate_index),
  FOREIGN KEY (session_id, event_index) REFERENCES event (session_id, event_index)
) STRICT, WITHOUT ROWID;

CREATE TABLE link (
  session_id TEXT NOT NULL REFERENCES session (session_id),
  link_index INTEGER NOT NULL CHECK (link_index >= 0),
  last_segment INTEGER NOT NULL,
  last_block INTEGER NOT NULL,
  last_trial INTEGER NOT NULL,
  last_event INTEGER NOT NULL,
  status TEXT NOT NULL,
  status_reason TEXT NOT NULL,
  sha256 TEXT NOT NULL CHECK (length(sha256) = 64),
  PRIMARY KEY (session_id, link_index)
) STRICT, WITHOUT ROWID;

CREATE TABLE annotation (
  annotation_id TEXT PRIMARY KEY,
  session_id TEXT NOT NULL REFERENCES session (session_id),
  realtime_ns INTEGER NOT NULL,
  text TEXT NOT NULL CHECK (text <> '')
) STRICT, WITHOUT ROWID;

CREATE TABLE merged (
  session_id TEXT NOT NULL REFERENCES session (session_id),
  sha256 TEXT NOT NULL,
  source_database_id TEXT NOT NULL,
  realtime_ns INTEGER NOT NULL,
  PRIMARY KEY (session_id, sha256)
) STRICT, WITHOUT ROWID;

-- A session whose station got another name (station.hpp): the name before, and the last link that was made under it.
CREATE TABLE renamed (
  session_id TEXT NOT NULL REFERENCES session (session_id),
  station_id TEXT NOT NULL,
  link_index INTEGER NOT NULL,
  PRIMARY KEY (session_id, station_id)
) STRICT, WITHOUT ROWID;

-- How many rows the tables without a chain of checksums have, and the sum of their hashes (seal.hpp).
CREATE TABLE seal (
  table_name TEXT PRIMARY KEY,
  row_count INTEGER NOT NULL,
  row_sum TEXT NOT NULL
) STRICT, WITHOUT ROWID;

CREATE TRIGGER session_stays_gone BEFORE INSERT ON session
  WHEN EXISTS (SELECT 1 FROM tombstone WHERE session_id = NEW.session_id)
  BEGIN SELECT RAISE(ABORT, 'the session was withdrawn'); END;

CREATE TRIGGER session_keeps_its_provenance BEFORE UPDATE OF session_id, participant, protocol_key, protocol_path,
    rig_key, rig_path, calibration_id, run_mode, session_index, sequence_index, leased_place, planned_session,
    participant_group, seed, language, observer, factor_columns, level_unit, software_version, columns_version, kernel,
    station_id, realtime_rights, started_local, consent_version, humidity_percent, room_temperature_C,
    surface_cleaned, finger, skin_moisture ON session
  BEGIN SELECT RAISE(ABORT, 'the provenance of a session is never changed'); END;
)sql";

/// The triggers of a table whose rows are never changed, and deleted only when their session is withdrawn.
std::string append_only(const char* table) {
  return fmt::format(R"sql(
CREATE TRIGGER {0}_is_never_changed BEFORE UPDATE ON {0}
  BEGIN SELECT RAISE(ABORT, '{0} is append-only'); END;
CREATE TRIGGER {0}_is_never_deleted BEFORE DELETE ON {0}
  WHEN NOT EXISTS (SELECT 1 FROM tombstone WHERE session_id = OLD.session_id)
  BEGIN SELECT RAISE(ABORT, '{0} is append-only'); END;
)sql",
                     table);
}

[[noreturn]] void refuse(ErrorKind kind, const Database& database, const std::string& what) {
  throw StoreError(kind, fmt::format("database {}: {}", database.path(), what));
}

/// An entry of sqlite_schema, by its kind ("table", "index", "trigger" or "view") and name.
using Entry = std::pair<std::string, std::string>;

/// Returns the SQL of each entry; that of an index that belongs to a key is empty.
std::map<Entry, std::string> entries_of(Database& database) {
  std::map<Entry, std::string> entries;
  Statement rows(database, "SELECT type, name, sql FROM sqlite_schema");
  while (rows.step()) entries[{rows.text(0), rows.text(1)}] = rows.text(2);
  return entries;
}

const std::map<Entry, std::string>& expected_entries() {
  static const auto expected = [] {
    Database database(":memory:", Database::Access::create);
    create_schema(database);
    return entries_of(database);
  }();
  return expected;
}

}  // namespace

void create_schema(Database& database) {
  Transaction transaction(database);
  database.execute(
      fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}", kApplicationId, kSchema));
  database.execute(kTables);
  for (const auto* table : {"trial", "tone", "signal", "event", "self_test", "answer", "friction_level",
                            "program", "estimate", "link"})
    database.execute(append_only(table));
  transaction.commit();
}

void require_schema(Database& database) {
  const auto application = database.integer("PRAGMA application_id");
  const auto schema = database.integer("PRAGMA user_version");
  if (application != kApplicationId || schema < 1)
    refuse(ErrorKind::not_a_database, database,
           "is an SQLite file, but not a Turnpoint database; nothing was changed; name another file, or one "
           "that does not exist yet");
  if (schema != kSchema)
    refuse(ErrorKind::other_schema, database,
           fmt::format("has schema {}, and this program reads only schema {}; nothing was changed; {}",
                       schema, kSchema,
                       schema < kSchema ? fmt::format("`turnpoint export` of commit {} reads it", kLastReader)
                                        : "update Turnpoint here"));
  const auto found = entries_of(database);
  for (const auto& [entry, sql] : expected_entries()) {
    if (entry.first != "table") continue;
    const auto at = found.find(entry);
    if (at == found.end() || at->second != sql)
      refuse(ErrorKind::corrupt, database,
             fmt::format(
                 "table {} is not as this program makes it; nothing was changed; restore the newest good "
                 "backup (turnpoint backup --db FILE --dir FOLDER --restore)",
                 entry.second));
  }
}

void require_no_trigger(Database& database) {
  for (const auto& [entry, sql] : entries_of(database))
    if (entry.first == "trigger" && expected_entries().count(entry) == 0)
      refuse(
          ErrorKind::refused, database,
          fmt::format("has a trigger that this program has not made, and that could change what is recorded; "
                      "nothing was changed; if you have made it, remove it: DROP TRIGGER \"{}\"",
                      entry.second));
}

std::vector<std::string> schema_problems(Database& database) {
  std::vector<std::string> problems;
  const auto found = entries_of(database);
  for (const auto& [entry, sql] : expected_entries()) {
    const auto at = found.find(entry);
    if (at == found.end())
      problems.push_back(fmt::format("{} {} is missing", entry.first, entry.second));
    else if (at->second != sql)
      problems.push_back(fmt::format("{} {} was changed", entry.first, entry.second));
  }
  for (const auto& [entry, sql] : found)
    if (expected_entries().count(entry) == 0)
      problems.push_back(fmt::format("{} {} was added", entry.first, entry.second));
  return problems;
}

}  // namespace turnpoint::store

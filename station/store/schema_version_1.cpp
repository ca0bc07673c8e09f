#include "station/store/schema.hpp"

namespace turnpoint::store {

// Version 1. Each text (protocol, rig, calibration) is stored only once. The keys of a session's rows contain
// the session's UUID, so databases of several stations can be merged without renumbering.
const char* schema_version_1() {
  return R"sql(
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
  seed INTEGER NOT NULL,
  language TEXT NOT NULL,
  observer TEXT NOT NULL CHECK ((observer <> '') = (run_mode = 'simulated')),
  factor_columns TEXT NOT NULL CHECK (json_valid(factor_columns)),
  level_unit TEXT NOT NULL,
  software_version TEXT NOT NULL,
  columns_version TEXT NOT NULL,
  kernel TEXT NOT NULL,
  station_id TEXT NOT NULL,
  realtime_rights TEXT NOT NULL,
  started_local TEXT NOT NULL,
  consent_version TEXT NOT NULL,
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
  reason TEXT NOT NULL,
  onset_frame INTEGER NOT NULL,
  length_frames INTEGER NOT NULL,
  PRIMARY KEY (session_id, trial_index, interval_index, scene_index, tone_index),
  FOREIGN KEY (session_id, trial_index) REFERENCES trial (session_id, trial_index)
) STRICT, WITHOUT ROWID;

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

CREATE TABLE annotation (
  annotation_id TEXT PRIMARY KEY,
  session_id TEXT NOT NULL REFERENCES session (session_id),
  realtime_ns INTEGER NOT NULL,
  text TEXT NOT NULL CHECK (text <> '')
) STRICT, WITHOUT ROWID;

CREATE TRIGGER trial_is_never_changed BEFORE UPDATE ON trial
  BEGIN SELECT RAISE(ABORT, 'trial is append-only'); END;
CREATE TRIGGER trial_is_never_deleted BEFORE DELETE ON trial
  BEGIN SELECT RAISE(ABORT, 'trial is append-only'); END;
CREATE TRIGGER tone_is_never_changed BEFORE UPDATE ON tone
  BEGIN SELECT RAISE(ABORT, 'tone is append-only'); END;
CREATE TRIGGER tone_is_never_deleted BEFORE DELETE ON tone
  BEGIN SELECT RAISE(ABORT, 'tone is append-only'); END;
CREATE TRIGGER event_is_never_changed BEFORE UPDATE ON event
  BEGIN SELECT RAISE(ABORT, 'event is append-only'); END;
CREATE TRIGGER event_is_never_deleted BEFORE DELETE ON event
  BEGIN SELECT RAISE(ABORT, 'event is append-only'); END;
CREATE TRIGGER session_keeps_its_provenance BEFORE UPDATE OF session_id, participant, protocol_key, protocol_path,
    rig_key, rig_path, calibration_id, run_mode, session_index, sequence_index, seed, language, observer,
    factor_columns, level_unit, software_version, columns_version, kernel, station_id, realtime_rights,
    started_local, consent_version ON session
  BEGIN SELECT RAISE(ABORT, 'the provenance of a session is never changed'); END;
)sql";
}

}  // namespace turnpoint::store

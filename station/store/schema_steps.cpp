#include "station/store/schema.hpp"

namespace turnpoint::store {

namespace {

// Version 2 supports several stations, and withdrawal. A tombstone marks a session that its participant has
// withdrawn: the session's rows may be deleted and must never come back. The participant's code is kept only
// as a salted hash, so that the code is not assigned again.
const char* const kStep2 = R"sql(
CREATE TABLE tombstone (
  session_id TEXT PRIMARY KEY CHECK (length(session_id) = 36),
  salt TEXT NOT NULL,
  participant_sha256 TEXT NOT NULL,
  withdrawn_realtime_ns INTEGER NOT NULL
) STRICT, WITHOUT ROWID;

CREATE TABLE merged (
  session_id TEXT NOT NULL REFERENCES session (session_id),
  sha256 TEXT NOT NULL,
  source_database_id TEXT NOT NULL,
  realtime_ns INTEGER NOT NULL,
  PRIMARY KEY (session_id, sha256)
) STRICT, WITHOUT ROWID;

DROP TRIGGER trial_is_never_deleted;
DROP TRIGGER tone_is_never_deleted;
DROP TRIGGER event_is_never_deleted;
CREATE TRIGGER trial_is_never_deleted BEFORE DELETE ON trial
  WHEN NOT EXISTS (SELECT 1 FROM tombstone WHERE session_id = OLD.session_id)
  BEGIN SELECT RAISE(ABORT, 'trial is append-only'); END;
CREATE TRIGGER tone_is_never_deleted BEFORE DELETE ON tone
  WHEN NOT EXISTS (SELECT 1 FROM tombstone WHERE session_id = OLD.session_id)
  BEGIN SELECT RAISE(ABORT, 'tone is append-only'); END;
CREATE TRIGGER event_is_never_deleted BEFORE DELETE ON event
  WHEN NOT EXISTS (SELECT 1 FROM tombstone WHERE session_id = OLD.session_id)
  BEGIN SELECT RAISE(ABORT, 'event is append-only'); END;
CREATE TRIGGER session_stays_gone BEFORE INSERT ON session
  WHEN EXISTS (SELECT 1 FROM tombstone WHERE session_id = NEW.session_id)
  BEGIN SELECT RAISE(ABORT, 'the session was withdrawn'); END;
)sql";

// Version 3 adds a chain of checksums to each session (checksum.hpp). Sessions of earlier releases have no
// chain until they are resumed. They are listed in the table `unsealed`, because otherwise they would look as
// if somebody had removed their chain.
const char* const kStep3 = R"sql(
CREATE TABLE link (
  session_id TEXT NOT NULL REFERENCES session (session_id),
  link_index INTEGER NOT NULL CHECK (link_index >= 0),
  encoding INTEGER NOT NULL CHECK (encoding >= 1),
  last_segment INTEGER NOT NULL,
  last_block INTEGER NOT NULL,
  last_trial INTEGER NOT NULL,
  last_event INTEGER NOT NULL,
  status TEXT NOT NULL,
  status_reason TEXT NOT NULL,
  sha256 TEXT NOT NULL CHECK (length(sha256) = 64),
  PRIMARY KEY (session_id, link_index)
) STRICT, WITHOUT ROWID;

CREATE TABLE unsealed (session_id TEXT PRIMARY KEY REFERENCES session (session_id)) STRICT, WITHOUT ROWID;
INSERT INTO unsealed SELECT session_id FROM session;

CREATE TRIGGER link_is_never_changed BEFORE UPDATE ON link
  BEGIN SELECT RAISE(ABORT, 'link is append-only'); END;
CREATE TRIGGER link_is_never_deleted BEFORE DELETE ON link
  WHEN NOT EXISTS (SELECT 1 FROM tombstone WHERE session_id = OLD.session_id)
  BEGIN SELECT RAISE(ABORT, 'link is append-only'); END;
)sql";

// Version 4 lets several stations assign the same code. A code belongs to the station that assigned it, and
// two codes belong to one person only if a row of `same_person` says so. A tombstone names the station of its
// code; '' in older tombstones means any station. A tombstone without a hash withdraws a single session and
// leaves the code in use.
const char* const kStep4 = R"sql(
CREATE TABLE same_person (
  station_a TEXT NOT NULL,
  code_a TEXT NOT NULL,
  station_b TEXT NOT NULL,
  code_b TEXT NOT NULL,
  realtime_ns INTEGER NOT NULL,
  PRIMARY KEY (station_a, code_a, station_b, code_b),
  CHECK (station_a <> station_b OR code_a <> code_b)
) STRICT, WITHOUT ROWID;

ALTER TABLE tombstone ADD COLUMN station_id TEXT NOT NULL DEFAULT '';
)sql";

// Version 5 stores what a pick-up on the surface measured during a trial. Trials stored by earlier versions
// are unproven.
const char* const kStep5 = R"sql(
ALTER TABLE trial ADD COLUMN proof TEXT NOT NULL DEFAULT 'unproven'
  CHECK (proof IN ('unproven', 'ok', 'flagged', 'refused', 'stopped', 'lost'));
ALTER TABLE trial ADD COLUMN proof_cause TEXT NOT NULL DEFAULT '';
ALTER TABLE trial ADD COLUMN drive_ratio_dB REAL;
ALTER TABLE trial ADD COLUMN drive_residual_dB REAL;
ALTER TABLE trial ADD COLUMN onset_error_us REAL;
ALTER TABLE tone ADD COLUMN measured_dB REAL;
ALTER TABLE tone ADD COLUMN measured_phase_deg REAL;
)sql";

// Version 6 stores how sure the participant was of an answer, if the task asks, and what force sensors
// measured: a summary in each trial, and the signals themselves.
const char* const kStep6 = R"sql(
ALTER TABLE trial ADD COLUMN confidence INTEGER
  CHECK (confidence IS NULL OR (confidence >= 1 AND outcome = 'answered'));
ALTER TABLE trial ADD COLUMN confidence_time_s REAL
  CHECK ((confidence_time_s IS NULL) = (confidence IS NULL) AND coalesce(confidence_time_s, 0) >= 0);
ALTER TABLE trial ADD COLUMN sensing TEXT NOT NULL DEFAULT ''
  CHECK (sensing IN ('', 'ok', 'strokes', 'light', 'hard', 'slow', 'fast', 'lost', 'wire', 'tare'));
ALTER TABLE trial ADD COLUMN contact_s REAL CHECK (contact_s >= 0);
ALTER TABLE trial ADD COLUMN strokes INTEGER CHECK (strokes >= 0);
ALTER TABLE trial ADD COLUMN normal_N REAL;
ALTER TABLE trial ADD COLUMN normal_sd_N REAL;
ALTER TABLE trial ADD COLUMN normal_in_window REAL;
ALTER TABLE trial ADD COLUMN speed_mm_s REAL;
ALTER TABLE trial ADD COLUMN speed_in_window REAL;
ALTER TABLE trial ADD COLUMN mu_low REAL;
ALTER TABLE trial ADD COLUMN mu_high REAL;
ALTER TABLE trial ADD COLUMN boundary_felt_mm REAL;
ALTER TABLE trial ADD COLUMN boundary_se_mm REAL;
ALTER TABLE trial ADD COLUMN lag_mm REAL;
ALTER TABLE trial ADD COLUMN tare_mN REAL;

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

CREATE TRIGGER signal_is_never_changed BEFORE UPDATE ON signal
  BEGIN SELECT RAISE(ABORT, 'signal is append-only'); END;
CREATE TRIGGER signal_is_never_deleted BEFORE DELETE ON signal
  WHEN NOT EXISTS (SELECT 1 FROM tombstone WHERE session_id = OLD.session_id)
  BEGIN SELECT RAISE(ABORT, 'signal is append-only'); END;
)sql";

// Version 7 stores the checks of the self-test before a session (they belong to an event of the kind
// self_test), and the conditions of a session, such as the temperature of the room.
const char* const kStep7 = R"sql(
ALTER TABLE session ADD COLUMN humidity_percent REAL CHECK (humidity_percent BETWEEN 0 AND 100);
ALTER TABLE session ADD COLUMN room_temperature_C REAL CHECK (room_temperature_C BETWEEN -20 AND 60);
ALTER TABLE session ADD COLUMN surface_cleaned INTEGER CHECK (surface_cleaned IN (0, 1));
ALTER TABLE session ADD COLUMN finger TEXT NOT NULL DEFAULT '';
ALTER TABLE session ADD COLUMN skin_moisture REAL CHECK (skin_moisture >= 0);

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

CREATE TRIGGER self_test_is_never_changed BEFORE UPDATE ON self_test
  BEGIN SELECT RAISE(ABORT, 'self_test is append-only'); END;
CREATE TRIGGER self_test_is_never_deleted BEFORE DELETE ON self_test
  WHEN NOT EXISTS (SELECT 1 FROM tombstone WHERE session_id = OLD.session_id)
  BEGIN SELECT RAISE(ABORT, 'self_test is append-only'); END;
DROP TRIGGER session_keeps_its_provenance;
CREATE TRIGGER session_keeps_its_provenance BEFORE UPDATE OF session_id, participant, protocol_key, protocol_path,
    rig_key, rig_path, calibration_id, run_mode, session_index, sequence_index, seed, language, observer,
    factor_columns, level_unit, software_version, columns_version, kernel, station_id, realtime_rights,
    started_local, consent_version, humidity_percent, room_temperature_C, surface_cleaned, finger, skin_moisture
    ON session
  BEGIN SELECT RAISE(ABORT, 'the provenance of a session is never changed'); END;
)sql";

// Version 8. The answers to questionnaires, consent forms and screenings: each belongs to an event of the
// kind questionnaire. The places in the counterbalancing that a collector has leased to this station, and
// whether the place of a session is one of them. The number of a planned session, and the group of its
// participant. Friction over all strokes of a trial. Friction tables that were measured in a session: the
// levels of a table belong to an event of the kind friction_table. Separate programs that took part in a
// session, and the estimates that they gave: they belong to events of the kinds program and estimates.
const char* const kStep8 = R"sql(
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

CREATE TRIGGER answer_is_never_changed BEFORE UPDATE ON answer
  BEGIN SELECT RAISE(ABORT, 'answer is append-only'); END;
CREATE TRIGGER answer_is_never_deleted BEFORE DELETE ON answer
  WHEN NOT EXISTS (SELECT 1 FROM tombstone WHERE session_id = OLD.session_id)
  BEGIN SELECT RAISE(ABORT, 'answer is append-only'); END;

CREATE TABLE lease (
  protocol_id TEXT NOT NULL,
  sequence_index INTEGER NOT NULL CHECK (sequence_index >= 0),
  PRIMARY KEY (protocol_id, sequence_index)
) STRICT, WITHOUT ROWID;
ALTER TABLE session ADD COLUMN leased_place INTEGER NOT NULL DEFAULT 0 CHECK (leased_place IN (0, 1));
CREATE TRIGGER session_keeps_its_place BEFORE UPDATE OF leased_place ON session
  BEGIN SELECT RAISE(ABORT, 'the provenance of a session is never changed'); END;

ALTER TABLE session ADD COLUMN planned_session INTEGER CHECK (planned_session >= 1);
ALTER TABLE session ADD COLUMN participant_group TEXT NOT NULL DEFAULT '';
CREATE TRIGGER session_keeps_its_plan BEFORE UPDATE OF planned_session, participant_group ON session
  BEGIN SELECT RAISE(ABORT, 'the provenance of a session is never changed'); END;

ALTER TABLE trial ADD COLUMN mu REAL;

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

CREATE TRIGGER friction_level_is_never_changed BEFORE UPDATE ON friction_level
  BEGIN SELECT RAISE(ABORT, 'friction_level is append-only'); END;
CREATE TRIGGER friction_level_is_never_deleted BEFORE DELETE ON friction_level
  WHEN NOT EXISTS (SELECT 1 FROM tombstone WHERE session_id = OLD.session_id)
  BEGIN SELECT RAISE(ABORT, 'friction_level is append-only'); END;

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

CREATE TRIGGER program_is_never_changed BEFORE UPDATE ON program
  BEGIN SELECT RAISE(ABORT, 'program is append-only'); END;
CREATE TRIGGER program_is_never_deleted BEFORE DELETE ON program
  WHEN NOT EXISTS (SELECT 1 FROM tombstone WHERE session_id = OLD.session_id)
  BEGIN SELECT RAISE(ABORT, 'program is append-only'); END;

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

CREATE TRIGGER estimate_is_never_changed BEFORE UPDATE ON estimate
  BEGIN SELECT RAISE(ABORT, 'estimate is append-only'); END;
CREATE TRIGGER estimate_is_never_deleted BEFORE DELETE ON estimate
  WHEN NOT EXISTS (SELECT 1 FROM tombstone WHERE session_id = OLD.session_id)
  BEGIN SELECT RAISE(ABORT, 'estimate is append-only'); END;
)sql";

// Version 9 stores what the pick-up captured in the silence before a trial's first stimulus.
const char* const kStep9 = R"sql(
ALTER TABLE trial ADD COLUMN silence_dB REAL;
ALTER TABLE trial ADD COLUMN silence_tone_dB REAL;
)sql";

}  // namespace

const std::vector<std::string>& schema_steps() {
  static const std::vector<std::string> steps = {
      schema_version_1(), kStep2, kStep3, kStep4, kStep5, kStep6, kStep7, kStep8, kStep9};
  return steps;
}

}  // namespace turnpoint::store

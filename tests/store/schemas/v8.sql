-- The database of version 7 as the step to schema version 8 leaves it. Made by: sqlite3 FILE .dump
PRAGMA foreign_keys=OFF;
BEGIN TRANSACTION;
CREATE TABLE annotation (
  annotation_id TEXT PRIMARY KEY,
  session_id TEXT NOT NULL REFERENCES session (session_id),
  realtime_ns INTEGER NOT NULL,
  text TEXT NOT NULL CHECK (text <> '')
) STRICT, WITHOUT ROWID;
INSERT INTO annotation VALUES('60782ff3-b116-4a89-b475-d81058ffe352','42757583-4cf9-4ac4-8939-36524be1b325',1795239279640764891,'a note');
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
INSERT INTO block VALUES('3d6978d7-9950-4d0f-930a-975c63670829',0,0,0,'main','speed',0);
INSERT INTO block VALUES('42757583-4cf9-4ac4-8939-36524be1b325',0,0,0,'main','speed',0);
CREATE TABLE calibration (calibration_id TEXT PRIMARY KEY, text TEXT NOT NULL) STRICT, WITHOUT ROWID;
CREATE TABLE enrolment (
  station_id TEXT NOT NULL,
  protocol_id TEXT NOT NULL,
  participant TEXT NOT NULL REFERENCES participant (code),
  sequence_index INTEGER NOT NULL CHECK (sequence_index >= 0),
  PRIMARY KEY (station_id, protocol_id, participant),
  UNIQUE (station_id, protocol_id, sequence_index)
) STRICT, WITHOUT ROWID;
INSERT INTO enrolment VALUES('bench-a','two-boundaries','P01',0);
INSERT INTO enrolment VALUES('bench-a','two-boundaries','P02',1);
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
INSERT INTO event VALUES('3d6978d7-9950-4d0f-930a-975c63670829',0,1,3000000000,'presented','',0);
INSERT INTO event VALUES('3d6978d7-9950-4d0f-930a-975c63670829',1,1,3100000000,'answer','1',0);
INSERT INTO event VALUES('3d6978d7-9950-4d0f-930a-975c63670829',2,1,4000000000,'presented','',1);
INSERT INTO event VALUES('3d6978d7-9950-4d0f-930a-975c63670829',3,1,4100000000,'answer','1',1);
INSERT INTO event VALUES('3d6978d7-9950-4d0f-930a-975c63670829',4,1,5000000000,'presented','',2);
INSERT INTO event VALUES('3d6978d7-9950-4d0f-930a-975c63670829',5,1,5100000000,'answer','1',2);
INSERT INTO event VALUES('3d6978d7-9950-4d0f-930a-975c63670829',6,1,6000000000,'presented','',3);
INSERT INTO event VALUES('3d6978d7-9950-4d0f-930a-975c63670829',7,1,6100000000,'answer','1',3);
INSERT INTO event VALUES('3d6978d7-9950-4d0f-930a-975c63670829',8,1,7000000000,'presented','',4);
INSERT INTO event VALUES('3d6978d7-9950-4d0f-930a-975c63670829',9,1,7100000000,'answer','1',4);
INSERT INTO event VALUES('3d6978d7-9950-4d0f-930a-975c63670829',10,1,8000000000,'presented','',5);
INSERT INTO event VALUES('3d6978d7-9950-4d0f-930a-975c63670829',11,1,8100000000,'answer','1',5);
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
CREATE TABLE merged (
  session_id TEXT NOT NULL REFERENCES session (session_id),
  sha256 TEXT NOT NULL,
  source_database_id TEXT NOT NULL,
  realtime_ns INTEGER NOT NULL,
  PRIMARY KEY (session_id, sha256)
) STRICT, WITHOUT ROWID;
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) STRICT, WITHOUT ROWID;
INSERT INTO meta VALUES('database_id','6d85de05-35fe-48a0-b682-577474f96e39');
CREATE TABLE participant (code TEXT PRIMARY KEY CHECK (code <> '')) STRICT, WITHOUT ROWID;
INSERT INTO participant VALUES('P01');
INSERT INTO participant VALUES('P02');
CREATE TABLE protocol (
  protocol_key TEXT PRIMARY KEY,
  protocol_id TEXT NOT NULL,
  version TEXT NOT NULL,
  sha256 TEXT NOT NULL,
  text TEXT NOT NULL,
  canonical TEXT NOT NULL
) STRICT, WITHOUT ROWID;
INSERT INTO protocol VALUES('01e3e5300f5dff2337ed14815bfa3e57d99e4c1b7530f7c365a9d8a3a1faf8d4','two-boundaries','1.2.0','aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa',replace('format = "friction-protocol/1"\n','\n',char(10)),'canonical');
CREATE TABLE rig (
  rig_key TEXT PRIMARY KEY,
  name TEXT NOT NULL,
  sha256 TEXT NOT NULL,
  text TEXT NOT NULL
) STRICT, WITHOUT ROWID;
INSERT INTO rig VALUES('9904941cf6f7ea7786d22492d0437decf363691be49e27adc69c34cad97ae021','plate','bbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbb',replace('format = "friction-rig/1"\n','\n',char(10)));
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
INSERT INTO segment VALUES('3d6978d7-9950-4d0f-930a-975c63670829',1,'boot-1','start',1000000000,2000000000,1709197200000000000);
INSERT INTO segment VALUES('42757583-4cf9-4ac4-8939-36524be1b325',1,'boot-1','start',1000000000,2000000000,1709197200000000000);
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
, humidity_percent REAL CHECK (humidity_percent BETWEEN 0 AND 100), room_temperature_C REAL CHECK (room_temperature_C BETWEEN -20 AND 60), surface_cleaned INTEGER CHECK (surface_cleaned IN (0, 1)), finger TEXT NOT NULL DEFAULT '', skin_moisture REAL CHECK (skin_moisture >= 0), leased_place INTEGER NOT NULL DEFAULT 0 CHECK (leased_place IN (0, 1)), planned_session INTEGER CHECK (planned_session >= 1), participant_group TEXT NOT NULL DEFAULT '') STRICT, WITHOUT ROWID;
INSERT INTO session VALUES('3d6978d7-9950-4d0f-930a-975c63670829','P01','01e3e5300f5dff2337ed14815bfa3e57d99e4c1b7530f7c365a9d8a3a1faf8d4','protocols/two.toml','9904941cf6f7ea7786d22492d0437decf363691be49e27adc69c34cad97ae021','rigs/plate.toml',NULL,'simulated',1,0,20240229,'en','sim:threshold=0.1','["contrast","instruction"]','dB','0.1.0','1','Linux 6.1','bench-a','none','2024-02-29T10:00:00+01:00','c1','completed','',NULL,NULL,NULL,'',NULL,0,NULL,'');
INSERT INTO session VALUES('42757583-4cf9-4ac4-8939-36524be1b325','P02','01e3e5300f5dff2337ed14815bfa3e57d99e4c1b7530f7c365a9d8a3a1faf8d4','protocols/two.toml','9904941cf6f7ea7786d22492d0437decf363691be49e27adc69c34cad97ae021','rigs/plate.toml',NULL,'simulated',1,1,20240229,'en','sim:threshold=0.1','["contrast","instruction"]','dB','0.1.0','1','Linux 6.1','bench-a','none','2024-02-29T10:00:00+01:00','c1','interrupted','power',NULL,NULL,NULL,'',NULL,0,NULL,'');
CREATE TABLE tombstone (
  session_id TEXT PRIMARY KEY CHECK (length(session_id) = 36),
  salt TEXT NOT NULL,
  participant_sha256 TEXT NOT NULL,
  withdrawn_realtime_ns INTEGER NOT NULL
, station_id TEXT NOT NULL DEFAULT '') STRICT, WITHOUT ROWID;
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
  length_frames INTEGER NOT NULL, measured_dB REAL, measured_phase_deg REAL,
  PRIMARY KEY (session_id, trial_index, interval_index, scene_index, tone_index),
  FOREIGN KEY (session_id, trial_index) REFERENCES trial (session_id, trial_index)
) STRICT, WITHOUT ROWID;
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',0,0,0,0,'reference',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',192000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',0,0,0,1,'reference',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',192000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',0,1,0,0,'comparison',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',288000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',0,1,0,1,'comparison',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',288000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',1,0,0,0,'reference',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',192000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',1,0,0,1,'reference',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',192000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',1,1,0,0,'comparison',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',288000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',1,1,0,1,'comparison',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',288000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',2,0,0,0,'reference',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',192000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',2,0,0,1,'reference',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',192000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',2,1,0,0,'comparison',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',288000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',2,1,0,1,'comparison',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',288000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',3,0,0,0,'reference',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',192000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',3,0,0,1,'reference',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',192000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',3,1,0,0,'comparison',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',288000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',3,1,0,1,'comparison',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',288000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',4,0,0,0,'reference',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',192000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',4,0,0,1,'reference',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',192000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',4,1,0,0,'comparison',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',288000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',4,1,0,1,'comparison',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',288000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',5,0,0,0,'reference',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',192000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',5,0,0,1,'reference',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',192000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',5,1,0,0,'comparison',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',288000,96000,NULL,NULL);
INSERT INTO tone VALUES('3d6978d7-9950-4d0f-930a-975c63670829',5,1,0,1,'comparison',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',288000,96000,NULL,NULL);
INSERT INTO tone VALUES('42757583-4cf9-4ac4-8939-36524be1b325',0,0,0,0,'reference',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',192000,96000,NULL,NULL);
INSERT INTO tone VALUES('42757583-4cf9-4ac4-8939-36524be1b325',0,0,0,1,'reference',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',192000,96000,NULL,NULL);
INSERT INTO tone VALUES('42757583-4cf9-4ac4-8939-36524be1b325',0,1,0,0,'comparison',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',288000,96000,NULL,NULL);
INSERT INTO tone VALUES('42757583-4cf9-4ac4-8939-36524be1b325',0,1,0,1,'comparison',150.25,30123.45678901229985,0.75,2.5,0.61999999999999999555,0.0,'mode',0.10000000000000000555,0.4000000000000000222,'cheapest inside the tolerance',288000,96000,NULL,NULL);
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
  recorded_realtime_ns INTEGER NOT NULL, proof TEXT NOT NULL DEFAULT 'unproven'
  CHECK (proof IN ('unproven', 'ok', 'flagged', 'refused', 'stopped', 'lost')), proof_cause TEXT NOT NULL DEFAULT '', drive_ratio_dB REAL, drive_residual_dB REAL, onset_error_us REAL, confidence INTEGER
  CHECK (confidence IS NULL OR (confidence >= 1 AND outcome = 'answered')), confidence_time_s REAL
  CHECK ((confidence_time_s IS NULL) = (confidence IS NULL) AND coalesce(confidence_time_s, 0) >= 0), sensing TEXT NOT NULL DEFAULT ''
  CHECK (sensing IN ('', 'ok', 'strokes', 'light', 'hard', 'slow', 'fast', 'lost', 'wire', 'tare')), contact_s REAL CHECK (contact_s >= 0), strokes INTEGER CHECK (strokes >= 0), normal_N REAL, normal_sd_N REAL, normal_in_window REAL, speed_mm_s REAL, speed_in_window REAL, mu_low REAL, mu_high REAL, boundary_felt_mm REAL, boundary_se_mm REAL, lag_mm REAL, tare_mN REAL, mu REAL,
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
INSERT INTO trial VALUES(1,'3d6978d7-9950-4d0f-930a-975c63670829',1,0,0,0,0,'experimental','staircase',-12.5,'{"contrast":0.30000000000000004,"instruction":"speed"}',150.25,30123.45678901229985,2.5,'first','second',0,'answered',3000000000,2.0,3.5,0.4375,NULL,NULL,'go_cue','simulated',0.0,2.0,0,0,-10.0,1.5,5208.3329999999996287,42.0,-81985529216486896,1795239279633574284,'unproven','',NULL,NULL,NULL,NULL,NULL,'',NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL);
INSERT INTO trial VALUES(2,'3d6978d7-9950-4d0f-930a-975c63670829',1,0,0,1,1,'experimental','staircase',-12.400000000000000355,'{"contrast":0.30000000000000004,"instruction":"speed"}',150.25,30123.45678901229985,2.5,'first','first',1,'answered',4000000000,3.0,3.5,0.43850000000000000088,NULL,NULL,'go_cue','simulated',0.0,2.0,0,0,-10.0,1.5,5208.3329999999996287,42.0,-81985529216486895,1795239279634168197,'unproven','',NULL,NULL,NULL,NULL,NULL,'',NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL);
INSERT INTO trial VALUES(3,'3d6978d7-9950-4d0f-930a-975c63670829',1,0,0,2,2,'experimental','staircase',-12.30000000000000071,'{"contrast":0.30000000000000004,"instruction":"speed"}',150.25,30123.45678901229985,2.5,'first','first',1,'answered',5000000000,4.0,3.5,0.43950000000000000177,NULL,NULL,'go_cue','simulated',0.0,2.0,0,0,-10.0,1.5,5208.3329999999996287,42.0,-81985529216486894,1795239279634751285,'unproven','',NULL,NULL,NULL,NULL,NULL,'',NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL);
INSERT INTO trial VALUES(4,'3d6978d7-9950-4d0f-930a-975c63670829',1,0,0,3,3,'experimental','staircase',-12.199999999999999289,'{"contrast":0.30000000000000004,"instruction":"speed"}',150.25,30123.45678901229985,2.5,'first','second',0,'answered',6000000000,5.0,3.5,0.44050000000000000266,NULL,NULL,'go_cue','simulated',0.0,2.0,0,0,-10.0,1.5,5208.3329999999996287,42.0,-81985529216486893,1795239279635326611,'unproven','',NULL,NULL,NULL,NULL,NULL,'',NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL);
INSERT INTO trial VALUES(5,'3d6978d7-9950-4d0f-930a-975c63670829',1,0,0,4,4,'experimental','staircase',-12.099999999999999644,'{"contrast":0.30000000000000004,"instruction":"speed"}',150.25,30123.45678901229985,2.5,'first',NULL,NULL,'timeout',7000000000,6.0,3.5,NULL,NULL,NULL,'go_cue',NULL,0.0,2.0,0,0,-10.0,1.5,5208.3329999999996287,42.0,-81985529216486892,1795239279635947614,'unproven','',NULL,NULL,NULL,NULL,NULL,'',NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL);
INSERT INTO trial VALUES(6,'3d6978d7-9950-4d0f-930a-975c63670829',1,0,0,5,5,'experimental','staircase',-12.0,'{"contrast":0.30000000000000004,"instruction":"speed"}',150.25,30123.45678901229985,2.5,'first','first',1,'answered',8000000000,7.0,3.5,0.44250000000000000444,NULL,NULL,'go_cue','simulated',0.0,2.0,0,0,-10.0,1.5,5208.3329999999996287,42.0,-81985529216486891,1795239279636542830,'unproven','',NULL,NULL,NULL,NULL,NULL,'',NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL);
INSERT INTO trial VALUES(7,'42757583-4cf9-4ac4-8939-36524be1b325',1,0,0,0,0,'experimental','staircase',-12.5,'{"contrast":0.30000000000000004,"instruction":"speed"}',150.25,30123.45678901229985,2.5,'first','second',0,'answered',3000000000,2.0,3.5,0.4375,NULL,NULL,'go_cue','simulated',0.0,2.0,0,0,-10.0,1.5,5208.3329999999996287,42.0,-81985529216486896,1795239279640361711,'unproven','',NULL,NULL,NULL,NULL,NULL,'',NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL);
CREATE TABLE unsealed (session_id TEXT PRIMARY KEY REFERENCES session (session_id)) STRICT, WITHOUT ROWID;
INSERT INTO unsealed VALUES('3d6978d7-9950-4d0f-930a-975c63670829');
INSERT INTO unsealed VALUES('42757583-4cf9-4ac4-8939-36524be1b325');
CREATE TABLE same_person (
  station_a TEXT NOT NULL,
  code_a TEXT NOT NULL,
  station_b TEXT NOT NULL,
  code_b TEXT NOT NULL,
  realtime_ns INTEGER NOT NULL,
  PRIMARY KEY (station_a, code_a, station_b, code_b),
  CHECK (station_a <> station_b OR code_a <> code_b)
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
CREATE TABLE lease (
  protocol_id TEXT NOT NULL,
  sequence_index INTEGER NOT NULL CHECK (sequence_index >= 0),
  PRIMARY KEY (protocol_id, sequence_index)
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
CREATE TRIGGER trial_is_never_changed BEFORE UPDATE ON trial
  BEGIN SELECT RAISE(ABORT, 'trial is append-only'); END;
CREATE TRIGGER tone_is_never_changed BEFORE UPDATE ON tone
  BEGIN SELECT RAISE(ABORT, 'tone is append-only'); END;
CREATE TRIGGER event_is_never_changed BEFORE UPDATE ON event
  BEGIN SELECT RAISE(ABORT, 'event is append-only'); END;
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
CREATE TRIGGER link_is_never_changed BEFORE UPDATE ON link
  BEGIN SELECT RAISE(ABORT, 'link is append-only'); END;
CREATE TRIGGER link_is_never_deleted BEFORE DELETE ON link
  WHEN NOT EXISTS (SELECT 1 FROM tombstone WHERE session_id = OLD.session_id)
  BEGIN SELECT RAISE(ABORT, 'link is append-only'); END;
CREATE TRIGGER signal_is_never_changed BEFORE UPDATE ON signal
  BEGIN SELECT RAISE(ABORT, 'signal is append-only'); END;
CREATE TRIGGER signal_is_never_deleted BEFORE DELETE ON signal
  WHEN NOT EXISTS (SELECT 1 FROM tombstone WHERE session_id = OLD.session_id)
  BEGIN SELECT RAISE(ABORT, 'signal is append-only'); END;
CREATE TRIGGER self_test_is_never_changed BEFORE UPDATE ON self_test
  BEGIN SELECT RAISE(ABORT, 'self_test is append-only'); END;
CREATE TRIGGER self_test_is_never_deleted BEFORE DELETE ON self_test
  WHEN NOT EXISTS (SELECT 1 FROM tombstone WHERE session_id = OLD.session_id)
  BEGIN SELECT RAISE(ABORT, 'self_test is append-only'); END;
CREATE TRIGGER session_keeps_its_provenance BEFORE UPDATE OF session_id, participant, protocol_key, protocol_path,
    rig_key, rig_path, calibration_id, run_mode, session_index, sequence_index, seed, language, observer,
    factor_columns, level_unit, software_version, columns_version, kernel, station_id, realtime_rights,
    started_local, consent_version, humidity_percent, room_temperature_C, surface_cleaned, finger, skin_moisture
    ON session
  BEGIN SELECT RAISE(ABORT, 'the provenance of a session is never changed'); END;
CREATE TRIGGER answer_is_never_changed BEFORE UPDATE ON answer
  BEGIN SELECT RAISE(ABORT, 'answer is append-only'); END;
CREATE TRIGGER answer_is_never_deleted BEFORE DELETE ON answer
  WHEN NOT EXISTS (SELECT 1 FROM tombstone WHERE session_id = OLD.session_id)
  BEGIN SELECT RAISE(ABORT, 'answer is append-only'); END;
CREATE TRIGGER session_keeps_its_place BEFORE UPDATE OF leased_place ON session
  BEGIN SELECT RAISE(ABORT, 'the provenance of a session is never changed'); END;
CREATE TRIGGER session_keeps_its_plan BEFORE UPDATE OF planned_session, participant_group ON session
  BEGIN SELECT RAISE(ABORT, 'the provenance of a session is never changed'); END;
CREATE TRIGGER friction_level_is_never_changed BEFORE UPDATE ON friction_level
  BEGIN SELECT RAISE(ABORT, 'friction_level is append-only'); END;
CREATE TRIGGER friction_level_is_never_deleted BEFORE DELETE ON friction_level
  WHEN NOT EXISTS (SELECT 1 FROM tombstone WHERE session_id = OLD.session_id)
  BEGIN SELECT RAISE(ABORT, 'friction_level is append-only'); END;
CREATE TRIGGER program_is_never_changed BEFORE UPDATE ON program
  BEGIN SELECT RAISE(ABORT, 'program is append-only'); END;
CREATE TRIGGER program_is_never_deleted BEFORE DELETE ON program
  WHEN NOT EXISTS (SELECT 1 FROM tombstone WHERE session_id = OLD.session_id)
  BEGIN SELECT RAISE(ABORT, 'program is append-only'); END;
CREATE TRIGGER estimate_is_never_changed BEFORE UPDATE ON estimate
  BEGIN SELECT RAISE(ABORT, 'estimate is append-only'); END;
CREATE TRIGGER estimate_is_never_deleted BEFORE DELETE ON estimate
  WHEN NOT EXISTS (SELECT 1 FROM tombstone WHERE session_id = OLD.session_id)
  BEGIN SELECT RAISE(ABORT, 'estimate is append-only'); END;
COMMIT;

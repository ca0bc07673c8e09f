-- A session with checksums of encoding 5, as the last release with schema 8 wrote it. Made by: sqlite3 FILE .dump
PRAGMA foreign_keys=OFF;
BEGIN TRANSACTION;
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) STRICT, WITHOUT ROWID;
INSERT INTO meta VALUES('database_id','3b221f46-0299-4d42-a513-c00cebe2b8a1');
CREATE TABLE participant (code TEXT PRIMARY KEY CHECK (code <> '')) STRICT, WITHOUT ROWID;
INSERT INTO participant VALUES('P01');
CREATE TABLE enrolment (
  station_id TEXT NOT NULL,
  protocol_id TEXT NOT NULL,
  participant TEXT NOT NULL REFERENCES participant (code),
  sequence_index INTEGER NOT NULL CHECK (sequence_index >= 0),
  PRIMARY KEY (station_id, protocol_id, participant),
  UNIQUE (station_id, protocol_id, sequence_index)
) STRICT, WITHOUT ROWID;
INSERT INTO enrolment VALUES('bench-a','live','P01',0);
CREATE TABLE protocol (
  protocol_key TEXT PRIMARY KEY,
  protocol_id TEXT NOT NULL,
  version TEXT NOT NULL,
  sha256 TEXT NOT NULL,
  text TEXT NOT NULL,
  canonical TEXT NOT NULL
) STRICT, WITHOUT ROWID;
INSERT INTO protocol VALUES('9950ef52978be6b9fffde9e6baacc64c14505180237a99d526ce6c5c4f2723af','live','1.0.0','22a18208d265c44ebdf3bc9f434e43b48f27c81825afeeb6c08d6d332195c31e',replace('# A protocol with four quick trials, for the test that taps through a whole session.\nformat = "friction-protocol/1"\n\n[protocol]\nid = "live"\nversion = "1.0.0"\ntitle = "Four quick trials"\nlanguages = ["en", "de"]\n\n[random]\nseed = 7\n\n[[factor]]\nname = "offset_mm"\nrange = [-24.0, 24.0]\n\n[[factor]]\nname = "mark_mm"\nlevels = [160.0]\n\n[scene.edge]\nboundary_mm = "mark_mm + offset_mm"\nedge = "p50"\ndisplacement_um = 1.0\nramp_ms = 20\ntolerance = { boundary_mm = 0.5 }\n\n[task]\nkind = "single-interval"\nintervals = ["edge"]\ndevice = "touch"\nquestion = { en = "Left or right of the mark?", de = "Links oder rechts der Marke?" }\nchoices = [\n  { id = "left",  label = { en = "Left", de = "Links" } },\n  { id = "right", label = { en = "Right", de = "Rechts" } },\n]\ncorrect = { left = "offset_mm < 0", right = "offset_mm > 0" }\n\n[timing]\nresponse_zero = "go_cue"\nexplore_s = 2.0\ndeadline_s = 3.0\niti_s = { uniform = [0.1, 0.2] }\nanticipation_s = 0.05\n\n[[procedure]]\nname = "levels"\nkind = "constant-stimuli"\nlevel = "offset_mm"\nvalues = [-20.0, 20.0]\nrepeats = 2\n\n[[block]]\nname = "main"\nprocedures = ["levels"]\nfeedback = "trial"\nbreak_after = { trials = 2, min_s = 1 }\n','\n',char(10)),'{"block":[{"break_after":{"min_s":1,"trials":2},"feedback":"trial","name":"main","procedures":["levels"]}],"factor":[{"name":"offset_mm","range":[-24,24]},{"levels":[160],"name":"mark_mm"}],"format":"friction-protocol/1","procedure":[{"kind":"constant-stimuli","level":"offset_mm","name":"levels","repeats":2,"values":[-20,20]}],"protocol":{"id":"live","languages":["en","de"],"title":"Four quick trials","version":"1.0.0"},"random":{"seed":7},"scene":{"edge":{"boundary_mm":"mark_mm + offset_mm","displacement_um":1,"edge":"p50","ramp_ms":20,"tolerance":{"boundary_mm":0.5}}},"task":{"choices":[{"id":"left","label":{"de":"Links","en":"Left"}},{"id":"right","label":{"de":"Rechts","en":"Right"}}],"correct":{"left":"offset_mm < 0","right":"offset_mm > 0"},"device":"touch","intervals":["edge"],"kind":"single-interval","question":{"de":"Links oder rechts der Marke?","en":"Left or right of the mark?"}},"timing":{"anticipation_s":0.05,"deadline_s":3,"explore_s":2,"iti_s":{"uniform":[0.1,0.2]},"response_zero":"go_cue"}}');
CREATE TABLE rig (
  rig_key TEXT PRIMARY KEY,
  name TEXT NOT NULL,
  sha256 TEXT NOT NULL,
  text TEXT NOT NULL
) STRICT, WITHOUT ROWID;
INSERT INTO rig VALUES('103460849bac50c3bc9d3d61186f05b4189433af9736e6242dc16e2ee7e8f910','Aluminium tapered plate, simulated','fd28e4717673cda168c6d0b20240681b34ccddb20e5627c55a4de74e50f402ba',replace('# A rig of the tests: the simulated rig''s hardware with a plate of 2 mm, by the theory of thin plates. A plan by\n# this theory takes a tenth of the time, so that tests of whole sessions are quick.\nformat = "friction-rig/1"\nname = "Aluminium tapered plate, simulated"\n\n[surface]\nmaterial = "aluminium"\ndensity_kg_m3 = 2700\nmodulus_GPa = 69\npoisson = 0.33\ntension_Pa = 0                # no tension: a plate, stiff only because of its bending stiffness\nthickness_mm = 2.0\nlength_mm = 300\nquality_factor = 60\nedges = "clamped"\n# Standard deviations of uncertain values. Thickness: half of the tolerance of cold-rolled sheet, +-0.09 mm\n# (EN 485-4, alloys such as 6082). Modulus and density: spread of handbook values over the 5000 and 6000 series,\n# including Poisson''s ratio. Temperature: typical difference between a room and the place of measurement.\nthickness_sd_mm = 0.045\nmodulus_sd_GPa = 1.0\ndensity_sd_kg_m3 = 20\ntemperature_sd_K = 3\n\n[surface.taper]\nhalf_width_mm = 14\nslope = 0.03\n# Half-width and slope: a workshop mills both ends to +-0.1 mm. The plate is really held a fraction of its\n# thickness behind the clamp''s edge; only measured boundaries show how far (`turnpoint calibrate`).\nhalf_width_sd_mm = 0.05\nslope_sd = 0.0002\nclamp_line_sd_mm = 0.2\n\n[[transducer]]\nname = "main"\nchannel = 0\nband_kHz = [14, 60]\num_per_full_scale = 4.0\n\n[output]\nuri = "null:"\nrate_Hz = 192000\n\n[amplifier]\nuri = "sim:"\n\n[buttons]\nuri = "sim:"\n\n[contact]\nuri = "sim:"\n\n[touch]\nuri = "sim:"\n\n[friction]\nmodel = "load-sharing"        # illustrative: a live session needs a measured table\npressure_kPa = 5\nfloor = 0.1\nfingertip_mm = 10\n\n# Mechanical impedance of a fingertip: near 55 N s/m at ultrasonic frequencies, higher or lower in some people\n# (J. Monnoyer, E. Diaz, C. Bourdin, M. Wiertlewski, World Haptics 2017); mostly viscous (M. Wiertlewski, J. E.\n# Colgate, IEEE Trans. Haptics 8 (2015) 36), with a phase that varies (R. Friesen and others, Haptics Symposium\n# 2016). The standard deviations are assumptions until your participants have been measured.\n[finger]\nimpedance_Ns_per_m = 55\nimpedance_sd_Ns_per_m = 15\nphase_deg = 0\nphase_sd_deg = 20\ncontact_mm = 8                # diameter of the contact\n\n[limits]\ndisplacement_um = 8.0\ncontinuous_s = 30\nduty = 0.8\nsession_minutes = 60\n','\n',char(10)));
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
, humidity_percent REAL CHECK (humidity_percent BETWEEN 0 AND 100), room_temperature_C REAL CHECK (room_temperature_C BETWEEN -20 AND 60), surface_cleaned INTEGER CHECK (surface_cleaned IN (0, 1)), finger TEXT NOT NULL DEFAULT '', skin_moisture REAL CHECK (skin_moisture >= 0), leased_place INTEGER NOT NULL DEFAULT 0 CHECK (leased_place IN (0, 1)), planned_session INTEGER CHECK (planned_session >= 1), participant_group TEXT NOT NULL DEFAULT '') STRICT, WITHOUT ROWID;
INSERT INTO session VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2','P01','9950ef52978be6b9fffde9e6baacc64c14505180237a99d526ce6c5c4f2723af','live.toml','103460849bac50c3bc9d3d61186f05b4189433af9736e6242dc16e2ee7e8f910','plate.toml',NULL,'simulated',1,0,7,'en','sim','["offset_mm","mark_mm"]','mm','0.1.0','1','Linux 6.18.44-fc-v657 x86_64','bench-a','none asked (synchronous)','2026-11-26T17:15:59+0000','','completed','',NULL,NULL,NULL,'',NULL,0,NULL,'');
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
INSERT INTO segment VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',1,'1cbdcd71-1e62-4c8f-a487-ea4edf618ee4','start',0,67495989982511,1795713359028139533);
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
INSERT INTO block VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',0,0,0,'main','',0);
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
INSERT INTO trial VALUES(1,'12f77a61-bb2b-4857-9bef-4247d4b2d1e2',1,0,0,0,0,'experimental','levels',-20.0,'{"mark_mm":160.0,"offset_mm":-20.0}',140.0,27847.083456000000297,1.0000000003634537115,'left','left',1,'answered',1800000000,1.8000000000000000444,2.9390302130000001135,1.1717145420000001365,NULL,NULL,'go_cue','simulated',0.0,3.0,0,0,NULL,NULL,5208.3333333333330303,0.0,4345914388884513248,1795713359086232081,'unproven','',NULL,NULL,NULL,NULL,NULL,'',NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL);
INSERT INTO trial VALUES(2,'12f77a61-bb2b-4857-9bef-4247d4b2d1e2',1,0,0,1,1,'experimental','levels',20.0,'{"mark_mm":160.0,"offset_mm":20.0}',180.0,36160.544844999996712,0.99999999938748951322,'right','right',1,'answered',4739031250,4.7390312500000000284,2.655710782000000325,0.9065165270000000719,NULL,NULL,'go_cue','simulated',0.0,3.0,0,0,NULL,NULL,5208.3333333333330303,0.0,3706643327176158563,1795713359088574628,'unproven','',NULL,NULL,NULL,NULL,NULL,'',NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL);
INSERT INTO trial VALUES(3,'12f77a61-bb2b-4857-9bef-4247d4b2d1e2',1,0,0,2,2,'experimental','levels',-20.0,'{"mark_mm":160.0,"offset_mm":-20.0}',140.0,27847.083456000000297,1.0000000003634537115,'left','right',0,'answered',9394739583,9.3947395829999997829,2.7085104630000000902,0.98629941000000009854,NULL,NULL,'go_cue','simulated',0.0,3.0,0,0,NULL,NULL,5208.3333333333330303,0.0,6685054749208150834,1795713359089497934,'unproven','',NULL,NULL,NULL,NULL,NULL,'',NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL);
INSERT INTO trial VALUES(4,'12f77a61-bb2b-4857-9bef-4247d4b2d1e2',1,0,0,3,3,'experimental','levels',20.0,'{"mark_mm":160.0,"offset_mm":20.0}',180.0,36160.544844999996712,0.99999999938748951322,'right','right',1,'answered',12103250000,12.103250000000000952,2.6202541169999999937,0.8239411310000001043,NULL,NULL,'go_cue','simulated',0.0,3.0,0,0,NULL,NULL,5208.3333333333330303,0.0,5402168577626840586,1795713359090340505,'unproven','',NULL,NULL,NULL,NULL,NULL,'',NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL);
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
INSERT INTO tone VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',0,0,0,0,'edge',140.0,27847.083456000000297,0.6767081349999999329,1.0000000003634537115,0.3493493884719244269,0.0,'edge',0.013299221988300075417,7.9589536893030965458,'edge: boundary bound 0.0133 mm within 0.5 mm',345600,384000,NULL,NULL);
INSERT INTO tone VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',1,0,0,0,'edge',180.0,36160.544844999996712,0.74656795399999997808,0.99999999938748951322,0.35390322051572603578,0.0,'edge',0.011929599151096384468,7.7713799568251937799,'edge: boundary bound 0.0119 mm within 0.5 mm',909894,384000,NULL,NULL);
INSERT INTO tone VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',2,0,0,0,'edge',140.0,27847.083456000000297,0.6767081349999999329,1.0000000003634537115,0.3493493884719244269,0.0,'edge',0.013299221988300075417,7.9589536893030965458,'edge: boundary bound 0.0133 mm within 0.5 mm',1803790,384000,NULL,NULL);
INSERT INTO tone VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',3,0,0,0,'edge',180.0,36160.544844999996712,0.74656795399999997808,0.99999999938748951322,0.35390322051572603578,0.0,'edge',0.011929599151096384468,7.7713799568251937799,'edge: boundary bound 0.0119 mm within 0.5 mm',2323824,384000,NULL,NULL);
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
INSERT INTO event VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',0,1,1000000000,'next','0',0);
INSERT INTO event VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',1,1,1000000000,'presented','',0);
INSERT INTO event VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',2,1,2971714542,'answer','0',0);
INSERT INTO event VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',3,1,1800000000,'stimulus','1.19971354',0);
INSERT INTO event VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',4,1,3939030213,'presented','',1);
INSERT INTO event VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',5,1,5645547777,'answer','1',1);
INSERT INTO event VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',6,1,4739031250,'stimulus','0.934515625',1);
INSERT INTO event VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',7,1,8594740995,'next','0',2);
INSERT INTO event VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',8,1,8594740995,'presented','',2);
INSERT INTO event VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',9,1,10381038993,'answer','1',2);
INSERT INTO event VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',10,1,9394739583,'stimulus','1.01429688',2);
INSERT INTO event VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',11,1,11303251458,'presented','',3);
INSERT INTO event VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',12,1,12927191131,'answer','1',3);
INSERT INTO event VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',13,1,12103250000,'stimulus','0.851942708',3);
CREATE TABLE annotation (
  annotation_id TEXT PRIMARY KEY,
  session_id TEXT NOT NULL REFERENCES session (session_id),
  realtime_ns INTEGER NOT NULL,
  text TEXT NOT NULL CHECK (text <> '')
) STRICT, WITHOUT ROWID;
CREATE TABLE tombstone (
  session_id TEXT PRIMARY KEY CHECK (length(session_id) = 36),
  salt TEXT NOT NULL,
  participant_sha256 TEXT NOT NULL,
  withdrawn_realtime_ns INTEGER NOT NULL
, station_id TEXT NOT NULL DEFAULT '') STRICT, WITHOUT ROWID;
CREATE TABLE merged (
  session_id TEXT NOT NULL REFERENCES session (session_id),
  sha256 TEXT NOT NULL,
  source_database_id TEXT NOT NULL,
  realtime_ns INTEGER NOT NULL,
  PRIMARY KEY (session_id, sha256)
) STRICT, WITHOUT ROWID;
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
INSERT INTO link VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',0,5,1,-1,-1,-1,'running','','324fe8f4abd4cfffd0c0df780f2c0669661ea13a9f5fbf6e0df4d7dcf3386f69');
INSERT INTO link VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',1,5,1,0,-1,-1,'running','','ade3e080cb4913682d4832eeb1030bb8fe94b2f305347eedf2f86f25ae423aea');
INSERT INTO link VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',2,5,1,0,-1,1,'running','','3f2e1052e1dd08d3ba094eecf0e0b2b0d474a5e0c5219f9fb6c3f4ca6de15049');
INSERT INTO link VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',3,5,1,0,0,3,'running','','ea34b12ef9bbdebc8df1db6dc9f87835b55b13dfb8aaba9c0588f25433503415');
INSERT INTO link VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',4,5,1,0,0,4,'running','','5fc63aec7f10b37469ae352a8b0b54f5734642062e21c64c5d8443b8a893e6d7');
INSERT INTO link VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',5,5,1,0,1,6,'running','','1e6600a02731f05eb53119012697e3afac7d3f233ff153d67274cfe7ed035314');
INSERT INTO link VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',6,5,1,0,1,8,'running','','dc34eac12d2096ae25e09d1149b8f7e07742fc43736116632b3aa48efffdd973');
INSERT INTO link VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',7,5,1,0,2,10,'running','','621cbeb76f64f5da344a6ba8774ffbd578d8bbaf8863c57e151f77a8b0bcaaae');
INSERT INTO link VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',8,5,1,0,2,11,'running','','ac7b4dad45db9a9e3f748d7095509a018c35e5cbba9cdc79c8602552a98c2dbf');
INSERT INTO link VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',9,5,1,0,3,13,'running','','986fb6f16f23d06bed48578ffe71149f9948fec95aeb114573ab337a9e4eb0e0');
INSERT INTO link VALUES('12f77a61-bb2b-4857-9bef-4247d4b2d1e2',10,5,1,0,3,13,'completed','','f93d59e821f48333e3a400a1111cf3f0a416eb66b9640ff1ad32eb8d2cc29dd6');
CREATE TABLE unsealed (session_id TEXT PRIMARY KEY REFERENCES session (session_id)) STRICT, WITHOUT ROWID;
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

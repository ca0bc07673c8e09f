-- Sessions with checksums of encoding 4, as the last release with schema 7 wrote them. Made by: sqlite3 FILE .dump
PRAGMA foreign_keys=OFF;
BEGIN TRANSACTION;
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) STRICT, WITHOUT ROWID;
INSERT INTO meta VALUES('database_id','32beee44-4e1a-4520-85cc-99e8ce8361d5');
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
INSERT INTO enrolment VALUES('vm','live','P01',0);
CREATE TABLE protocol (
  protocol_key TEXT PRIMARY KEY,
  protocol_id TEXT NOT NULL,
  version TEXT NOT NULL,
  sha256 TEXT NOT NULL,
  text TEXT NOT NULL,
  canonical TEXT NOT NULL
) STRICT, WITHOUT ROWID;
INSERT INTO protocol VALUES('816f09fafbb20510042906e9f5e76ee13fc6b107f87782626b38865917fd5a43','live','1.0.0','946c7a42293b1167bbe86a98a3ddf54d4fc4aa4b7274029e5abe9e3b4de1f258',replace('format = "friction-protocol/1"\n[protocol]\nid = "live"\nversion = "1.0.0"\ntitle = "Two quick trials"\nlanguages = ["en"]\n[random]\nseed = 7\n[[factor]]\nname = "offset_mm"\nrange = [-24.0, 24.0]\n[scene.edge]\nboundary_mm = "160 + offset_mm"\nedge = "p50"\ndisplacement_um = 1.0\nramp_ms = 20\ntolerance = { boundary_mm = 0.5 }\n[task]\nkind = "single-interval"\nintervals = ["edge"]\ndevice = "touch"\nquestion = { en = "Left or right?" }\nchoices = [{ id = "left", label = { en = "Left" } }, { id = "right", label = { en = "Right" } }]\ncorrect = { left = "offset_mm < 0", right = "offset_mm > 0" }\n[timing]\nresponse_zero = "go_cue"\nexplore_s = 2.0\ndeadline_s = 3.0\niti_s = { uniform = [0.1, 0.2] }\nanticipation_s = 0.0\n[[procedure]]\nname = "levels"\nkind = "constant-stimuli"\nlevel = "offset_mm"\nvalues = [-20.0, 20.0]\nrepeats = 2\n[[block]]\nname = "main"\nprocedures = ["levels"]\n\n','\n',char(10)),'{"block":[{"name":"main","procedures":["levels"]}],"factor":[{"name":"offset_mm","range":[-24,24]}],"format":"friction-protocol/1","procedure":[{"kind":"constant-stimuli","level":"offset_mm","name":"levels","repeats":2,"values":[-20,20]}],"protocol":{"id":"live","languages":["en"],"title":"Two quick trials","version":"1.0.0"},"random":{"seed":7},"scene":{"edge":{"boundary_mm":"160 + offset_mm","displacement_um":1,"edge":"p50","ramp_ms":20,"tolerance":{"boundary_mm":0.5}}},"task":{"choices":[{"id":"left","label":{"en":"Left"}},{"id":"right","label":{"en":"Right"}}],"correct":{"left":"offset_mm < 0","right":"offset_mm > 0"},"device":"touch","intervals":["edge"],"kind":"single-interval","question":{"en":"Left or right?"}},"timing":{"anticipation_s":0,"deadline_s":3,"explore_s":2,"iti_s":{"uniform":[0.1,0.2]},"response_zero":"go_cue"}}');
CREATE TABLE rig (
  rig_key TEXT PRIMARY KEY,
  name TEXT NOT NULL,
  sha256 TEXT NOT NULL,
  text TEXT NOT NULL
) STRICT, WITHOUT ROWID;
INSERT INTO rig VALUES('2243cdeb6623a22efe050540c7ff2dde65695dadb6718dc0adb2d79dc7f484a6','Aluminium tapered plate, simulated','2d067689c7fe86ec5d355b788389dcb8c2b318c7a39c4550e4120496bfb0019b',replace('# A rig of the tests: the simulated rig''s hardware with a plate of 2 mm, by the theory of thin plates. A plan by\n# this theory takes a tenth of the time, so that tests of whole sessions are quick.\nformat = "friction-rig/1"\nname = "Aluminium tapered plate, simulated"\n\n[surface]\nmaterial = "aluminium"\ndensity_kg_m3 = 2700\nmodulus_GPa = 69\npoisson = 0.33\ntension_Pa = 0                # no tension: a plate, stiff only because of its bending stiffness\nthickness_mm = 2.0\nlength_mm = 300\nquality_factor = 60\nedges = "clamped"\n# Standard deviations of uncertain values. Thickness: half of the tolerance of cold-rolled sheet, +-0.09 mm\n# (EN 485-4, alloys such as 6082). Modulus and density: spread of handbook values over the 5000 and 6000 series,\n# including Poisson''s ratio. Temperature: typical difference between a room and the place of measurement.\nthickness_sd_mm = 0.045\nmodulus_sd_GPa = 1.0\ndensity_sd_kg_m3 = 20\ntemperature_sd_K = 3\n\n[surface.taper]\nhalf_width_mm = 14\nslope = 0.03\n# Half-width and slope: a workshop mills both ends to +-0.1 mm. The plate is really held a fraction of its\n# thickness behind the clamp''s edge; only measured boundaries show how far (`turnpoint calibrate`).\nhalf_width_sd_mm = 0.05\nslope_sd = 0.0002\nclamp_line_sd_mm = 0.2\n\n[[transducer]]\nname = "main"\nchannel = 0\nband_kHz = [14, 60]\num_per_full_scale = 4.0\n\n[output]\nuri = "null:"\nrate_Hz = 192000\n\n[amplifier]\nuri = "sim:"\n\n[buttons]\nuri = "sim:"\n\n[contact]\nuri = "sim:"\n\n[touch]\nuri = "sim:"\n\n[friction]\nmodel = "load-sharing"        # illustrative: a live session needs a measured table\npressure_kPa = 5\nfloor = 0.1\nfingertip_mm = 10\n\n# Mechanical impedance of a fingertip: near 55 N s/m at ultrasonic frequencies, higher or lower in some people\n# (J. Monnoyer, E. Diaz, C. Bourdin, M. Wiertlewski, World Haptics 2017); mostly viscous (M. Wiertlewski, J. E.\n# Colgate, IEEE Trans. Haptics 8 (2015) 36), with a phase that varies (R. Friesen and others, Haptics Symposium\n# 2016). The standard deviations are assumptions until your participants have been measured.\n[finger]\nimpedance_Ns_per_m = 55\nimpedance_sd_Ns_per_m = 15\nphase_deg = 0\nphase_sd_deg = 20\ncontact_mm = 8                # diameter of the contact\n\n[limits]\ndisplacement_um = 8.0\ncontinuous_s = 30\nduty = 0.8\nsession_minutes = 60\n\n','\n',char(10)));
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
, humidity_percent REAL CHECK (humidity_percent BETWEEN 0 AND 100), room_temperature_C REAL CHECK (room_temperature_C BETWEEN -20 AND 60), surface_cleaned INTEGER CHECK (surface_cleaned IN (0, 1)), finger TEXT NOT NULL DEFAULT '', skin_moisture REAL CHECK (skin_moisture >= 0)) STRICT, WITHOUT ROWID;
INSERT INTO session VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e','P01','816f09fafbb20510042906e9f5e76ee13fc6b107f87782626b38865917fd5a43','tiny.toml','2243cdeb6623a22efe050540c7ff2dde65695dadb6718dc0adb2d79dc7f484a6','simulated.toml',NULL,'simulated',1,0,1,'en','sim','["offset_mm"]','mm','0.1.0','1','Linux 6.18.44-fc-v657 x86_64','vm','none asked (synchronous)','2026-11-24T17:11:47+0000','','completed','',NULL,NULL,NULL,'',NULL);
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
INSERT INTO segment VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',1,'1d5eecf2-2b2a-412e-9042-b869015ab449','start',0,3759262452396,1795540307815340598);
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
INSERT INTO block VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',0,0,0,'main','',0);
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
  CHECK (sensing IN ('', 'ok', 'strokes', 'light', 'hard', 'slow', 'fast', 'lost', 'wire', 'tare')), contact_s REAL CHECK (contact_s >= 0), strokes INTEGER CHECK (strokes >= 0), normal_N REAL, normal_sd_N REAL, normal_in_window REAL, speed_mm_s REAL, speed_in_window REAL, mu_low REAL, mu_high REAL, boundary_felt_mm REAL, boundary_se_mm REAL, lag_mm REAL, tare_mN REAL,
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
INSERT INTO trial VALUES(1,'29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',1,0,0,0,0,'experimental','levels',20.0,'{"offset_mm":20.0}',180.0,36160.544844999996712,0.99999999938748951322,'right','right',1,'answered',1800000000,1.8000000000000000444,2.1005489239999999284,1.1875532410000000371,NULL,NULL,'go_cue','simulated',0.0,3.0,0,0,NULL,NULL,5208.3333333333330303,0.0,8751876516916950997,1795540307925035978,'unproven','',NULL,NULL,NULL,NULL,NULL,'',NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL);
INSERT INTO trial VALUES(2,'29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',1,0,0,1,1,'experimental','levels',-20.0,'{"offset_mm":-20.0}',140.0,27847.083456000000297,1.0000000003634537115,'left','left',1,'answered',3900546875,3.9005468750000003019,2.0224068029999999751,1.0507169030000000908,NULL,NULL,'go_cue','simulated',0.0,3.0,0,0,NULL,NULL,5208.3333333333330303,0.0,4062627861529075752,1795540307932996961,'unproven','',NULL,NULL,NULL,NULL,NULL,'',NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL);
INSERT INTO trial VALUES(3,'29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',1,0,0,2,2,'experimental','levels',20.0,'{"offset_mm":20.0}',180.0,36160.544844999996712,0.99999999938748951322,'right','right',1,'answered',5922953125,5.9229531250000002629,1.6722840560000000742,0.7249321720000000413,NULL,NULL,'go_cue','simulated',0.0,3.0,0,0,NULL,NULL,5208.3333333333330303,0.0,4345182330006763810,1795540307941001260,'unproven','',NULL,NULL,NULL,NULL,NULL,'',NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL);
INSERT INTO trial VALUES(4,'29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',1,0,0,3,3,'experimental','levels',-20.0,'{"offset_mm":-20.0}',140.0,27847.083456000000297,1.0000000003634537115,'left','left',1,'answered',7595239583,7.5952395830000005716,1.6327118580000001824,0.68724789299999999858,NULL,NULL,'go_cue','simulated',0.0,3.0,0,0,NULL,NULL,5208.3333333333330303,0.0,4508497742708451271,1795540307948986600,'unproven','',NULL,NULL,NULL,NULL,NULL,'',NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL,NULL);
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
INSERT INTO tone VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',0,0,0,0,'edge',180.0,36160.544844999996712,0.74656795399999997808,0.99999999938748951322,0.35390322051572603578,0.0,'edge',0.012848462551491364458,7.7713799568251937799,'edge: boundary bound 0.0128 mm within 0.5 mm',345600,384000,NULL,NULL);
INSERT INTO tone VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',1,0,0,0,'edge',140.0,27847.083456000000297,0.6767081349999999329,1.0000000003634537115,0.3493493884719244269,0.0,'edge',0.014641271283980039977,7.9589536893030965458,'edge: boundary bound 0.0146 mm within 0.5 mm',748905,384000,NULL,NULL);
INSERT INTO tone VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',2,0,0,0,'edge',180.0,36160.544844999996712,0.74656795399999997808,0.99999999938748951322,0.35390322051572603578,0.0,'edge',0.012848462551491364458,7.7713799568251937799,'edge: boundary bound 0.0128 mm within 0.5 mm',1137207,384000,NULL,NULL);
INSERT INTO tone VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',3,0,0,0,'edge',140.0,27847.083456000000297,0.6767081349999999329,1.0000000003634537115,0.3493493884719244269,0.0,'edge',0.014641271283980039977,7.9589536893030965458,'edge: boundary bound 0.0146 mm within 0.5 mm',1458286,384000,NULL,NULL);
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
INSERT INTO event VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',0,1,1000000000,'next','0',0);
INSERT INTO event VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',1,1,1000000000,'presented','',0);
INSERT INTO event VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',2,1,2987553241,'answer','1',0);
INSERT INTO event VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',3,1,1800000000,'stimulus','1.21555208',0);
INSERT INTO event VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',4,1,3100548924,'presented','',1);
INSERT INTO event VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',5,1,4951263778,'answer','0',1);
INSERT INTO event VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',6,1,3900546875,'stimulus','1.07871875',1);
INSERT INTO event VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',7,1,5122955727,'presented','',2);
INSERT INTO event VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',8,1,6647885297,'answer','1',2);
INSERT INTO event VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',9,1,5922953125,'stimulus','0.752932291',2);
INSERT INTO event VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',10,1,6795239783,'presented','',3);
INSERT INTO event VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',11,1,8282487476,'answer','0',3);
INSERT INTO event VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',12,1,7595239583,'stimulus','0.71525',3);
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
INSERT INTO link VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',0,4,1,-1,-1,-1,'running','','b0f2f38b158e22e72cf643b57118426cf24fefdce8f33360f8d2a64a3b86c7ec');
INSERT INTO link VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',1,4,1,0,-1,-1,'running','','7a580491bfd079f21aeef0524cc2428589446d7b41ab4ec8267f56084ed054cc');
INSERT INTO link VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',2,4,1,0,-1,1,'running','','d2957257d70b1d1a18a5b7f3801c2550c7d2d13784783846d1c026c40ad68567');
INSERT INTO link VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',3,4,1,0,0,3,'running','','53801061a639a18c0926a8de452f7c53a2e8f4868de9b199182b204fa3c000db');
INSERT INTO link VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',4,4,1,0,0,4,'running','','ee9cbda736e91aa06942be9525e49661ee1fbaee413ee75c35ccf1107b9055c8');
INSERT INTO link VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',5,4,1,0,1,6,'running','','0d8997abde2ead1d70c74ae1c5c64d0c170c54a6dbb436d1203aa3aa1137fc62');
INSERT INTO link VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',6,4,1,0,1,7,'running','','cf8f35c144457c148921ccd633e84c47f9e45a69dc22c5470535fd08f23624ed');
INSERT INTO link VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',7,4,1,0,2,9,'running','','fffcf972425119d8ed28db4dbc6821d6c556d48d479a5a940be0f7789c1f59c2');
INSERT INTO link VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',8,4,1,0,2,10,'running','','6d6c67007ce5f163641ab5a58ca30f6fbc3ae6c196134789ee6bf03a199a221f');
INSERT INTO link VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',9,4,1,0,3,12,'running','','c0907fba1cc11afe97b357ce2755faadbea0e7c8a61bd3f77ff8a05f030226b2');
INSERT INTO link VALUES('29096b0b-99c1-48ef-b954-a7a2a9a6dc2e',10,4,1,0,3,12,'completed','','2edb6979fe453965fdc205aa9c7278a47a4e67f11196ad64544b94dbe2852747');
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
COMMIT;

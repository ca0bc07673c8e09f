-- Sessions with checksums of encoding 2, as the last release with schema 5 wrote them. Made by: sqlite3 FILE .dump
PRAGMA foreign_keys=OFF;
BEGIN TRANSACTION;
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) STRICT, WITHOUT ROWID;
INSERT INTO meta VALUES('database_id','4db95c2f-4c6a-4626-b25e-bee24b591550');
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
INSERT INTO enrolment VALUES('vm','tiny','P01',0);
CREATE TABLE protocol (
  protocol_key TEXT PRIMARY KEY,
  protocol_id TEXT NOT NULL,
  version TEXT NOT NULL,
  sha256 TEXT NOT NULL,
  text TEXT NOT NULL,
  canonical TEXT NOT NULL
) STRICT, WITHOUT ROWID;
INSERT INTO protocol VALUES('c57c83ea19db7bd464aab4c10c7fa7c28b9163754403698466116aa2240085fe','tiny','1','ce97afd7b050c32e68b8e521d207d5a67f4e5bd996f00cc411b65a2fd3b54acf',replace('format = "friction-protocol/1"\n[protocol]\nid = "tiny"\nversion = "1"\ntitle = "Tiny"\nlanguages = ["en"]\n[[factor]]\nname = "offset_mm"\nrange = [-20.0, 20.0]\n[scene.edge]\nboundary_mm = "150 + offset_mm"\nedge = "p50"\ndisplacement_um = 1.0\n[task]\nkind = "single-interval"\nintervals = ["edge"]\ndevice = "touch"\nquestion = { en = "Where?" }\nchoices = [ { id = "left", label = { en = "Left" } }, { id = "right", label = { en = "Right" } } ]\ncorrect = { left = "offset_mm < 0", right = "offset_mm > 0" }\n[timing]\nresponse_zero = "go_cue"\nexplore_s = 2.0\ndeadline_s = 6.0\niti_s = 0.5\n[[procedure]]\nname = "levels"\nkind = "constant-stimuli"\nlevel = "offset_mm"\nvalues = [-20.0, 20.0]\nrepeats = 2\n[[block]]\nname = "main"\nprocedures = ["levels"]\n','\n',char(10)),'{"block":[{"name":"main","procedures":["levels"]}],"factor":[{"name":"offset_mm","range":[-20,20]}],"format":"friction-protocol/1","procedure":[{"kind":"constant-stimuli","level":"offset_mm","name":"levels","repeats":2,"values":[-20,20]}],"protocol":{"id":"tiny","languages":["en"],"title":"Tiny","version":"1"},"scene":{"edge":{"boundary_mm":"150 + offset_mm","displacement_um":1,"edge":"p50"}},"task":{"choices":[{"id":"left","label":{"en":"Left"}},{"id":"right","label":{"en":"Right"}}],"correct":{"left":"offset_mm < 0","right":"offset_mm > 0"},"device":"touch","intervals":["edge"],"kind":"single-interval","question":{"en":"Where?"}},"timing":{"deadline_s":6,"explore_s":2,"iti_s":0.5,"response_zero":"go_cue"}}');
CREATE TABLE rig (
  rig_key TEXT PRIMARY KEY,
  name TEXT NOT NULL,
  sha256 TEXT NOT NULL,
  text TEXT NOT NULL
) STRICT, WITHOUT ROWID;
INSERT INTO rig VALUES('8cb58e16dd10c8af835c24a70b2964c0afe06b9f3a2ade2fd6f29f399d8c1c21','Aluminium tapered plate, simulated','ca944938cf37263ef151416f5e3182f4c5cbc8c1d87b8d662440e2d12366d078',replace('# A clamped 2 mm aluminium plate that a workshop can build, with a simulated amplifier and no converter.\n# Usable from 22.4 to 45 kHz: boundaries from about 100 to 205 mm on a strip 22 to 16 mm wide.\nformat = "friction-rig/1"\nname = "Aluminium tapered plate, simulated"\n\n[surface]\nmaterial = "aluminium"\ndensity_kg_m3 = 2700\nmodulus_GPa = 69\npoisson = 0.33\ntension_Pa = 0                # no tension: a plate, stiff only because of its bending stiffness\nthickness_mm = 2.0\nlength_mm = 300\nquality_factor = 60\nedges = "clamped"\n# Standard deviations of uncertain values. Thickness: half of the tolerance of cold-rolled sheet, +-0.09 mm\n# (EN 485-4, alloys such as 6082). Modulus and density: spread of handbook values over the 5000 and 6000 series,\n# including Poisson''s ratio. Temperature: typical difference between a room and the place of measurement.\nthickness_sd_mm = 0.045\nmodulus_sd_GPa = 1.0\ndensity_sd_kg_m3 = 20\ntemperature_sd_K = 3\n\n[surface.taper]\nhalf_width_mm = 14\nslope = 0.03\n# Half-width and slope: a workshop mills both ends to +-0.1 mm. The plate is really held a fraction of its\n# thickness behind the clamp''s edge; only measured boundaries show how far (`turnpoint calibrate`).\nhalf_width_sd_mm = 0.05\nslope_sd = 0.0002\nclamp_line_sd_mm = 0.2\n\n[[transducer]]\nname = "main"\nchannel = 0\nband_kHz = [14, 60]\num_per_full_scale = 4.0\n\n[output]\nuri = "null:"\nrate_Hz = 192000\n\n[amplifier]\nuri = "sim:"\n\n[buttons]\nuri = "sim:"\n\n[contact]\nuri = "sim:"\n\n[touch]\nuri = "sim:"\n\n[friction]\nmodel = "load-sharing"        # illustrative: a live session needs a measured table\npressure_kPa = 5\nfloor = 0.1\nfingertip_mm = 10\n\n# Mechanical impedance of a fingertip: near 55 N s/m at ultrasonic frequencies, higher or lower in some people\n# (J. Monnoyer, E. Diaz, C. Bourdin, M. Wiertlewski, World Haptics 2017); mostly viscous (M. Wiertlewski, J. E.\n# Colgate, IEEE Trans. Haptics 8 (2015) 36), with a phase that varies (R. Friesen and others, Haptics Symposium\n# 2016). The standard deviations are assumptions until your participants have been measured.\n[finger]\nimpedance_Ns_per_m = 55\nimpedance_sd_Ns_per_m = 15\nphase_deg = 0\nphase_sd_deg = 20\ncontact_mm = 8                # diameter of the contact\n\n[limits]\ndisplacement_um = 8.0\ncontinuous_s = 30\nduty = 0.8\nsession_minutes = 60\n','\n',char(10)));
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
INSERT INTO session VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2','P01','c57c83ea19db7bd464aab4c10c7fa7c28b9163754403698466116aa2240085fe','tiny.toml','8cb58e16dd10c8af835c24a70b2964c0afe06b9f3a2ade2fd6f29f399d8c1c21','simulated.toml',NULL,'simulated',1,0,1,'en','sim','["offset_mm"]','mm','0.1.0','1','Linux 6.18.44-fc-v669 x86_64','vm','none asked (synchronous)','2026-11-23T08:35:00+0000','','completed','');
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
INSERT INTO segment VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',1,'b783feeb-9701-4637-b0b3-c1213052044f','start',0,76595788404096,1795422900015767652);
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
INSERT INTO block VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',0,0,0,'main','',0);
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
  CHECK (proof IN ('unproven', 'ok', 'flagged', 'refused', 'stopped', 'lost')), proof_cause TEXT NOT NULL DEFAULT '', drive_ratio_dB REAL, drive_residual_dB REAL, onset_error_us REAL,
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
INSERT INTO trial VALUES(1,'d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',1,0,0,0,0,'experimental','levels',20.0,'{"offset_mm":20.0}',170.0,33763.841680999998062,0.99999999932590000195,'right','right',1,'answered',1800000000,1.8000000000000000444,2.4875532410000000815,1.1875532410000000371,NULL,NULL,'go_cue','simulated',0.0,6.0,0,0,NULL,NULL,5208.3333333333330303,0.0,8751876516916950997,1795422900048262932,'unproven','',NULL,NULL,NULL);
INSERT INTO trial VALUES(2,'d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',1,0,0,1,1,'experimental','levels',-20.0,'{"offset_mm":-20.0}',130.0,26217.369843000000401,0.99999999965989394556,'left','left',1,'answered',4287552083,4.2875520830000004579,2.3507157450000000231,1.0507169030000000908,NULL,NULL,'go_cue','simulated',0.0,6.0,0,0,NULL,NULL,5208.3333333333330303,0.0,4062627861529075752,1795422900050729855,'unproven','',NULL,NULL,NULL);
INSERT INTO trial VALUES(3,'d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',1,0,0,2,2,'experimental','levels',20.0,'{"offset_mm":20.0}',170.0,33763.841680999998062,0.99999999932590000195,'right','right',1,'answered',6638270833,6.6382708329999999818,2.0249340190000002515,0.7249321720000000413,NULL,NULL,'go_cue','simulated',0.0,6.0,0,0,NULL,NULL,5208.3333333333330303,0.0,4345182330006763810,1795422900051988359,'unproven','',NULL,NULL,NULL);
INSERT INTO trial VALUES(4,'d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',1,0,0,3,3,'experimental','levels',-20.0,'{"offset_mm":-20.0}',130.0,26217.369843000000401,0.99999999965989394556,'left','left',1,'answered',8663203125,8.6632031250000007815,1.9872480130000000908,0.68724789299999999858,NULL,NULL,'go_cue','simulated',0.0,6.0,0,0,NULL,NULL,5208.3333333333330303,0.0,4508497742708451271,1795422900053212932,'unproven','',NULL,NULL,NULL);
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
INSERT INTO tone VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',0,0,0,0,'edge',170.0,33763.841680999998062,0.63890493600000008989,0.99999999932590000195,0.35258464018201007839,0.0,'edge',0.013296664726568615741,7.8150777051057414013,'edge: ',345600,384000,NULL,NULL);
INSERT INTO tone VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',1,0,0,0,'edge',130.0,26217.369843000000401,0.7661040420000000406,0.99999999965989394556,0.34846344136756601805,0.0,'edge',0.013706246109936676136,8.0110457239015477881,'edge: ',823210,384000,NULL,NULL);
INSERT INTO tone VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',2,0,0,0,'edge',170.0,33763.841680999998062,0.63890493600000008989,0.99999999932590000195,0.35258464018201007839,0.0,'edge',0.013296664726568615741,7.8150777051057414013,'edge: ',1274548,384000,NULL,NULL);
INSERT INTO tone VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',3,0,0,0,'edge',130.0,26217.369843000000401,0.7661040420000000406,0.99999999965989394556,0.34846344136756601805,0.0,'edge',0.013706246109936676136,8.0110457239015477881,'edge: ',1663335,384000,NULL,NULL);
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
INSERT INTO event VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',0,1,1000000000,'next','0',0);
INSERT INTO event VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',1,1,1000000000,'presented','',0);
INSERT INTO event VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',2,1,2987553241,'answer','1',0);
INSERT INTO event VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',3,1,1800000000,'stimulus','1.24555208',0);
INSERT INTO event VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',4,1,3487553241,'presented','',1);
INSERT INTO event VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',5,1,5338268986,'answer','0',1);
INSERT INTO event VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',6,1,4287552083,'stimulus','1.10871875',1);
INSERT INTO event VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',7,1,5838268986,'presented','',2);
INSERT INTO event VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',8,1,7363203005,'answer','1',2);
INSERT INTO event VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',9,1,6638270833,'stimulus','0.782932292',2);
INSERT INTO event VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',10,1,7863203005,'presented','',3);
INSERT INTO event VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',11,1,9350451018,'answer','0',3);
INSERT INTO event VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',12,1,8663203125,'stimulus','0.74525',3);
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
INSERT INTO link VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',0,2,1,-1,-1,-1,'running','','25f4da6c2c2663da7ad179b3fcb086881a61a89d3c96f1751c0a4e9e40c9ee1c');
INSERT INTO link VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',1,2,1,0,-1,-1,'running','','567cf27d273b62654b6858672214f4d2f299c38ef7d02af4c5445b890517cdcf');
INSERT INTO link VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',2,2,1,0,-1,1,'running','','4d21abdf56e117c9fd0376c1a6742d80929e998216039a1ae485d9c14d2876c5');
INSERT INTO link VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',3,2,1,0,0,3,'running','','096ffbd36b628cb7a1f2774bc219945c3491e91b04adea36a3c3753a65a82ae0');
INSERT INTO link VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',4,2,1,0,0,4,'running','','931b6f6a64418e5a084433beef3a86725f5cdd3ad3e75d81806cfe7cf4ff06dc');
INSERT INTO link VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',5,2,1,0,1,6,'running','','62e5049cd8abf87227220f84e25c2c3c79c77a5e86f537e21934bd6f9b197304');
INSERT INTO link VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',6,2,1,0,1,7,'running','','23fb1922c2946be2a2c110958a3c264f190d318e6f6e04ef160e4d4788f0a9b4');
INSERT INTO link VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',7,2,1,0,2,9,'running','','6bb2773526a73362b889ab65ad4e2d052bacdfc2a7a306a9d5356f7576cadd36');
INSERT INTO link VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',8,2,1,0,2,10,'running','','d624c8afcae577580724932a9beaf350b948ca32077d6b0151c673a5a2110363');
INSERT INTO link VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',9,2,1,0,3,12,'running','','2001c86cf42709518c93e8f21a925f7f847d3d8dd325925b2cedf3ab7fbab5ec');
INSERT INTO link VALUES('d8a718f6-7e56-4e6e-b188-01cae3ee4cd2',10,2,1,0,3,12,'completed','','e2d40c5fe9c998f444cd724acff52b1606938ca1b4b5d06d91ae109de5fd6b56');
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
CREATE TRIGGER trial_is_never_changed BEFORE UPDATE ON trial
  BEGIN SELECT RAISE(ABORT, 'trial is append-only'); END;
CREATE TRIGGER tone_is_never_changed BEFORE UPDATE ON tone
  BEGIN SELECT RAISE(ABORT, 'tone is append-only'); END;
CREATE TRIGGER event_is_never_changed BEFORE UPDATE ON event
  BEGIN SELECT RAISE(ABORT, 'event is append-only'); END;
CREATE TRIGGER session_keeps_its_provenance BEFORE UPDATE OF session_id, participant, protocol_key, protocol_path,
    rig_key, rig_path, calibration_id, run_mode, session_index, sequence_index, seed, language, observer,
    factor_columns, level_unit, software_version, columns_version, kernel, station_id, realtime_rights,
    started_local, consent_version ON session
  BEGIN SELECT RAISE(ABORT, 'the provenance of a session is never changed'); END;
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
COMMIT;

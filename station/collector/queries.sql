-- Example queries for a collector, for a role in turnpoint_reader:  psql service=lab -f queries.sql

-- Sessions by station and day
SELECT station_id, day, count(*) AS sessions, sum(trials) AS trials
FROM turnpoint.sessions WHERE run_mode = 'live' GROUP BY station_id, day ORDER BY day, station_id;

-- Sessions that need a decision before the analysis
SELECT station_id, participant, session_id, trials, not_answered, without_proof
FROM turnpoint.exclusions WHERE not_answered + without_proof > 0.1 * trials ORDER BY station_id, participant;

-- Faults by station and kind
SELECT station_id, fault, count(*) AS times FROM turnpoint.faults GROUP BY station_id, fault ORDER BY times DESC;

-- Sessions with a calibration older than half a year
SELECT station_id, day, session_id, made_on, age_days
FROM turnpoint.calibration_age WHERE age_days > 182 ORDER BY age_days DESC;

-- Stations that have not called for a week
SELECT station_id, last_contact FROM turnpoint.station
WHERE last_contact IS NULL OR last_contact < now() - interval '7 days' ORDER BY station_id;

-- Places in the counterbalancing: how many are used and leased at each station
-- (`turnpoint sessions --db postgresql://... --places` counts who started, completed, is expected and dropped out)
SELECT l.protocol_id, l.station_id, count(*) AS leased, count(e.participant) AS used
FROM turnpoint.lease l LEFT JOIN turnpoint.enrolment e USING (protocol_id, sequence_index, station_id)
GROUP BY l.protocol_id, l.station_id ORDER BY 1, 2;

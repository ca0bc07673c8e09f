#include "station/collector/schema.hpp"

namespace turnpoint::collector {

// The columns of these views have names in lower case, so that queries need no quotes.
std::string views_sql() {
  return R"sql(
CREATE OR REPLACE VIEW turnpoint.sessions AS
  SELECT s.session_id, s.station_id, left(s.started_local, 10) AS day, s.participant, q.protocol_id,
    q.version AS protocol_version, s.run_mode, s.status, s.session_index, s.sequence_index, r.name AS rig,
    s.calibration_id, s.software_version,
    (SELECT count(*) FROM turnpoint.trial t WHERE t.session_id = s.session_id) AS trials,
    (SELECT count(*) FROM turnpoint.annotation a WHERE a.session_id = s.session_id) AS annotations
  FROM turnpoint.session s JOIN turnpoint.protocol q USING (protocol_key) JOIN turnpoint.rig r USING (rig_key);
COMMENT ON VIEW turnpoint.sessions IS 'One row for each session; day is the local date at the station';

CREATE OR REPLACE VIEW turnpoint.exclusions AS
  SELECT s.session_id, s.station_id, s.participant, count(*) AS trials,
    count(*) FILTER (WHERE t.outcome <> 'answered') AS not_answered,
    count(*) FILTER (WHERE t.outcome = 'fault') AS faults,
    count(*) FILTER (WHERE t.proof IN ('refused', 'stopped', 'lost')) AS without_proof,
    count(*) FILTER (WHERE t.response_time_quality = 'toolkit') AS imprecise_times
  FROM turnpoint.session s JOIN turnpoint.trial t USING (session_id) GROUP BY s.session_id;
COMMENT ON VIEW turnpoint.exclusions IS 'For each session, how many trials an analysis may have to leave out, and why';

CREATE OR REPLACE VIEW turnpoint.faults AS
  SELECT s.station_id, left(s.started_local, 10) AS day, s.session_id, e.event_index, e.trial_index, e.value AS fault
  FROM turnpoint.session s JOIN turnpoint.event e USING (session_id) WHERE e.kind = 'fault';
COMMENT ON VIEW turnpoint.faults IS 'What went wrong in the room during sessions';

CREATE OR REPLACE VIEW turnpoint.calibration_age AS
  SELECT s.session_id, s.station_id, left(s.started_local, 10) AS day, s.calibration_id, c.made_on,
    left(s.started_local, 10)::date - c.made_on::date AS age_days
  FROM turnpoint.session s JOIN (SELECT calibration_id,
      substring(text FROM '(?n)^\s*made_on\s*=\s*"?(\d{4}-\d{2}-\d{2})') AS made_on FROM turnpoint.calibration) c
    USING (calibration_id);
COMMENT ON VIEW turnpoint.calibration_age IS 'How old the calibration was on the day of each session';

GRANT SELECT ON turnpoint.sessions, turnpoint.exclusions, turnpoint.faults, turnpoint.calibration_age
  TO turnpoint_reader;
)sql";
}

}  // namespace turnpoint::collector

#include <fmt/format.h>

#include "station/collector/schema.hpp"
#include "station/collector/tables.hpp"
#include "station/records/records.hpp"

namespace turnpoint::collector {

namespace {

/// Returns the SQL that checks that the arriving rows come after the last stored link, and inserts them.
std::string take_rows(const CollectedTable& table) {
  const auto& part = *table.chain;
  return fmt::format(
      "  IF EXISTS (SELECT FROM pg_temp.incoming_{0} WHERE session_id <> id OR {1} <= p.{2}) THEN\n"
      "    RAISE EXCEPTION 'session %: rows of table {0} are not those after the last checksum', id\n"
      "      USING ERRCODE = 'TP004';\n  END IF;\n"
      "  INSERT INTO turnpoint.{0} ({3}) SELECT {3} FROM pg_temp.incoming_{0};\n",
      table.name, quoted(part.counter), part.last, column_list(table));
}

/// Returns the SQL that checks the protocol, rig or calibration that arrived: the session refers to it, and
/// its key is the hash of its content. (`content` is an SQL expression over the row i. store/session_log.cpp
/// makes the keys.) Without this, the first station that sends a key could choose what all others must have.
std::string check_content(const std::string& table, const std::string& key, const std::string& content) {
  return fmt::format(
      "  IF EXISTS (SELECT FROM pg_temp.incoming_{0} i WHERE i.{1} IS DISTINCT FROM s.{1}\n"
      "      OR i.{1} <> encode(sha256(convert_to({2}, 'UTF8')), 'hex')) THEN\n"
      "    RAISE EXCEPTION 'session %: a {0} that arrived is not the session''s, or its key is not the hash "
      "of "
      "its content', id\n      USING ERRCODE = 'TP004';\n  END IF;\n",
      table, key, content);
}

/// Returns the SQL that inserts rows which several sessions share. A session is refused if a row with the
/// same key is already there but differs.
std::string take_shared(const CollectedTable& table, const std::string& conflict) {
  std::string same;
  for (const auto& name : table.key)
    same += fmt::format("{0}t.{1} = i.{1}", same.empty() ? "" : " AND ", quoted(name));
  std::string mine, theirs;
  for (const auto& column : table.columns) {
    mine += (mine.empty() ? "t." : ", t.") + quoted(column.name);
    theirs += (theirs.empty() ? "i." : ", i.") + quoted(column.name);
  }
  return fmt::format(
      "  INSERT INTO turnpoint.{0} ({1}) SELECT {1} FROM pg_temp.incoming_{0} ON CONFLICT ({2}) DO NOTHING;\n"
      "  IF EXISTS (SELECT FROM pg_temp.incoming_{0} i JOIN turnpoint.{0} t ON {3}\n"
      "      WHERE ROW({4}) IS DISTINCT FROM ROW({5})) THEN\n"
      "    RAISE EXCEPTION 'session %: {6}', id USING ERRCODE = 'TP004';\n  END IF;\n",
      table.name, column_list(table), quoted_list(table.key), same, mine, theirs, conflict);
}

std::string prepare_function() {
  std::string sql = R"sql(
CREATE OR REPLACE FUNCTION turnpoint.prepare() RETURNS void LANGUAGE plpgsql SECURITY DEFINER
SET search_path = pg_catalog, pg_temp SET client_min_messages = warning AS $fn$
BEGIN
)sql";
  for (const auto& table : collected_tables()) {
    if (table.name == "tombstone" || table.name == "same_person") continue;
    sql += fmt::format(
        "  CREATE TEMPORARY TABLE IF NOT EXISTS incoming_{0} (LIKE turnpoint.{0}) ON COMMIT DELETE ROWS;\n"
        "  EXECUTE format('GRANT INSERT ON pg_temp.incoming_{0} TO %I', session_user);\n",
        table.name);
  }
  return sql + "END $fn$;\n";
}

std::string store_function() {
  std::string sql = R"sql(
-- Stores the rows in the temporary tables as one session, or as the rest of it. Calculates the checksums of the
-- new links from what is then stored. Returns the last checksum, and one over the session's annotations.
CREATE OR REPLACE FUNCTION turnpoint.store_session(id text)
RETURNS TABLE (last_index bigint, last_sha256 text, annotations_sha256 text) LANGUAGE plpgsql SECURITY DEFINER
SET search_path = pg_catalog, pg_temp SET enable_seqscan = off SET enable_bitmapscan = off SET jit = off
SET plan_cache_mode = force_generic_plan AS $fn$
#variable_conflict use_column
DECLARE p turnpoint.link; l turnpoint.link; s turnpoint.session; known boolean;
BEGIN
  SELECT * INTO s FROM pg_temp.incoming_session;
  IF NOT FOUND OR s.session_id <> id OR (SELECT count(*) FROM pg_temp.incoming_session) <> 1 THEN
    RAISE EXCEPTION 'session %: exactly one row of table session is needed', id USING ERRCODE = 'TP004';
  END IF;
  IF NOT turnpoint.is_own(s.station_id) THEN
    RAISE EXCEPTION 'session %: % may not store sessions of station %', id, session_user, s.station_id
      USING ERRCODE = 'TP003';
  END IF;
  -- One transaction at a time for each station. Only the station's own role can hold this lock.
  PERFORM FROM turnpoint.station t WHERE t.station_id = s.station_id FOR UPDATE;
  IF turnpoint.is_withdrawn(id, s.station_id, s.participant) THEN
    RAISE EXCEPTION 'session %: it was withdrawn', id USING ERRCODE = 'TP002';
  END IF;
  IF EXISTS (SELECT FROM pg_temp.incoming_link WHERE session_id <> id)
    OR EXISTS (SELECT FROM pg_temp.incoming_annotation WHERE session_id <> id)
     OR EXISTS (SELECT FROM pg_temp.incoming_participant i WHERE i.code <> s.participant)
    OR EXISTS (SELECT FROM pg_temp.incoming_enrolment e WHERE (e.station_id, e.participant)
                 IS DISTINCT FROM (s.station_id, s.participant)) THEN
    RAISE EXCEPTION 'session %: rows of another session', id USING ERRCODE = 'TP004';
  END IF;
  INSERT INTO turnpoint.participant SELECT * FROM pg_temp.incoming_participant ON CONFLICT DO NOTHING;
)sql";
  sql += check_content("protocol", "protocol_key",
                       R"(concat_ws(E'\n', i.protocol_id, i.version, i.sha256, i.text, i.canonical))");
  sql += check_content("rig", "rig_key", R"(concat_ws(E'\n', i.name, i.sha256, i.text))");
  sql += check_content("calibration", "calibration_id", "i.text");
  sql += take_shared(collected_table("enrolment"), "its participant has another place on the server");
  for (const auto* table : {"protocol", "rig", "calibration"})
    sql += take_shared(collected_table(table), fmt::format("its {} differs on the server", table));
  sql += fmt::format(R"sql(
  known := EXISTS (SELECT FROM turnpoint.session t WHERE t.session_id = id);
  IF known THEN
    UPDATE turnpoint.session t SET status = s.status, status_reason = s.status_reason WHERE t.session_id = id;
    IF EXISTS (SELECT FROM turnpoint.session t WHERE t.session_id = id AND t IS DISTINCT FROM s) THEN
      RAISE EXCEPTION 'session %: its provenance differs on the server', id USING ERRCODE = 'TP004';
    END IF;
  ELSE
    INSERT INTO turnpoint.session ({0}) SELECT {0} FROM pg_temp.incoming_session;
  END IF;
  SELECT * INTO p FROM turnpoint.link t WHERE t.session_id = id ORDER BY t.link_index DESC LIMIT 1;
  IF NOT FOUND THEN
    p.link_index := -1; p.last_segment := 0; p.last_block := -1; p.last_trial := -1; p.last_event := -1;
    p.sha256 := '';
  END IF;
)sql",
                     column_list(collected_table("session")));
  for (const auto& table : collected_tables())
    if (table.chain) sql += take_rows(table);
  sql += fmt::format(R"sql(
  FOR l IN SELECT * FROM pg_temp.incoming_link i ORDER BY i.link_index LOOP
    IF l.link_index <> p.link_index + 1 THEN
      RAISE EXCEPTION 'session %: checksum % is missing', id, p.link_index + 1 USING ERRCODE = 'TP004';
    END IF;
    IF turnpoint.link_sha256(p, l) IS DISTINCT FROM l.sha256 THEN
      RAISE EXCEPTION 'session %: the rows that arrived differ from checksum %', id, l.link_index
        USING ERRCODE = 'TP001';
    END IF;
    p := l;
  END LOOP;
  IF p.link_index < 0 THEN
    RAISE EXCEPTION 'session %: it has no checksum', id USING ERRCODE = 'TP004';
  END IF;
  INSERT INTO turnpoint.link ({0}) SELECT {0} FROM pg_temp.incoming_link;
)sql",
                     column_list(collected_table("link")));
  for (const auto& table : collected_tables())
    if (table.chain)
      sql += fmt::format(
          "  IF EXISTS (SELECT FROM pg_temp.incoming_{0} WHERE {1} > p.{2}) THEN\n"
          "    RAISE EXCEPTION 'session %: rows of table {0} have no checksum', id USING ERRCODE = 'TP004';\n"
          "  END IF;\n",
          table.name, quoted(table.chain->counter), table.chain->last);
  sql += take_shared(collected_table("annotation"), "an annotation differs on the server");
  const std::string running = name(records::SessionStatus::running),
                    interrupted = name(records::SessionStatus::interrupted),
                    abandoned = name(records::SessionStatus::abandoned);
  sql += fmt::format(R"sql(
  -- A session whose process died changes its status without a link.
  IF NOT ((s.status, s.status_reason) = (p.status, p.status_reason)
    OR (p.status = '{0}' AND (s.status, s.status_reason) = ('{1}', '{3}'))
    OR (p.status IN ('{0}', '{1}') AND (s.status, s.status_reason) = ('{2}', '{4}'))) THEN
    RAISE EXCEPTION 'session %: its status differs from its last checksum', id USING ERRCODE = 'TP001';
  END IF;
  IF NOT EXISTS (SELECT FROM turnpoint.enrolment e JOIN turnpoint.protocol q USING (protocol_id)
      WHERE q.protocol_key = s.protocol_key AND e.participant = s.participant
        AND e.sequence_index = s.sequence_index) THEN
    RAISE EXCEPTION 'session %: its participant is not enrolled with its place in the counterbalancing', id
      USING ERRCODE = 'TP004';
  END IF;
  UPDATE turnpoint.station t SET last_contact = now() WHERE t.station_id = s.station_id;
  RETURN QUERY SELECT p.link_index, p.sha256, turnpoint.annotations_sha256(id);
END $fn$;
)sql",
                     running, interrupted, abandoned, records::kLostReason, records::kAbandonedReason);
  return sql;
}

constexpr const char* kFunctions = R"sql(
-- Stations are known by the role with which they connect, which SECURITY DEFINER does not change.
CREATE OR REPLACE FUNCTION turnpoint.is_own(station text) RETURNS boolean LANGUAGE sql STABLE AS
  $$ SELECT EXISTS (SELECT FROM turnpoint.station s WHERE s.station_id = station AND s.role = session_user) $$;

CREATE OR REPLACE FUNCTION turnpoint.code_sha256(salt text, code text) RETURNS text LANGUAGE sql IMMUTABLE AS
  $$ SELECT encode(sha256(convert_to(salt || '/' || code, 'UTF8')), 'hex') $$;

-- A tombstone concerns the sessions and codes of its own station only, and so does every use of it below.
CREATE OR REPLACE FUNCTION turnpoint.is_withdrawn(id text, station text, code text) RETURNS boolean
LANGUAGE sql STABLE AS $$ SELECT EXISTS (SELECT FROM turnpoint.tombstone t WHERE t.station_id = station
  AND (t.session_id = id OR t.participant_sha256 = turnpoint.code_sha256(t.salt, code))) $$;

-- How long a transaction of a station may stand idle, and how long it may last, while others want to send.
CREATE OR REPLACE FUNCTION turnpoint.longest_idle() RETURNS interval LANGUAGE sql AS $$ SELECT interval '1 minute' $$;
CREATE OR REPLACE FUNCTION turnpoint.longest_transaction() RETURNS interval LANGUAGE sql AS
  $$ SELECT interval '2 hours' $$;

-- Ends the transactions of stations that last too long: each may hold rows for which other stations wait.
CREATE OR REPLACE FUNCTION turnpoint.end_stale() RETURNS bigint LANGUAGE sql AS $$
  SELECT count(pg_terminate_backend(a.pid, 1000)) FROM pg_stat_activity a
  WHERE a.datname = current_database() AND a.pid <> pg_backend_pid()
    AND a.usename IN (SELECT s.role FROM turnpoint.station s)
    AND (a.xact_start < now() - turnpoint.longest_transaction()
      OR (a.state LIKE 'idle in transaction%' AND a.state_change < clock_timestamp() - turnpoint.longest_idle())) $$;

CREATE OR REPLACE FUNCTION turnpoint.annotations_sha256(id text) RETURNS text LANGUAGE sql STABLE AS
  $$ SELECT encode(sha256(coalesce(string_agg(convert_to(turnpoint.coded(annotation_id)
       || turnpoint.coded(realtime_ns) || turnpoint.coded(text) || E'\n', 'UTF8'), ''::bytea
       ORDER BY annotation_id COLLATE "C"), ''::bytea)), 'hex')
     FROM turnpoint.annotation WHERE session_id = id $$;

-- The schema of the server, and the stations for which the caller may speak.
CREATE OR REPLACE FUNCTION turnpoint.hello() RETURNS TABLE (schema bigint, station_id text)
LANGUAGE sql STABLE SECURITY DEFINER SET search_path = pg_catalog, pg_temp AS
  $$ SELECT v.schema, s.station_id FROM turnpoint.version v
     LEFT JOIN turnpoint.station s ON s.role = session_user ORDER BY s.station_id COLLATE "C" $$;

-- The last link of each of the caller's sessions.
CREATE OR REPLACE FUNCTION turnpoint.chains()
RETURNS TABLE (session_id text, link_index bigint, sha256 text, last_segment bigint, last_block bigint,
  last_trial bigint, last_event bigint, status text, status_reason text, annotations bigint)
LANGUAGE sql STABLE SECURITY DEFINER SET search_path = pg_catalog, pg_temp AS
  $$ SELECT s.session_id, l.link_index, l.sha256, l.last_segment, l.last_block, l.last_trial, l.last_event,
       s.status, s.status_reason, (SELECT count(*) FROM turnpoint.annotation a WHERE a.session_id = s.session_id)
     FROM turnpoint.session s CROSS JOIN LATERAL (SELECT * FROM turnpoint.link k
       WHERE k.session_id = s.session_id ORDER BY k.link_index DESC LIMIT 1) l
     WHERE turnpoint.is_own(s.station_id) $$;

-- Deletes what has a tombstone, on condition that the caller may.
CREATE OR REPLACE FUNCTION turnpoint.delete_withdrawn() RETURNS void LANGUAGE plpgsql AS $fn$
BEGIN
  DELETE FROM turnpoint.session s USING turnpoint.tombstone t
    WHERE (t.session_id, t.station_id) = (s.session_id, s.station_id);
  DELETE FROM turnpoint.enrolment e USING turnpoint.tombstone t
    WHERE t.station_id = e.station_id AND t.participant_sha256 = turnpoint.code_sha256(t.salt, e.participant);
  DELETE FROM turnpoint.same_person e USING turnpoint.tombstone t
    WHERE (t.station_id = e.station_a AND t.participant_sha256 = turnpoint.code_sha256(t.salt, e.code_a))
      OR (t.station_id = e.station_b AND t.participant_sha256 = turnpoint.code_sha256(t.salt, e.code_b));
  -- A code that another transaction has locked is about to be used, so do not wait for it.
  DELETE FROM turnpoint.participant WHERE code IN (SELECT p.code FROM turnpoint.participant p
    WHERE NOT EXISTS (SELECT FROM turnpoint.session s WHERE s.participant = p.code)
      AND NOT EXISTS (SELECT FROM turnpoint.enrolment e WHERE e.participant = p.code) FOR UPDATE SKIP LOCKED);
END $fn$;

-- Takes the tombstones that a station holds, as a JSON list of rows of table tombstone, and the ids of the sessions of
-- other stations that it has a copy of. A tombstone counts if it is about the caller's own station and agrees with the
-- session, if the server has that session; others are ignored. Returns the tombstones of the caller's stations and
-- those of the sessions that it named. It sees no others: a dictionary of codes would find the codes behind the hashes.
DROP FUNCTION IF EXISTS turnpoint.exchange_tombstones(json);
CREATE OR REPLACE FUNCTION turnpoint.exchange_tombstones(theirs json, held json DEFAULT '[]')
RETURNS SETOF turnpoint.tombstone LANGUAGE plpgsql SECURITY DEFINER SET search_path = pg_catalog, pg_temp AS $fn$
DECLARE new_rows bigint;
BEGIN
  PERFORM turnpoint.end_stale();
  INSERT INTO turnpoint.tombstone (session_id, salt, participant_sha256, withdrawn_realtime_ns, station_id)
    SELECT t.session_id, t.salt, t.participant_sha256, t.withdrawn_realtime_ns, t.station_id
    FROM json_populate_recordset(NULL::turnpoint.tombstone, theirs) t
    WHERE turnpoint.is_own(t.station_id) AND NOT EXISTS (SELECT FROM turnpoint.session s
      WHERE s.session_id = t.session_id AND (s.station_id <> t.station_id
        OR t.participant_sha256 NOT IN ('', turnpoint.code_sha256(t.salt, s.participant))))
    ON CONFLICT DO NOTHING;
  GET DIAGNOSTICS new_rows = ROW_COUNT;
  IF new_rows > 0 THEN PERFORM turnpoint.delete_withdrawn(); END IF;
  RETURN QUERY SELECT * FROM turnpoint.tombstone t WHERE turnpoint.is_own(t.station_id)
    OR (t.session_id IN (SELECT json_array_elements_text(held))
      AND NOT EXISTS (SELECT FROM turnpoint.session s WHERE s.session_id = t.session_id))
    ORDER BY t.session_id;
END $fn$;

-- The station of a role that speaks for one station only.
CREATE OR REPLACE FUNCTION turnpoint.own_station() RETURNS text LANGUAGE plpgsql STABLE AS $fn$
DECLARE mine text[] := ARRAY(SELECT s.station_id FROM turnpoint.station s WHERE s.role = session_user);
BEGIN
  IF cardinality(mine) <> 1 THEN
    RAISE EXCEPTION 'role % speaks for % stations; places are leased to one', session_user, cardinality(mine)
      USING ERRCODE = 'TP003';
  END IF;
  RETURN mine[1];
END $fn$;

-- Leases this many more places in the counterbalancing of a protocol to the caller: the lowest that no station has.
-- Returns all places that are leased to the caller.
CREATE OR REPLACE FUNCTION turnpoint.lease_places(protocol text, more bigint) RETURNS SETOF bigint
LANGUAGE plpgsql SECURITY DEFINER SET search_path = pg_catalog, pg_temp AS $fn$
DECLARE mine text := turnpoint.own_station();
BEGIN
  IF more < 0 OR more + (SELECT count(*) FROM turnpoint.lease t WHERE t.protocol_id = protocol AND t.station_id = mine
      AND NOT EXISTS (SELECT FROM turnpoint.enrolment e WHERE e.protocol_id = protocol
                        AND e.sequence_index = t.sequence_index)) > 10000 THEN
    RAISE EXCEPTION 'a station cannot lease % more places; it may hold up to 10000 that nobody has', more
      USING ERRCODE = 'TP003';
  END IF;
  LOCK TABLE turnpoint.lease IN SHARE ROW EXCLUSIVE MODE;  -- the database's lock_timeout limits how long this waits
  INSERT INTO turnpoint.lease (protocol_id, sequence_index, station_id)
    SELECT protocol, i, mine FROM generate_series(0::bigint,
      (SELECT count(*) FROM turnpoint.lease t WHERE t.protocol_id = protocol)
      + (SELECT count(*) FROM turnpoint.enrolment t WHERE t.protocol_id = protocol) + more) i
    WHERE NOT EXISTS (SELECT FROM turnpoint.lease t WHERE t.protocol_id = protocol AND t.sequence_index = i)
      AND NOT EXISTS (SELECT FROM turnpoint.enrolment t WHERE t.protocol_id = protocol AND t.sequence_index = i)
    ORDER BY i LIMIT more;
  RETURN QUERY SELECT t.sequence_index FROM turnpoint.lease t
    WHERE t.protocol_id = protocol AND t.station_id = mine ORDER BY t.sequence_index;
END $fn$;

-- Takes back places that the caller has not used, as a JSON list, so that another station can lease them.
CREATE OR REPLACE FUNCTION turnpoint.return_places(protocol text, places json) RETURNS void
LANGUAGE plpgsql SECURITY DEFINER SET search_path = pg_catalog, pg_temp AS $fn$
DECLARE mine text := turnpoint.own_station();
BEGIN
  DELETE FROM turnpoint.lease t WHERE t.protocol_id = protocol AND t.station_id = mine
    AND t.sequence_index IN (SELECT value::bigint FROM json_array_elements_text(places))
    AND NOT EXISTS (SELECT FROM turnpoint.enrolment e WHERE e.protocol_id = protocol
                      AND e.sequence_index = t.sequence_index);
END $fn$;

-- Takes the list of codes that a station has declared to be one person (turnpoint join), as a JSON list of rows of
-- table same_person. It replaces what the server knew about codes of the caller's stations. Other rows are ignored.
CREATE OR REPLACE FUNCTION turnpoint.store_joins(theirs json) RETURNS void
LANGUAGE plpgsql SECURITY DEFINER SET search_path = pg_catalog, pg_temp AS $fn$
BEGIN
  DELETE FROM turnpoint.same_person s WHERE turnpoint.is_own(s.station_a) AND turnpoint.is_own(s.station_b)
    AND NOT EXISTS (SELECT FROM json_populate_recordset(NULL::turnpoint.same_person, theirs) t
      WHERE (t.station_a, t.code_a, t.station_b, t.code_b) = (s.station_a, s.code_a, s.station_b, s.code_b));
  INSERT INTO turnpoint.same_person (station_a, code_a, station_b, code_b, realtime_ns)
    SELECT t.station_a, t.code_a, t.station_b, t.code_b, t.realtime_ns
    FROM json_populate_recordset(NULL::turnpoint.same_person, theirs) t
    WHERE turnpoint.is_own(t.station_a) AND turnpoint.is_own(t.station_b)
      AND NOT turnpoint.is_withdrawn('', t.station_a, t.code_a) AND NOT turnpoint.is_withdrawn('', t.station_b, t.code_b)
    ON CONFLICT DO NOTHING;
END $fn$;

-- For an administrator: declares two codes of stations with different roles to be one person, who has the first code.
CREATE OR REPLACE FUNCTION turnpoint.join(station_1 text, code_1 text, station_2 text, code_2 text) RETURNS void
LANGUAGE plpgsql SET search_path = pg_catalog, pg_temp AS $fn$
BEGIN
  IF (SELECT count(DISTINCT t.role) FROM turnpoint.station t WHERE t.station_id IN (station_1, station_2)) <> 2 THEN
    RAISE EXCEPTION 'stations % and % do not have two roles; codes of one station are joined there', station_1, station_2;
  END IF;
  IF NOT EXISTS (SELECT FROM turnpoint.enrolment e WHERE (e.station_id, e.participant) = (station_1, code_1))
    OR NOT EXISTS (SELECT FROM turnpoint.enrolment e WHERE (e.station_id, e.participant) = (station_2, code_2)) THEN
    RAISE EXCEPTION 'nobody is known as % at % or as % at %', code_1, station_1, code_2, station_2;
  END IF;
  INSERT INTO turnpoint.same_person (station_a, code_a, station_b, code_b, realtime_ns)
    VALUES (station_1, code_1, station_2, code_2, (extract(epoch FROM now()) * 1000000000)::bigint)
    ON CONFLICT DO NOTHING;
END $fn$;

-- For an administrator: withdraws a participant of a station. The stations follow at their next contact.
CREATE OR REPLACE FUNCTION turnpoint.withdraw(station text, code text) RETURNS bigint LANGUAGE plpgsql
SET search_path = pg_catalog, pg_temp AS $fn$
DECLARE new_rows bigint; new_salt text := gen_random_uuid();
BEGIN
  INSERT INTO turnpoint.tombstone (session_id, salt, participant_sha256, withdrawn_realtime_ns, station_id)
    SELECT s.session_id, new_salt, turnpoint.code_sha256(new_salt, code),
      (extract(epoch FROM now()) * 1000000000)::bigint, s.station_id
    FROM turnpoint.session s WHERE s.station_id = station AND s.participant = code;
  GET DIAGNOSTICS new_rows = ROW_COUNT;
  IF new_rows = 0 THEN RAISE EXCEPTION 'station % has no session of %', station, code; END IF;
  PERFORM turnpoint.delete_withdrawn();
  RETURN new_rows;
END $fn$;
)sql";

constexpr const char* kRights = R"sql(
REVOKE ALL ON ALL FUNCTIONS IN SCHEMA turnpoint FROM PUBLIC;
GRANT EXECUTE ON FUNCTION turnpoint.hello(), turnpoint.chains(), turnpoint.prepare(), turnpoint.store_session(text),
  turnpoint.exchange_tombstones(json, json), turnpoint.store_joins(json), turnpoint.lease_places(text, bigint),
  turnpoint.return_places(text, json)
  TO turnpoint_station;
GRANT EXECUTE ON FUNCTION turnpoint.hello() TO turnpoint_reader;
)sql";

}  // namespace

std::string functions_sql() { return kFunctions + prepare_function() + store_function() + kRights; }

}  // namespace turnpoint::collector

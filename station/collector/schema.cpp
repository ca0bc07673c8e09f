#include "station/collector/schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "station/collector/tables.hpp"
#include "station/core/records.hpp"
#include "station/store/checksum.hpp"
#include "station/store/schema.hpp"

namespace turnpoint::collector {
namespace {

std::string type_of(const Column& column) {
  if (column.type == "INTEGER") return "bigint";
  if (column.type == "REAL") return "double precision";
  return column.type == "BLOB" ? "bytea" : "text";
}

/// Returns the words of a list such as "a | b | c". Returns nothing if the list is incomplete or contains a
/// word for "no value".
std::vector<std::string> words_of(const std::string& values) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at < values.size();) {
    const auto end = std::min(values.find(" | ", at), values.size());
    words.push_back(values.substr(at, end - at));
    at = end + 3;
  }
  const bool open = std::any_of(words.begin(), words.end(),
                                [](const auto& word) { return word == "..." || word == "n/a"; });
  return open ? std::vector<std::string>{} : words;
}

std::string check_of(const Column& column) {
  std::string list;
  for (const auto& word : words_of(column.values))
    list += (list.empty() ? "" : ", ") + (column.type == "TEXT" ? literal(word) : word);
  return list.empty() ? "" : fmt::format(" CHECK ({} IN ({}))", quoted(column.name), list);
}

std::string definition(const Column& column) {
  return fmt::format("{} {}{}{}{}", quoted(column.name), type_of(column), column.nullable ? "" : " NOT NULL",
                     column.fallback.empty() ? "" : " DEFAULT " + column.fallback, check_of(column));
}

std::string create_table(const CollectedTable& table) {
  std::string lines;
  for (const auto& column : table.columns) lines += "  " + definition(column) + ",\n";
  lines += fmt::format("  PRIMARY KEY ({})", quoted_list(table.key));
  for (const auto& names : table.unique) lines += fmt::format(",\n  UNIQUE ({})", quoted_list(names));
  for (const auto& reference : table.references)
    lines += fmt::format(",\n  FOREIGN KEY ({}) REFERENCES turnpoint.{} ({}){}",
                         quoted_list(reference.columns), reference.table, quoted_list(reference.to),
                         reference.columns.front() == "session_id" ? " ON DELETE CASCADE" : "");
  return fmt::format("CREATE TABLE IF NOT EXISTS turnpoint.{} (\n{}\n);\n", table.name, lines);
}

/// Returns the SQL that describes the columns.
std::string comments(const CollectedTable& table) {
  std::string sql;
  for (const auto& column : table.columns) {
    if (column.description.empty()) continue;
    const auto unit = column.unit.empty() ? "" : fmt::format(" [{}]", column.unit);
    sql += fmt::format("COMMENT ON COLUMN turnpoint.{}.{} IS {};\n", table.name, quoted(column.name),
                       literal(column.description + unit));
  }
  return sql;
}

/// Returns the SQL that turns on row security. turnpoint_reader may read the rows by a policy. All other
/// roles reach the rows only through functions, which run as turnpoint_owner. Readers do not see tombstones:
/// the codes of participants are short, so a dictionary of codes would find those behind the hashes.
std::string protection(const std::string& table) {
  const auto sql = fmt::format(
      "ALTER TABLE turnpoint.{0} ENABLE ROW LEVEL SECURITY;\n"
      "DROP POLICY IF EXISTS readers ON turnpoint.{0};\n",
      table);
  if (table == "tombstone") return sql + "REVOKE ALL ON turnpoint.tombstone FROM turnpoint_reader;\n";
  return sql + fmt::format(
                   "CREATE POLICY readers ON turnpoint.{0} FOR SELECT TO turnpoint_reader USING (true);\n"
                   "GRANT SELECT ON turnpoint.{0} TO turnpoint_reader;\n",
                   table);
}

constexpr const char* kRoles = R"sql(
DO $do$
DECLARE wanted text;
BEGIN
  FOREACH wanted IN ARRAY ARRAY['turnpoint_owner', 'turnpoint_station', 'turnpoint_reader'] LOOP
    IF NOT EXISTS (SELECT FROM pg_roles WHERE rolname = wanted) THEN
      EXECUTE format('CREATE ROLE %I NOLOGIN', wanted);
    END IF;
  END LOOP;
  -- The groups are those of the whole server, which may have several collectors. So each role of a station or
  -- reader is let into its own database, and nobody into another.
  EXECUTE format('REVOKE CONNECT ON DATABASE %I FROM PUBLIC', current_database());
  -- A station that could make temporary objects could put its own in the place of those that the functions use.
  EXECUTE format('REVOKE TEMPORARY, CREATE ON DATABASE %I FROM PUBLIC', current_database());
  EXECUTE format('GRANT TEMPORARY, CREATE ON DATABASE %I TO turnpoint_owner', current_database());
  -- Nobody waits for ever for a lock that another holds, and a connection that has begun a transaction and does
  -- nothing is ended. A role can change these for itself, so turnpoint.end_stale() ends those that did.
  EXECUTE format('ALTER DATABASE %I SET lock_timeout = %L', current_database(), '30s');
  EXECUTE format('ALTER DATABASE %I SET idle_in_transaction_session_timeout = %L', current_database(), '60s');
  -- PostgreSQL lets everybody store large objects, take advisory locks, write messages into its log of changes and run
  -- programs in DO. Stations need none of these. (NOTIFY needs no right; what is sent with it, only LISTEN would see.)
  FOR wanted IN SELECT p.oid::regprocedure FROM pg_proc p WHERE p.pronamespace = 'pg_catalog'::regnamespace
      AND (p.proname ~ '^(lo_|pg_(try_)?advisory_)' OR p.proname IN ('loread', 'lowrite', 'pg_notify', 'pg_logical_emit_message')) LOOP
    EXECUTE 'REVOKE EXECUTE ON FUNCTION ' || wanted || ' FROM PUBLIC';
  END LOOP;
  GRANT EXECUTE ON FUNCTION pg_advisory_xact_lock_shared(int, int) TO turnpoint_owner;  -- for turnpoint.note_hold()
  REVOKE USAGE ON LANGUAGE plpgsql FROM PUBLIC;
  GRANT USAGE ON LANGUAGE plpgsql TO turnpoint_owner;
END $do$;
GRANT pg_signal_backend, pg_read_all_stats TO turnpoint_owner;  -- for turnpoint.end_stale()
REVOKE ALL ON SCHEMA public FROM PUBLIC;
CREATE SCHEMA IF NOT EXISTS turnpoint AUTHORIZATION turnpoint_owner;
SET LOCAL ROLE turnpoint_owner;
GRANT USAGE ON SCHEMA turnpoint TO turnpoint_station, turnpoint_reader;
)sql";

constexpr const char* kOwnTables = R"sql(
CREATE TABLE IF NOT EXISTS turnpoint.version (
  only_row boolean PRIMARY KEY DEFAULT true CHECK (only_row),
  schema bigint NOT NULL
);
CREATE TABLE IF NOT EXISTS turnpoint.station (
  station_id text PRIMARY KEY CHECK (station_id <> ''),
  role name NOT NULL,
  last_contact timestamptz
);
COMMENT ON TABLE turnpoint.station IS 'Which role may store the sessions of which station';
CREATE TABLE IF NOT EXISTS turnpoint.lease (
  protocol_id text NOT NULL,
  sequence_index bigint NOT NULL CHECK (sequence_index >= 0),
  station_id text NOT NULL,
  PRIMARY KEY (protocol_id, sequence_index)
);
COMMENT ON TABLE turnpoint.lease IS 'Places in the counterbalancing of a protocol, and the stations that may use them';
)sql";

}  // namespace

std::string schema_sql() {
  std::string sql = fmt::format(
      "-- Collector of Turnpoint, schema {}, written by `turnpoint collector-schema`.\n"
      "\\set ON_ERROR_STOP on\nSET client_min_messages = warning;\n"
      "SET lock_timeout = '60s';\nBEGIN;\n{}",
      store::kSchema, kRoles);
  sql += kOwnTables;
  sql += fmt::format(
      "DO $do$ BEGIN IF (SELECT schema FROM turnpoint.version) <> {0} THEN\n"
      "  RAISE EXCEPTION 'this database has schema %, and this program writes only schema {0}; `turnpoint "
      "export` of commit {1} reads a lower one; create a new collector, or update Turnpoint here',\n"
      "    (SELECT schema FROM turnpoint.version);\nEND IF; END $do$;\n",
      store::kSchema, store::kLastReader);
  for (const auto& table : collected_tables())
    sql += create_table(table) + comments(table) + protection(table.name);
  for (const auto* own : {"version", "station", "lease"}) sql += protection(own);
  sql += fmt::format("INSERT INTO turnpoint.version (schema) VALUES ({}) ON CONFLICT DO NOTHING;\n",
                     store::kSchema);
  return sql + checksum_sql() + functions_sql() + views_sql() + "COMMIT;\n";
}

namespace {

constexpr const char* kCoded = R"sql(
-- These use immutable functions only; otherwise PostgreSQL would call them for each value instead of inlining them.
CREATE OR REPLACE FUNCTION turnpoint.coded(v text) RETURNS text LANGUAGE sql IMMUTABLE AS
  $$ SELECT CASE WHEN v IS NULL THEN 'n0:' ELSE 't' || octet_length(v)::text || ':' || v END $$;
CREATE OR REPLACE FUNCTION turnpoint.coded(v bigint) RETURNS text LANGUAGE sql IMMUTABLE AS
  $$ SELECT CASE WHEN v IS NULL THEN 'n0:' ELSE 'i' || length(v::text)::text || ':' || v::text END $$;
CREATE OR REPLACE FUNCTION turnpoint.bits(v double precision) RETURNS text LANGUAGE sql IMMUTABLE AS
  $$ SELECT ('x' || encode(float8send(v), 'hex'))::bit(64)::bigint::text $$;
CREATE OR REPLACE FUNCTION turnpoint.coded(v double precision) RETURNS text LANGUAGE sql IMMUTABLE AS
  $$ SELECT CASE WHEN v IS NULL THEN 'n0:' ELSE 'r' || length(turnpoint.bits(v))::text || ':' || turnpoint.bits(v) END $$;
CREATE OR REPLACE FUNCTION turnpoint.coded(v bytea) RETURNS bytea LANGUAGE sql IMMUTABLE AS
  $$ SELECT CASE WHEN v IS NULL THEN 'n0:'::bytea ELSE ('b' || octet_length(v)::text || ':')::bytea || v END $$;
)sql";

/// Returns an SQL expression of type bytea: the bytes that store/checksum.cpp hashes for a row, without the
/// newline at their end.
std::string coded_columns(const CollectedTable& table, const std::vector<std::string>& columns,
                          const std::string& alias) {
  std::string expression = "''::bytea", texts;
  const auto flush = [&] {
    if (!texts.empty()) expression += fmt::format("\n    || convert_to({}, 'UTF8')", texts);
    texts.clear();
  };
  for (const auto& name : columns) {
    const auto value = fmt::format("turnpoint.coded({}.{})", alias, quoted(name));
    const bool is_bytes = table.column(name).type == "BLOB";
    if (is_bytes) flush();
    if (is_bytes)
      expression += " || " + value;
    else
      texts += (texts.empty() ? "" : "\n      || ") + value;
  }
  flush();
  return expression;
}

std::string qualified_order(const std::string& order, const CollectedTable& table) {
  std::string list;
  for (std::size_t at = 0; at < order.size();) {
    const auto end = std::min(order.find(',', at), order.size());
    const auto name = order.substr(at, end - at);
    list += (list.empty() ? "t." : ", t.") + quoted(name);
    if (table.column(name).type == "TEXT") list += " COLLATE \"C\"";  // sort by bytes, as SQLite does
    at = end + 1;
  }
  return list;
}

std::string hash_table(const CollectedTable& table) {
  const auto& part = *table.chain;
  return fmt::format(
      "  IF l.{3} <> p.{3} THEN\n"
      "    SELECT string_agg({1}\n    || '\\x0a'::bytea, ''::bytea ORDER BY {2}) INTO part\n"
      "    FROM turnpoint.{0} t WHERE t.session_id = l.session_id AND t.{4} > p.{3} AND t.{4} <= l.{3};\n"
      "    content := content || convert_to('{0}' || E'\\n', 'UTF8') || coalesce(part, ''::bytea);\n"
      "  END IF;\n",
      table.name, coded_columns(table, part.columns, "t"), qualified_order(part.order, table), part.last,
      quoted(part.counter));
}

std::string link_function() {
  const auto provenance = [](const char* table, const char* alias) {
    const auto& it = collected_table(table);
    return coded_columns(it, it.provenance, alias);
  };
  std::string sql = fmt::format(R"sql(
-- The checksum of link l after link p, over the rows that are stored: the rule of station/store/checksum.hpp.
CREATE OR REPLACE FUNCTION turnpoint.link_sha256(p turnpoint.link, l turnpoint.link) RETURNS text
LANGUAGE plpgsql STABLE AS $fn$
DECLARE content bytea; part bytea;
BEGIN
  content := convert_to('turnpoint/{} ' || l.link_index || ' ' || p.sha256 || E'\n' || l.status
    || E'\n' || octet_length(l.status_reason) || ':' || l.status_reason || E'\n', 'UTF8');
  IF l.link_index = 0 THEN
    SELECT content || {} || {} || {} || {} || '\x0a'::bytea INTO content
    FROM turnpoint.session s LEFT JOIN turnpoint.protocol p1 USING (protocol_key)
      LEFT JOIN turnpoint.rig r USING (rig_key) LEFT JOIN turnpoint.calibration c USING (calibration_id)
    WHERE s.session_id = l.session_id;
  END IF;
)sql",
                                store::kSchema, provenance("session", "s"), provenance("protocol", "p1"),
                                provenance("rig", "r"), provenance("calibration", "c"));
  for (const auto& table : collected_tables())
    if (table.chain) sql += hash_table(table);
  return sql + "  RETURN encode(sha256(content), 'hex');\nEND $fn$;\n";
}

}  // namespace

std::string checksum_sql() { return kCoded + link_function(); }

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
    OR EXISTS (SELECT FROM pg_temp.incoming_enrolment e WHERE (e.station_id, e.participant)
                 IS DISTINCT FROM (s.station_id, s.participant)) THEN
    RAISE EXCEPTION 'session %: rows of another session', id USING ERRCODE = 'TP004';
  END IF;
)sql";
  sql += check_content("protocol", "protocol_key",
                       R"(concat_ws(E'\n', i.protocol_id, i.version, i.sha256, i.text, i.canonical))");
  sql += check_content("rig", "rig_key", R"(concat_ws(E'\n', i.name, i.sha256, i.text))");
  sql += check_content("calibration", "calibration_id", "i.text");
  sql += "  PERFORM turnpoint.note_hold();\n";
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
  const std::string running = name(core::SessionStatus::running),
                    interrupted = name(core::SessionStatus::interrupted),
                    abandoned = name(core::SessionStatus::abandoned);
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
                     running, interrupted, abandoned, core::kLostReason, core::kAbandonedReason);
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

-- How long a transaction of a station may stand idle, how long it may last, and how long it may last after it has begun
-- to store, while others want to send.
CREATE OR REPLACE FUNCTION turnpoint.longest_idle() RETURNS interval LANGUAGE sql AS $$ SELECT interval '1 minute' $$;
CREATE OR REPLACE FUNCTION turnpoint.longest_transaction() RETURNS interval LANGUAGE sql AS
  $$ SELECT interval '2 hours' $$;
CREATE OR REPLACE FUNCTION turnpoint.longest_hold() RETURNS interval LANGUAGE sql AS $$ SELECT interval '5 minutes' $$;

-- Notes that the caller's transaction is about to store what others may wait for: a new protocol, rig or calibration,
-- or a place. The note is a lock that nobody waits for, because others see the locks of a transaction at once; its
-- number is the time, in whole seconds since the server started, never a time to come.
CREATE OR REPLACE FUNCTION turnpoint.note_hold() RETURNS void LANGUAGE sql AS $$ SELECT
  pg_advisory_xact_lock_shared(1, floor(extract(epoch FROM clock_timestamp() - pg_postmaster_start_time()))::int) $$;

-- Ends the transactions of stations that last too long: each may hold rows for which other stations wait. If one has
-- held them too long, all connections of its role end, because another of them may be the next in line.
CREATE OR REPLACE FUNCTION turnpoint.end_stale() RETURNS bigint LANGUAGE sql AS $$
  SELECT count(pg_terminate_backend(a.pid, 1000)) FROM pg_stat_activity a
  WHERE a.datname = current_database() AND a.pid <> pg_backend_pid()
    AND a.usename IN (SELECT s.role FROM turnpoint.station s)
    AND (a.xact_start < now() - turnpoint.longest_transaction()
      OR (a.state LIKE 'idle in transaction%' AND a.state_change < clock_timestamp() - turnpoint.longest_idle())
      OR a.usename IN (SELECT h.usename FROM pg_locks k JOIN pg_stat_activity h USING (pid)
        WHERE k.locktype = 'advisory' AND (k.classid, k.objsubid) = (1, 2) AND h.datname = current_database()
          AND k.objid::bigint <= extract(epoch FROM clock_timestamp() - pg_postmaster_start_time() - turnpoint.longest_hold())
        )) $$;

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

-- The last link of each of the caller's sessions, its station and the machine that recorded it last.
CREATE OR REPLACE FUNCTION turnpoint.chains()
RETURNS TABLE (session_id text, link_index bigint, sha256 text, last_segment bigint, last_block bigint,
  last_trial bigint, last_event bigint, status text, status_reason text, annotations bigint, station_id text,
  machine text)
LANGUAGE sql STABLE SECURITY DEFINER SET search_path = pg_catalog, pg_temp AS
  $$ SELECT s.session_id, l.link_index, l.sha256, l.last_segment, l.last_block, l.last_trial, l.last_event,
       s.status, s.status_reason, (SELECT count(*) FROM turnpoint.annotation a WHERE a.session_id = s.session_id),
       s.station_id, (SELECT g.machine FROM turnpoint.segment g WHERE g.session_id = s.session_id
         ORDER BY g.segment_index DESC LIMIT 1)
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

-- The place of each live participant of a protocol who has completed or is still expected, by the rule in
-- station/store/places.hpp. Codes of one person count once.
CREATE OR REPLACE FUNCTION turnpoint.held_places(protocol text, rule json) RETURNS SETOF bigint LANGUAGE sql STABLE AS $$
  WITH RECURSIVE
    pair AS (SELECT station_a, code_a, station_b, code_b FROM turnpoint.same_person
      UNION SELECT station_b, code_b, station_a, code_a FROM turnpoint.same_person),
    code AS (SELECT s.session_id, s.station_id, s.participant, s.sequence_index, s.planned_session, s.status,
        greatest((SELECT max(g.realtime_ns) FROM turnpoint.segment g WHERE g.session_id = s.session_id),
          t.recorded_realtime_ns) AS last, t.session_id IS NOT NULL AS has_trials
      FROM turnpoint.session s JOIN turnpoint.protocol q USING (protocol_key)
        LEFT JOIN LATERAL (SELECT k.session_id, k.recorded_realtime_ns FROM turnpoint.trial k
          WHERE k.session_id = s.session_id ORDER BY k.trial_index DESC LIMIT 1) t ON true
      WHERE q.protocol_id = protocol AND s.run_mode = 'live'),
    same AS (SELECT station_id, participant, station_id AS station_2, participant AS code_2 FROM code
      UNION SELECT a.station_id, a.participant, p.station_b, p.code_b
        FROM same a JOIN pair p ON (p.station_a, p.code_a) = (a.station_2, a.code_2)),
    person AS (SELECT station_id, participant, min(ARRAY[station_2, code_2]) AS person FROM same GROUP BY 1, 2)
  SELECT (array_agg(sequence_index ORDER BY last DESC, session_id COLLATE "C" DESC))[1]
  FROM code JOIN person USING (station_id, participant) GROUP BY person
  HAVING bool_or(status = 'running')
    OR max(last) > extract(epoch FROM now()) * 1000000000 - (rule->>'dropout_after_h')::numeric * 3600000000000
    OR count(DISTINCT CASE WHEN (rule->>'sessions')::bigint = 1 THEN 1
        WHEN planned_session <= (rule->>'sessions')::bigint THEN planned_session END)
      FILTER (WHERE status = 'completed'
        OR ((rule->>'incomplete_count')::boolean AND status <> 'running' AND has_trials))
      >= (rule->>'sessions')::bigint $$;

-- Leases this many more places in the counterbalancing of a protocol to the caller. Without a rule: the lowest that no
-- station has. With one (core::Assignment as JSON): one after the other, the lowest that no station has in the row with
-- the fewest participants who have completed or are expected, and free leased places. Returns all places that are
-- leased to the caller.
DROP FUNCTION IF EXISTS turnpoint.lease_places(text, bigint);
CREATE OR REPLACE FUNCTION turnpoint.lease_places(protocol text, more bigint, rule json DEFAULT NULL)
RETURNS SETOF bigint LANGUAGE plpgsql SECURITY DEFINER SET search_path = pg_catalog, pg_temp AS $fn$
DECLARE
  mine text := turnpoint.own_station();
  n bigint := coalesce((rule->>'rows')::bigint, 1);
BEGIN
  IF more < 0 OR more + (SELECT count(*) FROM turnpoint.lease t WHERE t.protocol_id = protocol AND t.station_id = mine
      AND NOT EXISTS (SELECT FROM turnpoint.enrolment e WHERE e.protocol_id = protocol
                        AND e.sequence_index = t.sequence_index)) > 10000 THEN
    RAISE EXCEPTION 'a station cannot lease % more places; it may hold up to 10000 that nobody has', more
      USING ERRCODE = 'TP003';
  END IF;
  IF n < 1 OR n > 1000000 THEN RAISE EXCEPTION 'a design has 1 to 1000000 rows' USING ERRCODE = 'TP003'; END IF;
  PERFORM turnpoint.note_hold();
  LOCK TABLE turnpoint.lease IN SHARE ROW EXCLUSIVE MODE;  -- the database's lock_timeout limits how long this waits
  INSERT INTO turnpoint.lease (protocol_id, sequence_index, station_id)
    WITH unused AS (SELECT t.sequence_index AS place FROM turnpoint.lease t WHERE t.protocol_id = protocol
        AND NOT EXISTS (SELECT FROM turnpoint.enrolment e WHERE e.protocol_id = protocol
                          AND e.sequence_index = t.sequence_index)),
      taken AS (SELECT place FROM unused
        UNION SELECT t.sequence_index FROM turnpoint.enrolment t WHERE t.protocol_id = protocol
        UNION SELECT t.sequence_index FROM turnpoint.lease t WHERE t.protocol_id = protocol),
      taken_in AS (SELECT place % n AS r, count(*) AS places FROM taken GROUP BY 1),
      held_in AS (SELECT place % n AS r, count(*) AS persons FROM (SELECT place FROM unused
        UNION ALL SELECT * FROM turnpoint.held_places(protocol, rule)) h WHERE rule IS NOT NULL GROUP BY 1),
      -- Of the rows beyond these, none comes before those of these in which nobody has a place.
      a_row AS (SELECT r, coalesce(places, 0) AS places, coalesce(persons, 0) AS persons,
          max(coalesce(persons, 0)) OVER () + more / count(*) OVER () + 1 AS highest
        FROM generate_series(0, least(n, (SELECT count(*) FROM taken) + more) - 1) i(r)
          LEFT JOIN taken_in USING (r) LEFT JOIN held_in USING (r)),
      -- Each free place, and how many would be in its row with it and those before it.
      free AS (SELECT p.place, persons + row_number() OVER (PARTITION BY r ORDER BY p.place) AS level
        FROM a_row, LATERAL generate_series(r, r + n * (places + highest - persons), n) p(place)
        WHERE p.place NOT IN (SELECT place FROM taken))
    SELECT protocol, place, mine FROM free ORDER BY level, place LIMIT more;
  RETURN QUERY SELECT t.sequence_index FROM turnpoint.lease t
    WHERE t.protocol_id = protocol AND t.station_id = mine ORDER BY t.sequence_index;
END $fn$;

-- Takes back places that the caller has not used, as a JSON list, so that another station can lease them.
CREATE OR REPLACE FUNCTION turnpoint.return_places(protocol text, places json) RETURNS void
LANGUAGE plpgsql SECURITY DEFINER SET search_path = pg_catalog, pg_temp AS $fn$
DECLARE mine text := turnpoint.own_station();
BEGIN
  PERFORM turnpoint.note_hold();
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
  turnpoint.exchange_tombstones(json, json), turnpoint.store_joins(json), turnpoint.lease_places(text, bigint, json),
  turnpoint.return_places(text, json)
  TO turnpoint_station;
GRANT EXECUTE ON FUNCTION turnpoint.hello() TO turnpoint_reader;
)sql";

}  // namespace

std::string functions_sql() { return kFunctions + prepare_function() + store_function() + kRights; }

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

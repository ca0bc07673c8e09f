#include "station/store/read.hpp"

#include <bit>

#include "station/store/identity.hpp"
#include "station/store/names.hpp"
#include "station/store/open.hpp"
#include "station/store/rows.hpp"
#include "station/store/sqlite.hpp"

namespace turnpoint::store {

namespace {

const char* const kSessions = R"sql(
SELECT s.session_id, s.session_index, s.sequence_index, s.status, s.status_reason, s.participant, s.run_mode,
  p.protocol_id, p.version, s.protocol_path, p.text, p.sha256, p.canonical, s.factor_columns, s.level_unit,
  r.name, s.rig_path, r.text, r.sha256, s.calibration_id, c.text, s.seed, s.language, s.observer,
  s.software_version, s.columns_version, s.kernel, s.station_id, s.realtime_rights, s.started_local,
  s.consent_version,
  (SELECT count(*) FROM segment g WHERE g.session_id = s.session_id),
  (SELECT count(*) FROM trial t WHERE t.session_id = s.session_id),
  max((SELECT max(g.realtime_ns) FROM segment g WHERE g.session_id = s.session_id),
      coalesce((SELECT t.recorded_realtime_ns FROM trial t WHERE t.session_id = s.session_id
                ORDER BY t.trial_index DESC LIMIT 1), 0))
FROM session s JOIN protocol p USING (protocol_key) JOIN rig r USING (rig_key)
  LEFT JOIN calibration c USING (calibration_id)
WHERE ?1 IN ('', s.session_id) AND ?2 IN ('', s.participant) AND ?3 IN ('', p.protocol_id)
ORDER BY s.participant, p.protocol_id, s.session_index, s.session_id
)sql";

SessionStart start_from(const Statement& s) {
  SessionStart start;
  start.participant = s.text(5);
  start.run_mode = run_mode_named(s.text(6));
  start.protocol_id = s.text(7);
  start.protocol_version = s.text(8);
  start.protocol_path = s.text(9);
  start.protocol_text = s.text(10);
  start.protocol_sha256 = s.text(11);
  start.protocol_canonical = s.text(12);
  start.factor_columns = list_from_json(s.text(13));
  start.level_unit = s.text(14);
  start.rig_name = s.text(15);
  start.rig_path = s.text(16);
  start.rig_text = s.text(17);
  start.rig_sha256 = s.text(18);
  start.calibration_id = s.maybe_text(19);
  start.calibration_text = s.text(20);
  start.seed = std::bit_cast<std::uint64_t>(s.integer(21));
  start.language = s.text(22);
  start.observer = s.text(23);
  start.software_version = s.text(24);
  start.columns_version = s.text(25);
  start.kernel = s.text(26);
  start.station_id = s.text(27);
  start.realtime_rights = s.text(28);
  start.started_local = s.text(29);
  start.consent_version = s.text(30);
  return start;
}

SessionRecord session_from(const Statement& s) {
  SessionRecord session;
  session.session_id = s.text(0);
  session.session_index = static_cast<int>(s.integer(1));
  session.sequence_index = static_cast<int>(s.integer(2));
  session.status = session_status_named(s.text(3));
  session.status_reason = s.text(4);
  session.start = start_from(s);
  session.segments = static_cast<int>(s.integer(31));
  session.trials = static_cast<int>(s.integer(32));
  session.last_activity_realtime_ns = s.integer(33);
  return session;
}

std::vector<BlockRecord> read_blocks(Database& database, const std::string& session_id) {
  auto trials = read_trials(database, session_id);
  std::vector<BlockRecord> blocks;
  Statement rows(database,
                 "SELECT block_index, attempt, name, instruction, practice FROM block WHERE session_id = ?"
                 " ORDER BY run_order");
  rows.bind(session_id);
  while (rows.step()) {
    BlockRecord block;
    block.start.block_index = static_cast<int>(rows.integer(0));
    block.start.attempt = static_cast<int>(rows.integer(1));
    block.start.name = rows.text(2);
    block.start.instruction = rows.text(3);
    block.start.practice = rows.integer(4) != 0;
    block.trials = std::move(trials[{block.start.block_index, block.start.attempt}]);
    blocks.push_back(std::move(block));
  }
  return blocks;
}

std::vector<SegmentStart> read_segments(Database& database, const std::string& session_id) {
  std::vector<SegmentStart> segments;
  Statement rows(
      database,
      "SELECT boot_id, reason, monotonic_ns, boottime_ns, realtime_ns FROM segment WHERE session_id = ?"
      " ORDER BY segment_index");
  rows.bind(session_id);
  while (rows.step())
    segments.push_back({rows.text(0), rows.text(1), rows.integer(2), rows.integer(3), rows.integer(4)});
  return segments;
}

std::vector<EventRow> read_events(Database& database, const std::string& session_id) {
  std::vector<EventRow> events;
  Statement rows(database,
                 "SELECT time_ns, kind, value, trial_index, segment_index FROM event WHERE session_id = ?"
                 " ORDER BY event_index");
  rows.bind(session_id);
  while (rows.step()) {
    EventRow event{rows.integer(0), rows.text(1), rows.text(2), std::nullopt};
    if (const auto trial = rows.maybe_integer(3)) event.trial_index = static_cast<int>(*trial);
    event.segment_index = static_cast<int>(rows.integer(4));
    events.push_back(std::move(event));
  }
  return events;
}

}  // namespace

std::vector<SessionRecord> list_sessions(Database& database, const SessionFilter& filter) {
  std::vector<SessionRecord> sessions;
  Statement rows(database, kSessions);
  Statement notes(database,
                  "SELECT text FROM annotation WHERE session_id = ? ORDER BY realtime_ns, annotation_id");
  rows.bind(filter.session_id, filter.participant, filter.protocol_id);
  while (rows.step()) {
    auto session = session_from(rows);
    notes.bind(session.session_id);
    while (notes.step()) session.annotations.push_back(notes.text(0));
    sessions.push_back(std::move(session));
  }
  return sessions;
}

std::vector<SessionRecord> list_sessions(const std::string& path, const SessionFilter& filter) {
  auto database = open_reader(path);
  return list_sessions(database, filter);
}

StoredSession read_session(Database& database, const std::string& session_id) {
  auto sessions = list_sessions(database, {session_id, "", ""});
  if (session_id.empty() || sessions.empty())
    throw StoreError(Fault::missing, "database " + database.path() + ": it has no session \"" + session_id +
                                         "\"; `turnpoint sessions` lists those that it has");
  return {std::move(sessions.front()), read_segments(database, session_id), read_blocks(database, session_id),
          read_events(database, session_id)};
}

StoredSession read_session(const std::string& path, const std::string& session_id) {
  auto database = open_reader(path);
  return read_session(database, session_id);
}

std::optional<Interrupted> interrupted_session(const std::string& path, const std::string& session_id) {
  std::optional<Interrupted> newest;
  for (auto& session : list_sessions(path, {session_id, "", ""})) {
    const bool open =
        session.status == SessionStatus::interrupted || session.status == SessionStatus::running;
    if (!open || session.trials == 0) continue;
    if (newest && newest->session.last_activity_realtime_ns > session.last_activity_realtime_ns) continue;
    const auto age_ns = realtime_ns() - session.last_activity_realtime_ns;
    newest = Interrupted{std::move(session), static_cast<double>(age_ns) * 1e-9};
  }
  return newest;
}

}  // namespace turnpoint::store

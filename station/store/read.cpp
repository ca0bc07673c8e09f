#include "station/store/read.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "station/store/fields.hpp"
#include "station/store/identity.hpp"
#include "station/store/open.hpp"
#include "station/store/people.hpp"
#include "station/store/rows.hpp"
#include "station/store/sqlite.hpp"

namespace turnpoint::store {

namespace {

/// The fields of a whole SessionRecord, in the order in which session_from() reads them, then what is
/// counted.
std::string sessions_sql() {
  return "SELECT " + column_list(session_table(), "s.") + ", " + column_list(protocol_table(), "p.") + ", " +
         column_list(rig_table(), "r.") + ", " + column_list(calibration_table(), "c.") + R"sql(,
  (SELECT count(*) FROM segment g WHERE g.session_id = s.session_id),
  (SELECT count(*) FROM trial t WHERE t.session_id = s.session_id),
  max((SELECT max(g.realtime_ns) FROM segment g WHERE g.session_id = s.session_id),
      coalesce((SELECT t.recorded_realtime_ns FROM trial t WHERE t.session_id = s.session_id
                ORDER BY t.trial_index DESC LIMIT 1), 0)),
  (SELECT l.sha256 FROM link l WHERE l.session_id = s.session_id ORDER BY l.link_index DESC LIMIT 1),
  coalesce((SELECT max(t.trial_id) FROM trial t WHERE t.session_id = s.session_id), 0),
  EXISTS (SELECT 1 FROM merged m WHERE m.session_id = s.session_id)
FROM session s JOIN protocol p USING (protocol_key) JOIN rig r USING (rig_key)
  LEFT JOIN calibration c USING (calibration_id)
WHERE ?1 IN ('', s.session_id) AND ?2 IN ('', p.protocol_id)
)sql";
}

SessionRecord session_from(const Statement& row) {
  SessionRecord session;
  session.session_id = row.text(0);
  int column = 0;
  const auto read = [&](const Table<SessionRecord>& table) {
    column += static_cast<int>(table.place.size());
    read_fields(row, table, column, session);
    column += static_cast<int>(table.fields.size());
  };
  read(session_table());
  read(protocol_table());
  read(rig_table());
  read(calibration_table());
  session.segments = static_cast<int>(row.integer(column));
  session.trials = static_cast<int>(row.integer(column + 1));
  session.last_activity_realtime_ns = row.integer(column + 2);
  session.checksum = row.text(column + 3);
  session.last_trial_id = row.integer(column + 4);
  session.merged = row.integer(column + 5) != 0;
  return session;
}

/// The rows of one table that belong to a session.
template <class Record>
std::vector<Record> read_rows(Database& database, const Table<Record>& table, const std::string& session_id,
                              const std::string& order) {
  std::vector<Record> records;
  Statement rows(database, "SELECT " + column_list(table) + " FROM " + table.name +
                               " WHERE session_id = ? ORDER BY " + order);
  rows.bind(session_id);
  while (rows.step()) records.push_back(record_of(rows, table));
  return records;
}

std::vector<BlockRecord> read_blocks(Database& database, const std::string& session_id) {
  auto trials = read_trials(database, session_id);
  std::vector<BlockRecord> blocks;
  for (auto& start : read_rows(database, block_table(), session_id, "run_order")) {
    auto& of_block = trials[{start.block_index, start.attempt}];
    blocks.push_back({std::move(start), std::move(of_block)});
  }
  return blocks;
}

bool is_among(const Bearer& bearer, const std::vector<std::vector<Bearer>>& persons) {
  return std::any_of(persons.begin(), persons.end(), [&](const auto& person) {
    return std::find(person.begin(), person.end(), bearer) != person.end();
  });
}

/// Trials are numbered in the order in which they were stored; the clock may have been set since.
bool newer(const SessionRecord& a, const SessionRecord& b) {
  return std::make_pair(!a.merged, a.last_trial_id) > std::make_pair(!b.merged, b.last_trial_id);
}

}  // namespace

std::vector<SessionRecord> list_sessions(Database& database, const SessionFilter& filter) {
  std::vector<SessionRecord> sessions;
  Statement rows(database, sessions_sql());
  Statement notes(database,
                  "SELECT text FROM annotation WHERE session_id = ? ORDER BY realtime_ns, annotation_id");
  rows.bind(filter.session_id, filter.protocol_id);
  const People people(database);
  const auto wanted = people.named(filter.participant);
  while (rows.step()) {
    auto session = session_from(rows);
    const Bearer bearer{session.start.station_id, session.start.participant};
    if (!filter.participant.empty() && !is_among(bearer, wanted)) continue;
    session.person = people.label(bearer);
    notes.bind(session.session_id);
    while (notes.step()) session.annotations.push_back(notes.text(0));
    sessions.push_back(std::move(session));
  }
  const auto place = [](const SessionRecord& session) {
    return std::tie(session.person, session.start.protocol_id, session.session_index, session.session_id);
  };
  std::sort(sessions.begin(), sessions.end(),
            [&](const auto& a, const auto& b) { return place(a) < place(b); });
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
  return {std::move(sessions.front()), read_rows(database, segment_table(), session_id, "segment_index"),
          read_blocks(database, session_id), read_rows(database, event_table(), session_id, "event_index")};
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
    if (newest && !newer(session, newest->session)) continue;
    const auto age_ns = realtime_ns() - session.last_activity_realtime_ns;
    newest = Interrupted{std::move(session), static_cast<double>(age_ns) * 1e-9};
  }
  return newest;
}

}  // namespace turnpoint::store

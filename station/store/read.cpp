#include "station/store/read.hpp"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "station/store/fields.hpp"
#include "station/store/open.hpp"
#include "station/store/people.hpp"
#include "station/store/rows.hpp"
#include "station/store/sqlite.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::store {

namespace {

enum class LongTexts { read, left_out };

/// Returns the tables from which a SessionRecord is read, in the order of the columns.
std::vector<Table<SessionRecord>> session_tables(LongTexts texts) {
  std::vector tables = {session_table(), protocol_table(), rig_table(), calibration_table()};
  const std::set<std::string> long_texts = {"text", "canonical"};
  for (auto& table : tables)
    if (texts == LongTexts::left_out)
      std::erase_if(table.fields, [&](const auto& field) { return long_texts.count(field.name) != 0; });
  return tables;
}

/// Reads single sessions by their keys, so that the whole table need not be read.
class SessionReader {
 public:
  SessionReader(Database& database, LongTexts texts)
      : people_(database),
        tables_(session_tables(texts)),
        rows_(database, sql(tables_)),
        notes_(database,
               "SELECT text FROM annotation WHERE session_id = ? ORDER BY realtime_ns, annotation_id") {}

  std::optional<SessionRecord> read(const std::string& session_id) {
    rows_.bind(session_id);
    if (!rows_.step()) return std::nullopt;
    auto session = from_row();
    rows_.reset();
    session.person = people_.label({session.start.station_id, session.start.participant});
    notes_.bind(session_id);
    while (notes_.step()) session.annotations.push_back(notes_.text(0));
    return session;
  }

  const People& people() const { return people_; }

 private:
  static std::string sql(const std::vector<Table<SessionRecord>>& tables) {
    std::string columns;
    for (const auto& table : tables) columns += column_list(table, std::string(table.name) + ".") + ", ";
    return "SELECT " + columns + R"sql(
  (SELECT count(*) FROM segment g WHERE g.session_id = session.session_id),
  (SELECT count(*) FROM trial t WHERE t.session_id = session.session_id),
  max((SELECT max(g.realtime_ns) FROM segment g WHERE g.session_id = session.session_id),
      coalesce((SELECT t.recorded_realtime_ns FROM trial t WHERE t.session_id = session.session_id
                ORDER BY t.trial_index DESC LIMIT 1), 0)),
  (SELECT l.sha256 FROM link l WHERE l.session_id = session.session_id ORDER BY l.link_index DESC LIMIT 1),
  coalesce((SELECT max(t.trial_id) FROM trial t WHERE t.session_id = session.session_id), 0),
  EXISTS (SELECT 1 FROM merged m WHERE m.session_id = session.session_id)
FROM session JOIN protocol USING (protocol_key) JOIN rig USING (rig_key) LEFT JOIN calibration USING (calibration_id)
WHERE session.session_id = ?
)sql";
  }

  SessionRecord from_row() const {
    SessionRecord session;
    session.session_id = rows_.text(0);
    int column = 0;
    for (const auto& table : tables_) {
      column += static_cast<int>(table.place.size());
      read_fields(rows_, table, column, session);
      column += static_cast<int>(table.fields.size());
    }
    session.segments = static_cast<int>(rows_.integer(column));
    session.trials = static_cast<int>(rows_.integer(column + 1));
    session.last_activity_realtime_ns = rows_.integer(column + 2);
    session.checksum = rows_.text(column + 3);
    session.last_trial_id = rows_.integer(column + 4);
    session.merged = rows_.integer(column + 5) != 0;
    return session;
  }

  People people_;
  std::vector<Table<SessionRecord>> tables_;
  Statement rows_, notes_;
};

/// Reads a session's rows from one table.
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

}  // namespace

std::vector<SessionRecord> list_sessions(Database& database, const SessionFilter& filter) {
  std::vector<SessionRecord> sessions;
  SessionReader reader(database, LongTexts::left_out);
  const auto wanted = reader.people().named(filter.participant);
  Statement rows(database,
                 "SELECT session_id, station_id, participant FROM session JOIN protocol USING "
                 "(protocol_key) WHERE ?1 IN ('', session_id) AND ?2 IN ('', protocol_id)");
  rows.bind(filter.session_id, filter.protocol_id);
  while (rows.step()) {
    if (!filter.participant.empty() && !is_among({rows.text(1), rows.text(2)}, wanted)) continue;
    if (auto session = reader.read(rows.text(0))) sessions.push_back(std::move(*session));
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

SessionRecord session_record(Database& database, const std::string& session_id) {
  auto session = SessionReader(database, LongTexts::read).read(session_id);
  if (!session)
    throw StoreError(ErrorKind::missing, "database " + database.path() + ": there is no session \"" +
                                             session_id + "\"; `turnpoint sessions` lists all sessions");
  return std::move(*session);
}

std::vector<std::string> participants(const std::string& path) {
  auto database = open_reader(path);
  std::vector<std::string> codes;
  Statement rows(database, "SELECT DISTINCT participant FROM session ORDER BY participant");
  while (rows.step()) codes.push_back(rows.text(0));
  return codes;
}

namespace {

/// Reads the events of a session in the order in which they were logged. Events of self-tests get their
/// checks, those of questionnaires their answer, those of friction tables their levels, and those of separate
/// programs what is stored about them.
std::vector<EventRow> read_events(Database& database, const std::string& id) {
  Statement rows(database, "SELECT " + column_list(event_table()) +
                               " FROM event WHERE session_id = ? ORDER BY event_index");
  Statement checks(database, "SELECT " + column_list(check_table()) +
                                 " FROM self_test WHERE session_id = ? ORDER BY event_index, check_index");
  Statement answers(database, "SELECT " + column_list(answer_table()) +
                                  " FROM answer WHERE session_id = ? ORDER BY event_index, answer_index");
  rows.bind(id);
  checks.bind(id);
  answers.bind(id);
  Statement levels(database,
                   "SELECT " + column_list(friction_level_table()) +
                       " FROM friction_level WHERE session_id = ? ORDER BY event_index, level_index");
  levels.bind(id);
  Statement programs(database, "SELECT " + column_list(program_table()) +
                                   " FROM program WHERE session_id = ? ORDER BY event_index, program_index");
  programs.bind(id);
  Statement estimates(database,
                      "SELECT " + column_list(estimate_table()) +
                          " FROM estimate WHERE session_id = ? ORDER BY event_index, estimate_index");
  estimates.bind(id);
  std::vector<EventRow> events;
  bool check_waits = checks.step(), answer_waits = answers.step(), level_waits = levels.step();
  bool program_waits = programs.step(), estimate_waits = estimates.step();
  while (rows.step()) {
    auto event = record_of(rows, event_table());
    for (; check_waits && checks.integer(1) == rows.integer(1); check_waits = checks.step())
      event.checks.push_back(record_of(checks, check_table()));
    for (; answer_waits && answers.integer(1) == rows.integer(1); answer_waits = answers.step())
      event.answers.push_back(record_of(answers, answer_table()));
    for (; level_waits && levels.integer(1) == rows.integer(1); level_waits = levels.step())
      event.friction_levels.push_back(record_of(levels, friction_level_table()));
    for (; program_waits && programs.integer(1) == rows.integer(1); program_waits = programs.step())
      event.programs.push_back(record_of(programs, program_table()));
    for (; estimate_waits && estimates.integer(1) == rows.integer(1); estimate_waits = estimates.step())
      event.estimates.push_back(record_of(estimates, estimate_table()));
    events.push_back(std::move(event));
  }
  return events;
}

}  // namespace

StoredSession read_session(Database& database, const SessionRecord& session) {
  const auto& id = session.session_id;
  return {session, read_rows(database, segment_table(), id, "segment_index"), read_blocks(database, id),
          read_events(database, id)};
}

StoredSession read_session(Database& database, const std::string& session_id) {
  return read_session(database, session_record(database, session_id));
}

StoredSession read_session(const std::string& path, const std::string& session_id) {
  auto database = open_reader(path);
  return read_session(database, session_id);
}

std::optional<Interrupted> interrupted_session(const std::string& path, const std::string& session_id) {
  auto database = open_reader(path);
  // Order by trial id, which increases with each stored trial. The wall clock may have been set back.
  Statement newest(
      database,
      "SELECT s.session_id, (SELECT max(trial_id) FROM trial t WHERE t.session_id = s.session_id) AS last"
      " FROM session s WHERE s.status IN ('interrupted', 'running') AND ?1 IN ('', s.session_id)"
      " AND last IS NOT NULL"
      " ORDER BY EXISTS (SELECT 1 FROM merged m WHERE m.session_id = s.session_id), last DESC LIMIT 1");
  newest.bind(session_id);
  if (!newest.step()) return std::nullopt;
  auto session = session_record(database, newest.text(0));
  const auto age_ns = system::realtime_ns() - session.last_activity_realtime_ns;
  return Interrupted{std::move(session), static_cast<double>(age_ns) * 1e-9};
}

}  // namespace turnpoint::store

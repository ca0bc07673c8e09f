#include "station/store/merge.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "station/store/backup.hpp"
#include "station/store/checksum.hpp"
#include "station/store/files.hpp"
#include "station/store/open.hpp"
#include "station/store/seal.hpp"
#include "station/store/station.hpp"
#include "station/store/verify.hpp"
#include "station/store/whole_file.hpp"
#include "station/store/withdraw.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::store {

namespace fs = std::filesystem;

namespace {

/// A table to be merged: its name and key, the columns that are not compared because each database has its
/// own values, and the SQL condition that selects the rows.
struct Part {
  std::string table, key, own_columns, incoming;
};

const std::string kBySession = "s.session_id IN (SELECT session_id FROM temp.incoming)";

/// Returns the tables to be merged. Each table comes after the tables to which it refers.
const std::vector<Part>& parts() {
  static const std::vector<Part> all = {
      {"participant", "code", "", "s.code IN (SELECT participant FROM temp.incoming)"},
      {"enrolment", "station_id,protocol_id,participant", "",
       "(s.station_id, s.participant) IN (SELECT station_id, participant FROM temp.incoming)"},
      {"same_person", "station_a,code_a,station_b,code_b", "realtime_ns",
       "(s.station_a, s.code_a) IN temp.bearer AND (s.station_b, s.code_b) IN temp.bearer"},
      {"protocol", "protocol_key", "", "s.protocol_key IN (SELECT protocol_key FROM temp.incoming)"},
      {"rig", "rig_key", "", "s.rig_key IN (SELECT rig_key FROM temp.incoming)"},
      {"calibration", "calibration_id", "", "s.calibration_id IN (SELECT calibration_id FROM temp.incoming)"},
      {"session", "session_id", "status,status_reason", kBySession},
      {"segment", "session_id,segment_index", "", kBySession},
      {"block", "session_id,block_index,attempt", "", kBySession},
      {"trial", "session_id,trial_index", "trial_id", kBySession},
      {"tone", "session_id,trial_index,interval_index,scene_index,tone_index", "", kBySession},
      {"signal", "session_id,trial_index,stream", "", kBySession},
      {"event", "session_id,event_index", "", kBySession},
      {"self_test", "session_id,event_index,check_index", "", kBySession},
      {"answer", "session_id,event_index,answer_index", "", kBySession},
      {"friction_level", "session_id,event_index,level_index", "", kBySession},
      {"program", "session_id,event_index,program_index", "", kBySession},
      {"estimate", "session_id,event_index,estimate_index", "", kBySession},
      {"link", "session_id,link_index", "", kBySession},
      {"annotation", "annotation_id", "", kBySession},
      {"renamed", "session_id,station_id", "", kBySession},
  };
  return all;
}

bool in_list(const std::string& name, const std::string& list) {
  return ("," + list + ",").find("," + name + ",") != std::string::npos;
}

std::vector<std::string> columns_of(Database& database, const std::string& table) {
  std::vector<std::string> names;
  Statement rows(database, "SELECT name FROM pragma_table_info(?)");
  rows.bind(table);
  while (rows.step()) names.push_back(rows.text(0));
  return names;
}

std::string same_key(const Part& part, const std::vector<std::string>& columns) {
  std::string condition;
  for (const auto& column : columns)
    if (in_list(column, part.key))
      condition += fmt::format("{}m.{} = s.{}", condition.empty() ? "" : " AND ", column, column);
  return condition;
}

/// Throws for the first row whose values differ between the two databases. Reads the table once and compares
/// all columns.
void refuse_conflicts(Database& database, const Part& part) {
  const auto columns = columns_of(database, part.table);
  std::string key, differs, values;
  std::vector<std::string> compared;
  for (const auto& column : columns) {
    if (in_list(column, part.key))
      key += fmt::format("{}'{} ' || s.{}", key.empty() ? "" : " || ', ' || ", column, column);
    if (in_list(column, part.key) || in_list(column, part.own_columns)) continue;
    compared.push_back(column);
    differs += fmt::format("{}m.{} IS NOT s.{}", differs.empty() ? "" : " OR ", column, column);
    values += fmt::format(", m.{0} IS NOT s.{0}, m.{0}, s.{0}", column);
  }
  if (compared.empty()) return;
  // Look up each incoming row in this database. Looking up each row of this database in the source would be
  // slow, because this database may be far larger.
  Statement rows(
      database,
      fmt::format("SELECT {}{} FROM source.{} s CROSS JOIN main.{} m ON {} WHERE {} AND ({}) LIMIT 1", key,
                  values, part.table, part.table, same_key(part, columns), part.incoming, differs));
  if (!rows.step()) return;
  for (int i = 0; i < static_cast<int>(compared.size()); ++i)
    if (rows.integer(3 * i + 1) != 0)
      throw StoreError(
          ErrorKind::conflict,
          fmt::format("merge: table {}, {}: {} is {} in this database and {} in the other; nothing was "
                      "merged; one of the "
                      "two databases was changed by hand, or the session was continued on both stations",
                      part.table, rows.text(0), compared[static_cast<std::size_t>(i)], rows.text(3 * i + 2),
                      rows.text(3 * i + 3)));
}

/// Throws if the two databases gave the same sequence index of the counterbalancing to different people. That
/// happens if two stations use the same station name.
void refuse_shared_places(Database& database) {
  Statement rows(
      database,
      "SELECT s.station_id, s.protocol_id, s.sequence_index, m.participant, s.participant"
      " FROM source.enrolment s JOIN main.enrolment m USING (station_id, protocol_id, sequence_index)"
      " WHERE s.participant <> m.participant"
      " AND (s.station_id, s.participant) IN (SELECT station_id, participant FROM temp.incoming) LIMIT 1");
  if (rows.step())
    throw StoreError(ErrorKind::conflict,
                     fmt::format("merge: table enrolment: station {} has given place {} of protocol "
                                 "{} to {} in this database and to {} in the other; nothing was merged; two "
                                 "stations use the same name",
                                 rows.text(0), rows.integer(2), rows.text(1), rows.text(3), rows.text(4)));
}

void copy_rows(Database& database, const Part& part) {
  const auto columns = columns_of(database, part.table);
  std::string list;
  for (const auto& column : columns)
    if (column != "trial_id") list += (list.empty() ? "" : ", ") + column;
  database.execute(fmt::format(
      "INSERT INTO main.{} ({}) SELECT {} FROM source.{} s WHERE {} AND NOT EXISTS (SELECT 1 "
      "FROM main.{} m WHERE {}) ORDER BY {}",
      part.table, list, list, part.table, part.incoming, part.table, same_key(part, columns), part.key));
}

std::int64_t trials_of(Database& database, const std::string& schema, const std::string& id) {
  Statement rows(database, "SELECT count(*) FROM " + schema + ".trial WHERE session_id = ?");
  rows.bind(id).step();
  return rows.integer(0);
}

std::vector<MergedSession> list_incoming(Database& database) {
  std::vector<MergedSession> sessions;
  Statement rows(
      database,
      "SELECT session_id, participant, protocol_id, station_id, session_id IN (SELECT session_id FROM"
      " main.tombstone), session_id IN (SELECT session_id FROM main.session)"
      " FROM source.session JOIN source.protocol USING (protocol_key) ORDER BY participant, session_id");
  while (rows.step()) {
    MergedSession session{
        rows.text(0), rows.text(1), rows.text(2), rows.text(3), "", MergedSession::What::added, 0};
    if (rows.integer(4) != 0 || is_withdrawn(database, {session.station_id, session.participant}))
      session.what = MergedSession::What::withdrawn;
    else if (rows.integer(5) != 0)
      session.what = MergedSession::What::unchanged;
    sessions.push_back(std::move(session));
  }
  return sessions;
}

[[noreturn]] void refuse_source(const std::string& source, const std::string& problem) {
  throw StoreError(ErrorKind::corrupt,
                   fmt::format("merge: {}: {}; nothing was merged; `turnpoint verify --db {}` lists all "
                               "differences; merge a backup of that station instead",
                               source, problem, source));
}

/// Throws if the copy of `source` was changed after it was recorded. Such changes must not spread to other
/// databases.
void refuse_changed(const std::string& copy, const std::string& source) {
  auto database = open_reader(copy);
  for (const auto& session : verify_database(database))
    if (!session.problems.empty())
      refuse_source(source, fmt::format("session {} of {}: {}", session.session_id, session.participant,
                                        session.problems.front()));
  if (const auto problems = file_problems(database); !problems.empty())
    refuse_source(source, problems.front());
}

/// Copies a session's status from `source`. Call this if the rows of the session in `source` are newer.
void take_status(Database& database, const std::string& id) {
  Statement(
      database,
      "UPDATE main.session SET (status, status_reason) = (SELECT status, status_reason FROM source.session s"
      " WHERE s.session_id = ?1) WHERE session_id = ?1")
      .bind(id)
      .run();
}

void settle(Database& database, MergedSession& session, std::int64_t trials_before,
            const std::string& before) {
  const auto& id = session.session_id;
  const auto there = session_checksum(database, "source", id);
  session.sha256 = session_checksum(database, "main", id);
  session.trials = trials_of(database, "main", id) - trials_before;
  if (session.what == MergedSession::What::unchanged && session.sha256 != before)
    session.what = MergedSession::What::extended;
  if (session.what == MergedSession::What::added && session.sha256 != there)
    throw StoreError(ErrorKind::corrupt, fmt::format("merge: session {} differs when it is read back after "
                                                     "the merge; nothing was merged; check the disk",
                                                     id));
  if (session.what == MergedSession::What::unchanged) return;
  if (session.sha256 == there) take_status(database, id);
  Statement(
      database,
      "INSERT OR IGNORE INTO main.merged SELECT ?, ?, value, ? FROM source.meta WHERE key = 'database_id'")
      .bind(id, session.sha256, system::realtime_ns())
      .run();
}

MergeReport merge_attached(Database& database) {
  MergeReport report;
  SealedTransaction transaction(database);
  report.sessions = list_incoming(database);
  Statement gone(database, "SELECT session_id FROM source.tombstone JOIN main.session USING (session_id)");
  while (gone.step()) report.withdrawn_there.push_back(gone.text(0));
  Statement incoming(database,
                     "INSERT INTO temp.incoming SELECT session_id, station_id, participant, protocol_key, "
                     "rig_key, calibration_id"
                     " FROM source.session WHERE session_id = ?");
  std::vector<std::pair<std::int64_t, std::string>> before;
  for (const auto& session : report.sessions) {
    if (session.what != MergedSession::What::withdrawn) incoming.bind(session.session_id).run();
    before.emplace_back(trials_of(database, "main", session.session_id),
                        session_checksum(database, "main", session.session_id));
  }
  database.execute(
      "INSERT INTO temp.bearer SELECT station_id, participant FROM main.session"
      " UNION SELECT station_id, participant FROM temp.incoming");
  refuse_two_machines(database);
  refuse_shared_places(database);
  for (const auto& part : parts()) refuse_conflicts(database, part);
  for (const auto& part : parts()) copy_rows(database, part);
  for (std::size_t i = 0; i < report.sessions.size(); ++i)
    if (report.sessions[i].what != MergedSession::What::withdrawn)
      settle(database, report.sessions[i], before[i].first, before[i].second);
  transaction.commit();
  return report;
}

/// A private, checked copy of the source, so that a session that is writing to the source does not affect the
/// merge.
class SourceCopy {
 public:
  SourceCopy(const std::string& source, const std::string& beside) : path_(beside + ".merging") {
    verify_checksum_file(source);
    auto reader = open_reader(source);
    check_pages(reader);
    copy_to_file(reader, path_, source);
  }
  SourceCopy(const SourceCopy&) = delete;
  SourceCopy& operator=(const SourceCopy&) = delete;
  ~SourceCopy() {
    try {
      remove_database(path_);
    } catch (const StoreError&) {
      // If removing fails, the next process that writes to this database removes the copy.
    }
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

const char* name(MergedSession::What what) {
  switch (what) {
    case MergedSession::What::added:
      return "added";
    case MergedSession::What::extended:
      return "extended";
    case MergedSession::What::unchanged:
      return "unchanged";
    case MergedSession::What::withdrawn:
      return "withdrawn";
  }
  return "";
}

MergeReport merge(const std::string& name, const std::string& source) {
  const auto path = canonical(name);
  if (fs::exists(source) && fs::exists(path) && fs::equivalent(source, path))
    throw StoreError(ErrorKind::refused, fmt::format("merge: {} and {} are the same file", path, source));
  auto writer = open_writer(path, IfMissing::create);
  auto& database = writer.database;
  check_pages(database);
  const SourceCopy copy(source, path);
  refuse_changed(copy.path(), source);
  Statement(database, "ATTACH ? AS source").bind(copy.path()).run();
  database.execute(
      "CREATE TEMP TABLE incoming (session_id, station_id, participant, protocol_key, rig_key, "
      "calibration_id);"
      "CREATE TEMP TABLE bearer (station_id, code)");
  return merge_attached(database);
}

}  // namespace turnpoint::store

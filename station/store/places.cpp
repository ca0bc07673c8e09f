#include "station/store/places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "station/store/open.hpp"
#include "station/store/read.hpp"
#include "station/store/seal.hpp"
#include "station/store/sqlite.hpp"

namespace turnpoint::store {

namespace {

std::vector<std::int64_t> integers(Statement& rows) {
  std::vector<std::int64_t> list;
  while (rows.step()) list.push_back(rows.integer(0));
  return list;
}

}  // namespace

std::optional<int> session_done(const SessionRecord& session, const Assignment& assignment) {
  const bool unfinished = session.status != SessionStatus::running && session.trials > 0;
  const int number = assignment.sessions == 1 ? 1 : session.start.planned_session.value_or(0);
  if (session.status != SessionStatus::completed && !(assignment.incomplete_count && unfinished))
    return std::nullopt;
  return number >= 1 && number <= assignment.sessions ? std::optional(number) : std::nullopt;
}

std::vector<Participation> participations(Database& database, const std::string& protocol_id, RunMode mode,
                                          const Assignment& assignment, std::int64_t now_ns) {
  struct Person {
    std::set<int> done;  ///< numbers of the planned sessions
    bool running = false;
    std::pair<std::int64_t, std::string> last;  ///< time and id of the newest session
    std::int64_t place = 0;
  };
  std::map<std::string, Person> persons;
  for (const auto& session : list_sessions(database, {"", "", protocol_id})) {
    if (session.start.run_mode != mode) continue;
    auto& person = persons[session.person];
    if (const auto number = session_done(session, assignment)) person.done.insert(*number);
    person.running = person.running || session.status == SessionStatus::running;
    const std::pair last(session.last_activity_realtime_ns, session.session_id);
    if (last >= person.last) person.last = last, person.place = session.sequence_index;
  }
  std::vector<Participation> list;
  for (const auto& [name, person] : persons) {
    const auto age_h = static_cast<double>(now_ns - person.last.first) / 3.6e12;
    list.push_back(
        {person.place, static_cast<int>(person.done.size()) >= assignment.sessions ? Progress::completed
                       : person.running || age_h < assignment.dropout_after_h      ? Progress::expected
                                                                                   : Progress::dropped_out});
  }
  return list;
}

std::optional<std::int64_t> choose_place(const std::vector<std::int64_t>& used,
                                         const std::optional<std::vector<std::int64_t>>& leased,
                                         const std::map<std::int64_t, std::int64_t>& held,
                                         std::int64_t rows) {
  const auto held_in_row_of = [&](std::int64_t place) {
    const auto row = held.find(place % rows);
    return row == held.end() ? 0 : row->second;
  };
  const auto is_free = [&](std::int64_t place) {
    return !std::binary_search(used.begin(), used.end(), place);
  };
  if (leased) {
    std::optional<std::int64_t> best;
    for (const auto place : *leased)
      if (is_free(place) &&
          (!best || std::pair(held_in_row_of(place), place) < std::pair(held_in_row_of(*best), *best)))
        best = place;
    return best;
  }
  std::int64_t fewest = 0;
  if (static_cast<std::int64_t>(held.size()) == rows)
    fewest = std::min_element(held.begin(), held.end(), [](const auto& a, const auto& b) {
               return a.second < b.second;
             })->second;
  std::int64_t place = 0;
  while (!is_free(place) || held_in_row_of(place) != fewest) ++place;
  return place;
}

std::int64_t next_place(Database& database, const SessionStart& start, std::int64_t now_ns) {
  const auto& protocol_id = start.protocol_id;
  Statement leases(database, "SELECT sequence_index FROM lease WHERE protocol_id = ?");
  leases.bind(protocol_id);
  const auto leased = integers(leases);
  std::map<std::int64_t, std::int64_t> held;
  std::int64_t rows = 1;
  if (start.assignment) {
    rows = start.assignment->rows;
    for (const auto& one : participations(database, protocol_id, start.run_mode, *start.assignment, now_ns))
      if (one.progress != Progress::dropped_out) ++held[one.place % rows];
  }
  const auto place = choose_place(used_places(database, protocol_id),
                                  leased.empty() ? std::nullopt : std::optional(leased), held, rows);
  if (place) return *place;
  throw StoreError(
      ErrorKind::refused,
      fmt::format(
          "database {}: all {} places in the design of protocol {} that the collector leased to this "
          "station are taken; lease more with turnpoint push --places {}=N, or end the sharing of the "
          "design with turnpoint push --return-places {}",
          database.path(), leased.size(), protocol_id, protocol_id, protocol_id));
}

bool is_leased(Database& database, const SessionStart& start, std::int64_t place) {
  Statement now(database, "SELECT 1 FROM lease WHERE protocol_id = ? AND sequence_index = ?");
  if (now.bind(start.protocol_id, place).step()) return true;
  Statement earlier(
      database,
      "SELECT 1 FROM session JOIN protocol USING (protocol_key) WHERE protocol_id = ? AND station_id = ?"
      " AND participant = ? AND sequence_index = ? AND leased_place");
  return earlier.bind(start.protocol_id, start.station_id, start.participant, place).step();
}

void set_leased_places(const std::string& path, const std::string& protocol_id,
                       const std::vector<std::int64_t>& places) {
  {
    auto reader = open_reader(path);
    Statement rows(reader, "SELECT sequence_index FROM lease WHERE protocol_id = ? ORDER BY sequence_index");
    rows.bind(protocol_id);
    if (integers(rows) == places) return;
  }
  auto writer = open_writer(path, IfMissing::fail);
  SealedTransaction transaction(writer.database);
  Statement(writer.database, "DELETE FROM lease WHERE protocol_id = ?").bind(protocol_id).run();
  Statement insert(writer.database, "INSERT INTO lease VALUES (?,?)");
  for (const auto place : places) insert.bind(protocol_id, place).run();
  transaction.commit();
}

std::vector<std::int64_t> used_places(Database& database, const std::string& protocol_id) {
  Statement rows(
      database,
      "SELECT DISTINCT sequence_index FROM enrolment WHERE protocol_id = ? ORDER BY sequence_index");
  rows.bind(protocol_id);
  return integers(rows);
}

std::vector<std::int64_t> give_up_places(const std::string& path, const std::string& protocol_id) {
  auto writer = open_writer(path, IfMissing::fail);
  SealedTransaction transaction(writer.database);
  Statement free(writer.database,
                 "SELECT sequence_index FROM lease WHERE protocol_id = ?1 AND sequence_index NOT IN"
                 " (SELECT sequence_index FROM enrolment WHERE protocol_id = ?1) ORDER BY sequence_index");
  free.bind(protocol_id);
  auto places = integers(free);
  Statement(writer.database, "DELETE FROM lease WHERE protocol_id = ?").bind(protocol_id).run();
  transaction.commit();
  return places;
}

}  // namespace turnpoint::store

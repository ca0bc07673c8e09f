#include "station/collector/push.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "station/collector/postgres.hpp"
#include "station/collector/received.hpp"
#include "station/collector/row_stream.hpp"
#include "station/collector/tables.hpp"
#include "station/store/checksum.hpp"
#include "station/store/open.hpp"
#include "station/store/people.hpp"
#include "station/store/places.hpp"
#include "station/store/read.hpp"
#include "station/store/schema.hpp"
#include "station/store/station.hpp"

namespace turnpoint::collector {

namespace {

using store::Database;
using store::Statement;
using What = PushedSession::What;

/// What the server already has of a session.
struct Known {
  store::Link last;
  std::int64_t annotations = 0;
  std::string station, machine;
};

/// Checks the version of the server. Returns the stations whose sessions this connection may send.
std::set<std::string> greet(Connection& server) {
  std::optional<Rows> rows;
  try {
    rows.emplace(server.query("SELECT schema, station_id FROM turnpoint.hello()"));
  } catch (const ServerError& error) {
    const std::set<std::string> absent = {"3F000", "42883", "42P01", "42501"};
    if (absent.count(error.state()) == 0) throw;
    throw ServerError(
        std::string(error.what()) +
            "; this is not a collector's database, or this role is not a station's; deploy/collector sets up "
            "both",
        error.state());
  }
  const auto schema = rows->count() > 0 ? rows->integer(0, 0) : 0;
  if (schema != store::kSchema)
    throw ServerError(
        fmt::format("collector: the server has schema {}, this station {}; nothing was sent; {}", schema,
                    store::kSchema,
                    schema < store::kSchema ? "update the server first: deploy/collector upgrade"
                                            : "update Turnpoint on this station"),
        "");
  std::set<std::string> stations;
  for (int i = 0; i < rows->count(); ++i)
    if (!rows->is_null(i, 1)) stations.insert(rows->text(i, 1));
  return stations;
}

/// Sends the tombstones of this database, and the ids of the sessions of other stations that it has a copy
/// of. Returns the server's tombstones of this station and of those sessions.
std::vector<store::Tombstone> exchange_tombstones(Connection& server,
                                                  const std::vector<store::Tombstone>& own,
                                                  const std::vector<std::string>& held) {
  const auto rows = server.query(
      "SELECT session_id, salt, participant_sha256, withdrawn_realtime_ns, station_id"
      " FROM turnpoint.exchange_tombstones($1::json, $2::json)",
      {tombstones_json(own), nlohmann::json(held).dump()});
  std::vector<store::Tombstone> theirs;
  for (int i = 0; i < rows.count(); ++i)
    theirs.push_back(
        {rows.text(i, 0), rows.text(i, 1), rows.text(i, 2), rows.integer(i, 3), rows.text(i, 4)});
  return theirs;
}

std::map<std::string, Known> known_sessions(Connection& server) {
  const auto rows = server.query(
      "SELECT session_id, link_index, sha256, last_segment, last_block, last_trial, last_event, status,"
      " status_reason, annotations, station_id, machine FROM turnpoint.chains()");
  std::map<std::string, Known> known;
  for (int i = 0; i < rows.count(); ++i) {
    auto& it = known[rows.text(i, 0)];
    it.last.index = rows.integer(i, 1);
    it.last.sha256 = rows.text(i, 2);
    it.last.last = {rows.integer(i, 3), rows.integer(i, 4), rows.integer(i, 5), rows.integer(i, 6)};
    it.last.status = rows.text(i, 7);
    it.last.status_reason = rows.text(i, 8);
    it.annotations = rows.integer(i, 9);
    it.station = rows.text(i, 10);
    it.machine = rows.text(i, 11);
  }
  return known;
}

/// Throws if two stations have one name: the server has a session of this station from a machine of which
/// this database holds none, although it holds sessions of the same station from another. (A machine that
/// replaced the station's earlier one holds what that one had recorded.)
void refuse_two_stations(Database& database, const std::map<std::string, Known>& known) {
  std::map<std::string, std::set<std::string>> machines;
  Statement rows(database,
                 "SELECT DISTINCT station_id, machine FROM session JOIN segment USING (session_id) WHERE"
                 " machine <> ''");
  while (rows.step()) machines[rows.text(0)].insert(rows.text(1));
  for (const auto& [id, session] : known) {
    const auto here = machines.find(session.station);
    if (session.machine.empty() || here == machines.end() || here->second.count(session.machine) != 0)
      continue;
    throw ServerError(
        fmt::format(
            "collector: another machine sends its sessions as station {}, so one code can mean two people; "
            "nothing was sent; give one of the two stations another name, on its own machine: turnpoint "
            "station-name --db {} NEW-NAME --stored, and then let it join under that name (deploy/collector "
            "station)",
            session.station, database.path()),
        "TP005");
  }
}

std::int64_t value_of(const store::Link& link, const std::string& column) {
  if (column == "last_segment") return link.last.segment;
  if (column == "last_block") return link.last.block;
  return column == "last_trial" ? link.last.trial : link.last.event;
}

/// Sends the rows of one table that belong to a session and that the server does not have. In the SQL, ?1 is
/// the session, and ?2 is the last value of the counter that the server has.
std::int64_t send_table(Database& database, const CollectedTable& table, const store::SessionRecord& session,
                        const store::Link& last, Connection& server) {
  std::string where = "session_id = ?1";
  std::int64_t beyond = last.index;
  if (table.name == "enrolment")
    where = "(station_id, participant) = (SELECT station_id, participant FROM session WHERE session_id = ?1)";
  for (const auto* key : {"protocol_key", "rig_key", "calibration_id"})
    if (table.key.front() == key) {
      // Protocol, rig and calibration were sent with the session's first rows.
      if (last.index >= 0) return 0;
      where = fmt::format("{0} = (SELECT {0} FROM session WHERE session_id = ?1)", key);
    }
  if (table.name == "link") where += " AND link_index > ?2";
  if (table.chain) {
    where += fmt::format(" AND {} > ?2", table.chain->counter);
    beyond = value_of(last, table.chain->last);
  }
  Statement rows(database, fmt::format("SELECT {} FROM {} WHERE {} ORDER BY {}", column_list(table),
                                       table.name, where, quoted_list(table.key)));
  rows.bind_value(1, session.session_id);
  if (where.find("?2") != std::string::npos) rows.bind_value(2, beyond);
  return send_rows(rows, table, server,
                   fmt::format("COPY pg_temp.incoming_{} ({}) FROM STDIN (FORMAT binary)", table.name,
                               column_list(table)));
}

/// Sends a session, or the rest of it, in one transaction. It is committed only if the server computes the
/// same checksums from its rows as this station.
void send_session(Database& database, const store::SessionRecord& session, const store::Link& last,
                  Connection& server, PushedSession& pushed) {
  const auto& id = session.session_id;
  ServerTransaction transaction(server);
  for (const auto& table : collected_tables()) {
    if (table.name == "tombstone" || table.name == "same_person") continue;
    const auto sent = send_table(database, table, session, last, server);
    if (table.name == "trial") pushed.trials = sent;
  }
  const auto stored =
      server.query("SELECT last_sha256, annotations_sha256 FROM turnpoint.store_session($1)", {id});
  if (stored.text(0, 0) != pushed.sha256 || stored.text(0, 1) != store::annotations_checksum(database, id))
    throw ServerError(
        fmt::format("collector: session {}: the server computed other checksums for it; nothing was stored",
                    id),
        "TP001");
  transaction.commit();
}

/// Returns the reason why the server's part of a session is not the beginning of the session in this
/// database; "" if it is.
std::string conflict_of(Database& database, const std::string& id, const store::Link& theirs) {
  const auto here = store::link_at(database, id, theirs.index);
  if (!here)
    return "the server has a longer part of this session: this database was restored from an older backup, "
           "or "
           "is an older copy";
  if (here->sha256 != theirs.sha256)
    return "the server has another continuation of this session: it was resumed in two copies of the "
           "database, "
           "or changed";
  return "";
}

/// True if an error with this SQLSTATE means that the server cannot store any other session either.
bool is_fatal(const std::string& state) {
  return state.empty() || state.starts_with("08") || state.starts_with("53") || state.starts_with("57") ||
         state.starts_with("58") || state.starts_with("XX");
}

PushedSession push_session(Database& database, const store::SessionRecord& session, const Known* known,
                           Connection& server) {
  const auto& id = session.session_id;
  PushedSession pushed{id, session.start.participant, session.start.station_id, What::refused, 0, "", ""};
  const auto verified = store::verify_session(database, id);
  pushed.sha256 = verified.last_sha256;
  if (!verified.problems.empty())
    pushed.problem = verified.problems.front();
  else if (known != nullptr)
    pushed.problem = conflict_of(database, id, known->last);
  if (!pushed.problem.empty()) return pushed;
  const auto annotations = static_cast<std::int64_t>(session.annotations.size());
  if (known != nullptr && known->last.sha256 == pushed.sha256 && known->annotations == annotations &&
      known->last.status == core::name(session.status) &&
      known->last.status_reason == session.status_reason) {
    pushed.what = What::unchanged;
    return pushed;
  }
  try {
    send_session(database, session, known != nullptr ? known->last : store::Link{}, server, pushed);
    pushed.what = known != nullptr ? What::extended : What::added;
  } catch (const ServerError& error) {
    if (is_fatal(error.state())) throw;
    pushed.problem = error.what();
    pushed.trials = 0;
  }
  return pushed;
}

/// Returns the rule by which the server chooses places; empty if it leases the lowest ones.
std::optional<std::string> rule_of(const PushOptions& options, const std::string& protocol_id,
                                   const std::set<std::string>& stations) {
  const auto rule = options.assignment ? options.assignment(protocol_id, stations) : std::nullopt;
  if (!rule) return std::nullopt;
  return nlohmann::json{{"dropout_after_h", rule->dropout_after_h},
                        {"rows", rule->rows},
                        {"sessions", rule->sessions},
                        {"incomplete_count", rule->incomplete_count}}
      .dump();
}

/// Asks the server for more places. Returns all that are leased to this station.
Rows query_places(Connection& server, const std::string& protocol_id, std::int64_t more,
                  const std::optional<std::string>& rule) {
  try {
    return server.query("SELECT place FROM turnpoint.lease_places($1, $2, $3) place",
                        {protocol_id, std::to_string(more), rule});
  } catch (const ServerError& error) {
    if (error.state() != "42883") throw;  // there is no function with these parameters
    throw ServerError(
        "collector: the server is older than this station; the sessions were sent, but no places of " +
            protocol_id + " were leased; update the server first: deploy/collector upgrade",
        error.state());
  }
}

/// Leases places in the counterbalancing until this station has as many free ones as the options want.
/// Returns all places that are leased to this station.
std::vector<std::int64_t> lease_places(Database& database, const std::string& protocol_id,
                                       const PushOptions& options, const std::set<std::string>& stations,
                                       Connection& server, PushReport& report) {
  const auto wanted = options.places.at(protocol_id);
  const auto rule = rule_of(options, protocol_id, stations);
  const auto used = store::used_places(database, protocol_id);
  std::vector<std::int64_t> leased;
  // The server's first answer lists the places in the counterbalancing that this station already has, even if
  // an earlier answer was lost on the way. The server may lease a place that is in use here, because it does
  // not know that participant yet. In that case, ask for a few more places.
  for (std::int64_t more = 0, free = 0;; more = wanted - free) {
    const auto rows = query_places(server, protocol_id, more, rule);
    if (more > 0 && rows.count() <= static_cast<int>(leased.size()))
      throw ServerError("collector: the server leases no more places of " + protocol_id, "");
    leased.clear();
    for (int i = 0; i < rows.count(); ++i) leased.push_back(rows.integer(i, 0));
    free = std::count_if(leased.begin(), leased.end(), [&](const auto place) {
      return !std::binary_search(used.begin(), used.end(), place);
    });
    report.places[protocol_id] = free;
    if (free >= wanted) return leased;
  }
}

std::vector<store::Tombstone> exchange_tombstones(const PushOptions& options,
                                                  const std::set<std::string>& stations, Connection& server,
                                                  PushReport& report) {
  auto reader = store::open_reader(options.database);
  const auto own = store::list_tombstones(reader);
  std::vector<std::string> held;
  for (const auto& session : store::list_sessions(reader))
    if (stations.count(session.start.station_id) == 0) held.push_back(session.session_id);
  auto theirs = exchange_tombstones(server, own, held);
  std::set<std::string> known;
  for (const auto& stone : theirs) known.insert(stone.session_id);
  for (const auto& stone : own)
    if (stations.count(stone.station_id) != 0 && known.count(stone.session_id) == 0)
      report.disputed.push_back(stone.session_id);
  return theirs;
}

void use(const Received& received, const PushOptions& options, PushReport& report) {
  if (!options.received.empty()) return write_received(received, options.received);
  try {
    auto withdrawn = carry_out(received, options.database, options.backup_directory);
    if (!withdrawn.sessions.empty()) report.withdrawn = std::move(withdrawn);
  } catch (const store::StoreError& error) {
    if (error.kind() != store::ErrorKind::busy) throw;
    report.waiting = error.what();
  }
}

/// Returns leased places to the server. Deletes them from this station's database first: only then may the
/// server lease them to another station.
void return_places(const PushOptions& options, Connection& server) {
  for (const auto& protocol_id : options.return_places) {
    std::string list;
    for (const auto place : store::give_up_places(options.database, protocol_id))
      list += (list.empty() ? "" : ",") + std::to_string(place);
    server.query("SELECT turnpoint.return_places($1, $2)", {protocol_id, "[" + list + "]"});
  }
}

}  // namespace

const char* name(PushedSession::What what) {
  switch (what) {
    case What::added:
      return "added";
    case What::extended:
      return "extended";
    case What::unchanged:
      return "unchanged";
    case What::refused:
      return "refused";
  }
  return "";
}

bool PushReport::complete() const {
  return waiting.empty() && unsent.empty() && disputed.empty() &&
         std::none_of(sessions.begin(), sessions.end(),
                      [](const auto& session) { return session.what == What::refused; });
}

namespace {

/// Sends the sessions in a snapshot of the database.
void push_sessions(Database& snapshot, const std::set<std::string>& stations, const Received& received,
                   Connection& server, PushReport& report) {
  std::set<std::string> withdrawn, foreign, unsent;
  for (const auto& stone : received.tombstones) withdrawn.insert(stone.session_id);
  server.query("SELECT turnpoint.prepare()");
  const auto known = known_sessions(server);
  for (const auto& session : store::list_sessions(snapshot)) {
    const auto& station = session.start.station_id;
    const auto it = known.find(session.session_id);
    if (withdrawn.count(session.session_id) != 0) continue;  // withdrawn, but not deleted here yet
    if (stations.count(station) == 0)
      (session.merged ? foreign : unsent).insert(station);
    else if (session.status == store::SessionStatus::running)
      ++report.running;
    else
      report.sessions.push_back(
          push_session(snapshot, session, it == known.end() ? nullptr : &it->second, server));
  }
  report.foreign.assign(foreign.begin(), foreign.end());
  report.unsent.assign(unsent.begin(), unsent.end());
}

}  // namespace

PushReport push(const PushOptions& options) {
  PushReport report;
  {  // A wrong file, or a copy of another machine's, is reported before the server is asked.
    auto reader = store::open_reader(options.database);
    store::require_own_machine(reader, store::machine_identity());
  }
  Connection server(options.to);
  const auto stations = greet(server);
  {
    auto reader = store::open_reader(options.database);
    refuse_two_stations(reader, known_sessions(server));
  }
  Received received;
  received.tombstones = exchange_tombstones(options, stations, server, report);
  use(received, options, report);
  Database snapshot("", Database::Access::create);
  {
    auto reader = store::open_reader(options.database);
    store::copy_database(reader, snapshot);
  }
  push_sessions(snapshot, stations, received, server, report);
  server.query("SELECT turnpoint.store_joins($1::json)", {joins_json(store::list_joins(snapshot))});
  // Lease places in the counterbalancing after sending the sessions, because the sessions tell the server
  // which places are taken.
  for (const auto& [protocol_id, wanted] : options.places)
    received.places[protocol_id] = lease_places(snapshot, protocol_id, options, stations, server, report);
  if (!received.places.empty()) use(received, options, report);
  return_places(options, server);
  return report;
}

}  // namespace turnpoint::collector

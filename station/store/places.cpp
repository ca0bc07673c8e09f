#include "station/store/places.hpp"

#include <fmt/format.h>

#include "station/store/open.hpp"
#include "station/store/seal.hpp"
#include "station/store/sqlite.hpp"

namespace turnpoint::store {

namespace {

std::vector<std::int64_t> integers(Statement& rows) {
  std::vector<std::int64_t> list;
  while (rows.step()) list.push_back(rows.integer(0));
  return list;
}

constexpr const char* kFreeLeases =
    "SELECT sequence_index FROM lease WHERE protocol_id = ?1 AND sequence_index NOT IN"
    " (SELECT sequence_index FROM enrolment WHERE protocol_id = ?1) ORDER BY sequence_index";

}  // namespace

std::int64_t next_place(Database& database, const std::string& protocol_id) {
  Statement leases(database, "SELECT count(*) FROM lease WHERE protocol_id = ?");
  leases.bind(protocol_id).step();
  if (leases.integer(0) > 0) {
    Statement free(database, kFreeLeases);
    if (free.bind(protocol_id).step()) return free.integer(0);
    throw StoreError(
        ErrorKind::refused,
        fmt::format(
            "database {}: all {} places in the design of protocol {} that the collector leased to this "
            "station are taken; lease more with turnpoint push --places {}=N, or end the sharing of the "
            "design with turnpoint push --return-places {}",
            database.path(), leases.integer(0), protocol_id, protocol_id, protocol_id));
  }
  std::int64_t place = 0;
  for (const auto taken : used_places(database, protocol_id))
    if (taken == place) ++place;
  return place;
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
  Statement free(writer.database, kFreeLeases);
  free.bind(protocol_id);
  auto places = integers(free);
  Statement(writer.database, "DELETE FROM lease WHERE protocol_id = ?").bind(protocol_id).run();
  transaction.commit();
  return places;
}

}  // namespace turnpoint::store

#include "station/collector/received.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "station/core/read_file.hpp"
#include "station/core/usage_error.hpp"
#include "station/store/places.hpp"
#include "station/system/write_file.hpp"

namespace turnpoint::collector {

namespace {

nlohmann::json to_json(const store::Tombstone& stone) {
  return {{"session_id", stone.session_id},
          {"salt", stone.salt},
          {"participant_sha256", stone.participant_sha256},
          {"withdrawn_realtime_ns", stone.withdrawn_realtime_ns},
          {"station_id", stone.station_id}};
}

}  // namespace

std::string tombstones_json(const std::vector<store::Tombstone>& tombstones) {
  auto list = nlohmann::json::array();
  for (const auto& stone : tombstones) list.push_back(to_json(stone));
  return list.dump();
}

std::string joins_json(const std::vector<store::Join>& joins) {
  auto list = nlohmann::json::array();
  for (const auto& join : joins)
    list.push_back({{"station_a", join.first.station_id},
                    {"code_a", join.first.code},
                    {"station_b", join.second.station_id},
                    {"code_b", join.second.code},
                    {"realtime_ns", join.realtime_ns}});
  return list.dump();
}

store::Withdrawal carry_out(const Received& received, const std::string& database,
                            const std::string& backup_directory) {
  auto withdrawal = store::follow_tombstones(database, received.tombstones, backup_directory);
  for (const auto& [protocol_id, places] : received.places)
    store::set_leased_places(database, protocol_id, places);
  return withdrawal;
}

void write_received(const Received& received, const std::string& path) {
  const nlohmann::json json = {{"tombstones", nlohmann::json::parse(tombstones_json(received.tombstones))},
                               {"places", received.places}};
  system::write_file(path, json.dump(1));
}

Received read_received(const std::string& path) {
  Received received;
  try {
    const auto json = nlohmann::json::parse(core::read_file(path));
    for (const auto& stone : json.at("tombstones"))
      received.tombstones.push_back({stone.at("session_id"), stone.at("salt"), stone.at("participant_sha256"),
                                     stone.at("withdrawn_realtime_ns"), stone.at("station_id")});
    received.places = json.at("places");
  } catch (const nlohmann::json::exception& error) {
    throw core::UsageError(
        fmt::format("{}: {}; name the file that `turnpoint push --received` wrote", path, error.what()));
  }
  return received;
}

}  // namespace turnpoint::collector

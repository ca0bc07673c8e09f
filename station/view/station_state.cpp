#include "station/view/station_state.hpp"

#include <fmt/format.h>

#include <exception>
#include <filesystem>

#include "station/session/self_test.hpp"
#include "station/store/error.hpp"
#include "station/store/session_log.hpp"
#include "station/store/station.hpp"
#include "station/system/condition.hpp"

namespace turnpoint::view {

namespace {

using core::phrase, core::plain;

const char* word_for(store::ErrorKind kind) {
  using store::ErrorKind;
  switch (kind) {
    case ErrorKind::disk_full:
      return "state.database_full";
    case ErrorKind::read_only:
      return "state.database_read_only";
    case ErrorKind::corrupt:
    case ErrorKind::not_a_database:
      return "state.database_damaged";
    case ErrorKind::other_machine:
      return "state.database_elsewhere";
    default:
      return "state.database_unusable";
  }
}

StationState::Sign database_sign(const std::string& database, StationState& state) {
  const char* word = "state.database_unusable";
  try {
    store::require_recordable(database);
    return {"database", true, phrase("state.database_good")};
  } catch (const store::StoreError& error) {
    word = word_for(error.kind());
    state.other_machine = error.kind() == store::ErrorKind::other_machine;
    state.refusal = core::phrase_of(error);
  } catch (const std::exception& error) {
    state.refusal = core::phrase_of(error);
  }
  return {"database", false, phrase(word)};
}

}  // namespace

StationState station_state(const std::string& database) {
  StationState state;
  state.signs.push_back(database_sign(database, state));
  const auto disk = system::read_disk(std::filesystem::absolute(database).parent_path().string());
  const bool roomy = session::judged(disk).verdict == core::Verdict::passed;
  state.signs.push_back({"disk", roomy,
                         disk.error.empty()
                             ? phrase("state.disk", {plain(fmt::format("{:.1f}", disk.free_MiB / 1024))})
                             : phrase("state.disk_unknown")});
  const auto clock = system::read_wall_clock();
  state.signs.push_back({"clock", clock.plausible,
                         phrase(!clock.plausible ? "state.clock_wrong"
                                : clock.steered  ? "state.clock_good"
                                                 : "state.clock_free")});
  try {
    state.station = store::station_name(database);
  } catch (const std::exception&) {  // the database cannot be read, which its sign says
    state.station = store::suggested_station_name();
  }
  return state;
}

}  // namespace turnpoint::view

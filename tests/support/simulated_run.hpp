#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "station/session/prepare.hpp"

namespace turnpoint {

/// Asks for a session of participant P01 on the thin plate, with a simulated observer.
inline session::RunRequest simulated_run(const std::string& protocol, const std::string& database,
                                         std::optional<std::uint64_t> seed = {}) {
  session::RunRequest request;
  request.protocol = protocol;
  request.rig = TURNPOINT_SOURCE_DIR "/tests/support/thin_plate.toml";
  request.participant = "P01";
  request.database = database;
  request.observer = "sim";
  request.seed = seed;
  return request;
}

}  // namespace turnpoint

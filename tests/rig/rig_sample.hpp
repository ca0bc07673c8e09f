#pragma once
#include <string>

#include "station/core/read_file.hpp"
#include "station/core/toml.hpp"
#include "station/rig/rig.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/replaced.hpp"

namespace turnpoint::rig_sample {

inline const std::string simulated = std::string(TURNPOINT_SOURCE_DIR) + "/deploy/rigs/simulated.toml";

/// Returns a rig file into which the tests put mistakes.
inline std::string source() {
  return core::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/tests/support/thin_plate.toml");
}

/// Replaces `from` by `to` in the rig file, and returns the problems that are reported, one per line.
inline std::string problems(const std::string& from, const std::string& to) {
  try {
    rig::parse(replaced(source(), from, to), "r.toml");
    return "";
  } catch (const core::BadInput& error) {
    return error.what();
  }
}

inline bool contains(const std::string& all, const std::string& part) {
  return all.find(part) != std::string::npos;
}

}  // namespace turnpoint::rig_sample

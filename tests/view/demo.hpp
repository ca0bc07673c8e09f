#pragma once
#include <string>
#include <utility>
#include <vector>

#include "station/session/prepare.hpp"
#include "tests/support/simulated_run.hpp"
#include "tests/support/temporary_folder.hpp"

// Helpers for tests of what the operator is shown.
namespace turnpoint {

inline const std::string kSource = TURNPOINT_SOURCE_DIR;

/// The value of the fact with this label; "" if there is none.
inline std::string value_of(const std::vector<std::pair<std::string, std::string>>& facts,
                            const std::string& label) {
  for (const auto& [name, value] : facts)
    if (name == label) return value;
  return "";
}

/// A simulated session of the demo, stored in this folder.
inline session::RunRequest demo_in(const TemporaryFolder& folder) {
  auto request = simulated_run(kSource + "/protocols/demo.toml", folder / "a.sqlite", 4);
  request.participant = "P09";
  return request;
}

}  // namespace turnpoint

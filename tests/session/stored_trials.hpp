#pragma once
#include <fstream>
#include <string>
#include <vector>

#include "station/store/read.hpp"
#include "tests/support/temporary_folder.hpp"

namespace turnpoint {

/// Writes a protocol into the folder, and returns its path.
inline std::string written(const TemporaryFolder& folder, const std::string& text) {
  std::ofstream(folder / "p.toml") << text;
  return folder / "p.toml";
}

/// All trials of a session, in order.
inline std::vector<core::TrialRow> trials_of(const std::string& database, const std::string& session) {
  std::vector<core::TrialRow> trials;
  for (const auto& block : store::read_session(database, session).blocks)
    trials.insert(trials.end(), block.trials.begin(), block.trials.end());
  return trials;
}

}  // namespace turnpoint

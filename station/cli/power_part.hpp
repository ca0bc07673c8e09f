#pragma once
#include <string>
#include <vector>

#include "station/cli/json.hpp"
#include "station/simulation/cue_guard.hpp"
#include "station/simulation/power_session.hpp"

namespace turnpoint::cli {

/// The simulated sessions of one part of a power study, and all that is needed to join it with the others. It
/// is kept in a JSON file. Joined parts give the result that one machine would have had, to the last bit.
struct PowerPart {
  std::string protocol;  ///< the text of the protocol file
  std::string path;      ///< path of the protocol file, for messages
  std::string observer;  ///< the simulated observer as the user wrote it
  simulation::PowerOptions options;
  std::vector<simulation::SessionOutcome> sessions;
  /// for each unwanted cue, what an observer could achieve with it alone; set in the first part only
  std::vector<simulation::CueReport> cues;
  bool whole = true;  ///< false if a signal stopped the work
};

Json to_json(const PowerPart& part);

/// Reads the files of all parts of a study, in any order, and joins them into one. Throws UsageError if a
/// file is not such a part, or if a part is incomplete, is missing, appears twice, or belongs to another
/// study.
PowerPart join_parts(const std::vector<std::string>& files);

}  // namespace turnpoint::cli

#pragma once
#include <string>
#include <vector>

#include "station/core/texts.hpp"

namespace turnpoint::view {

/// What the operator has to know about the station before a session, so that a participant never meets it: a
/// sign for the database, the disk and the clock. (The backup has a note of its own, choices.hpp.)
struct StationState {
  struct Sign {
    std::string name;  ///< database | disk | clock
    bool good = true;
    core::Phrase says;  ///< a few words
  };
  std::string station;  ///< the name under which it records
  /// true if the database was recorded on another machine, and somebody has to say what happened
  bool other_machine = false;
  std::vector<Sign> signs;
  /// why no session can be recorded, as a sentence; says nothing if one can
  core::Phrase refusal;
};

/// Reads the state. Takes up to a second if the database is large, so call it on a worker thread. Never
/// throws.
StationState station_state(const std::string& database);

}  // namespace turnpoint::view

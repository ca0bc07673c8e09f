#pragma once
#include <string>

namespace turnpoint::setup {

/// The options of `turnpoint station`, with defaults filled in.
struct StationRequest {
  std::string protocols;  ///< the folder with the protocols
  std::string rig, database;
  bool locked = false;  ///< also ask for the operator's code before the start page
};

}  // namespace turnpoint::setup

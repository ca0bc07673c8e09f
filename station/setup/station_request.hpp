#pragma once
#include <string>

namespace turnpoint::setup {

/// The options of `turnpoint station`, with defaults filled in.
struct StationRequest {
  std::string protocols;  ///< path of the folder with the protocols
  std::string rig, database;
  bool locked = false;      ///< true if the operator's code must be entered before the start page
  bool fullscreen = false;  ///< fill the whole screen, also on a desktop
};

}  // namespace turnpoint::setup

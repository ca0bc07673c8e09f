#pragma once
#include <string>

namespace turnpoint::app {

/// What `turnpoint station` was asked for; everything is filled in before a screen gets it.
struct StationRequest {
  std::string protocols;  ///< folder
  std::string rig, database;
  bool locked = false;  ///< the start page stands behind the code from the beginning on
};

/// The station's own database: in the user's data folder ($XDG_DATA_HOME, else ~/.local/share).
std::string default_database();

}  // namespace turnpoint::app

#pragma once
#include <string>

namespace turnpoint::setup {

/// What `turnpoint station` was asked for; everything is filled in before a screen gets it.
struct StationRequest {
  std::string protocols;  ///< folder
  std::string rig, database;
  bool locked = false;  ///< the start page stands behind the code from the beginning on
};

}  // namespace turnpoint::setup

#pragma once
#include <string>

namespace turnpoint::setup {

/// The options of `turnpoint station`. All of them are filled in before a screen gets them.
struct StationRequest {
  std::string protocols;  ///< folder
  std::string rig, database;
  bool locked = false;  ///< ask for the code before the start page too
};

}  // namespace turnpoint::setup

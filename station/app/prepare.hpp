#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "station/session/session.hpp"

namespace turnpoint::app {

/// What `turnpoint run` was asked for, as typed.
struct RunRequest {
  std::string protocol, rig, participant, database;
  std::string mode = "pilot";  ///< live | pilot
  std::string language;        ///< "" takes the protocol's first
  std::string observer;        ///< "" for a person
  std::optional<std::uint64_t> seed;
  std::string consent_version;         ///< of the consent form, "" where none is asked for
  std::string operator_code = "2468";  ///< opens the operator's view where it shares the participant's screen
  bool headless = false, buttons_only = false;
};

/// Loads and checks everything that a sitting needs. Throws text::BadInput with all problems of both files,
/// of the protocol on this rig, of participant code, language and mode.
session::Setup prepare(const RunRequest& request);

}  // namespace turnpoint::app

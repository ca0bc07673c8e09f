#pragma once
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/protocol/survey.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/sound.hpp"
#include "station/scene/under_finger.hpp"
#include "station/simulation/cue_guard.hpp"

namespace turnpoint::simulation {

/// The median of a number over simulated sessions, and the range that contains nine of ten sessions.
struct Spread {
  double low = 0, median = 0, high = 0;
};

/// A block as a participant will run it.
struct CheckedBlock {
  std::string name, instruction;
  bool practice = false;
  Spread trials;
};

/// The result of `turnpoint check` for a protocol on a rig.
struct Check {
  /// problems of both files and of their combination; if there are any, all other members are empty
  std::vector<text::Problem> problems;
  std::vector<text::Problem> warnings;
  std::vector<text::Problem> notes;  ///< remarks of little importance, which do not count as warnings
  std::string id, title, rig_name;
  std::vector<CheckedBlock> blocks;
  Spread trials, duration_s;
  int simulated_sessions = 0;
  protocol::Survey survey;
  CueGuard cues;
  /// upper limit of the airborne sound level for the loudest combination of factors; empty if
  /// CheckOptions::sound is false or if no limit is known for this rig
  std::optional<scene::SoundBound> sound;
  /// fraction of the displacement that remains under a finger, at the last maxima of the lowest and the
  /// highest tone; empty if CheckOptions::finger is false or there are no last maxima
  std::optional<scene::FingerShares> finger;
  std::vector<std::string> protocol_defaults, rig_defaults;
};

/// What `turnpoint check` computes besides planning every scene of the protocol.
struct CheckOptions {
  /// number of sessions to simulate, to estimate the number of trials and the duration; 0: none
  int sessions = 21;
  /// also compute the upper limit of the airborne sound level, which takes about 10 ms per tone
  bool sound = false;
  /// also compute the fraction of the displacement that remains under a finger, for the lowest and the
  /// highest tone
  bool finger = false;
};

/// Reads and checks both files as `run` would. Throws std::system_error if one cannot be read, and
/// protocol::Abandoned soon after `stop` is requested.
Check check(const std::string& protocol_path, const std::string& rig_path, const CheckOptions& options = {},
            const std::stop_token& stop = {});

}  // namespace turnpoint::simulation

#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::tests {

struct BruteForce {
  std::string cue;
  double accuracy = 0, chance = 0, error = 0;  ///< and the standard error of the accuracy
  /// Where levels follow right answers: how much more is right in sessions that the observer does by itself
  /// than with one key or by guessing in the same trials, and its standard error.
  std::optional<double> own_gain = {};
  double own_error = 0;
};

/// What an observer of each cue reaches, found out by doing it: the director makes whole sessions, each scene
/// of each trial is planned for its own factors and takes the strength that was drawn, and the observer
/// answers them all, trying every rule. The rule is chosen on other trials than those that say what it
/// reaches. A level that follows the answers is any that can be presented, drawn at random; where it follows
/// right answers, sessions come after that in which the observer's own answers lead to the next level.
/// Nothing here is shared with the guard that is tested.
std::vector<BruteForce> cue_brute_force(const protocol::Protocol& protocol, const rig::Rig& rig);

}  // namespace turnpoint::tests

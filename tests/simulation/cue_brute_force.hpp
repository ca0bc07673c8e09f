#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::tests {

struct BruteForce {
  std::string cue;
  double accuracy = 0, chance = 0, error = 0;  ///< `error` is the standard error of `accuracy`
  /// Only if levels depend on right answers: the accuracy in sessions in which the observer gives all
  /// answers, minus that of a single key or of guessing in the same trials. own_error is its standard error.
  std::optional<double> own_gain = {};
  double own_error = 0;
};

/// Measures by simulation how accurate an observer of each cue is. The director makes whole sessions, each
/// scene of each trial is planned for its own factors with the strength that was drawn, and the observer
/// answers every trial with every rule. A rule is chosen on other trials than those that measure its
/// accuracy. If levels depend on the answers, a random level that can be presented replaces them; if they
/// depend on right answers, further sessions follow in which the observer's own answers determine the next
/// level. This code shares nothing with the cue guard that it tests.
std::vector<BruteForce> cue_brute_force(const protocol::Protocol& protocol, const rig::Rig& rig);

}  // namespace turnpoint::tests

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
  /// Set only if levels depend on right answers, or on the answers "yes" and "no", or on any answers for the
  /// observer without a cue. It is the accuracy in sessions in which the observer gives all answers, minus
  /// that of guessing or of always pressing the same key in the same trials; for the observer without a cue,
  /// the accuracy of the best key minus that of guessing. own_error is the standard error.
  std::optional<double> own_gain = {};
  double own_error = 0;
};

/// Measures by simulation how accurate an observer is who uses only one cue, for each cue. The director makes
/// whole sessions. Each scene is planned with the trial's factors and the strength that was drawn. The
/// observer answers every trial with every rule, and the best rule is chosen on other trials than those that
/// measure its accuracy. If levels depend on the answers, random levels replace them. Further sessions follow
/// in which the observer's own answers choose the next level. With one interval, many rules are tried in such
/// sessions (Tournament), and the one that does best is judged in other sessions. This code shares nothing
/// with the cue guard, which it tests.
std::vector<BruteForce> cue_brute_force(const protocol::Protocol& protocol, const rig::Rig& rig);

}  // namespace turnpoint::tests

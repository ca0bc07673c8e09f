#pragma once
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::tests {

struct BruteForce {
  std::string cue;
  double accuracy = 0;
  int trials = 0;
};

/// What an observer of each cue reaches, found out by doing it: the director makes whole sessions of the
/// simulated participant, each scene of each trial is planned for its own factors and takes the strength that
/// was drawn, and the observer answers them all, trying every rule. Nothing here is shared with the guard
/// that is tested.
std::vector<BruteForce> cue_brute_force(const protocol::Protocol& protocol, const rig::Rig& rig);

}  // namespace turnpoint::tests

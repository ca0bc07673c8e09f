#pragma once
// Solvers that a user might take instead, on the seed's corrected equation of a linear taper without loss.
#include <functional>
#include <string>
#include <vector>

namespace turnpoint::physics {

// The problem: J_nu(k s) at distances s from the apex, or g'' = (mu^2 - 1/4)/s^2 g - k^2 g with v = g s^-1/2.
struct PeerProblem {
  double k_per_m = 0;
  double mu = 0;
  std::vector<double> s_m;  // descending
};

struct Peer {
  std::string name;
  std::function<std::vector<double>(const PeerProblem&)> solve;  // v at each point, up to a constant factor
};

// Numerov's scheme always; Boost's where this build found it.
std::vector<Peer> peers();

}  // namespace turnpoint::physics

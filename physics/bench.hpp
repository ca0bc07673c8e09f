#pragma once
// Error against time for every rung, measured now on this machine, beside general solvers.
#include <string>
#include <vector>

namespace turnpoint::physics {

// One measured row. `error` is the largest difference of |v| from the best answer to hand (exact where there
// is one, else the two-dimensional field), relative to the largest |v|, last maximum at one; negative: not
// measured.
struct BenchRow {
  std::string scene;    // "seed brass 19.6 kHz, lossless", ...
  std::string solver;   // a rung's name, or a peer's
  std::string against;  // what `error` is measured against
  int points = 0;
  double seconds = 0;  // best of several runs, all points
  double error = -1;
};

// Measures for about `budget_s` seconds: the seed's membrane, a plate, an exponential taper; loss and none;
// every rung and, where this build found them, Boost.Math's Bessel and Airy functions and Boost.Odeint on the
// same equation, and a plain Numerov scheme.
std::vector<BenchRow> bench(double budget_s = 5);

// The rows as an aligned text table.
std::string format(const std::vector<BenchRow>& rows);

}  // namespace turnpoint::physics

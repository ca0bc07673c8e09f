#pragma once
#include <string>
#include <vector>

#include "tests/benchmark/solvers.hpp"

namespace turnpoint::benchmark {

/// One solver of SciPy, run and timed by python3.
struct ScipyRun {
  std::string name, setting;
  double seconds = 0;
  Solution v;
};

/// Solves the same equation with SciPy's solve_ivp (DOP853, three tolerances) and, on a wedge, with
/// special.jv (complex argument). Returns an empty list if python3 has no SciPy.
std::vector<ScipyRun> run_scipy(const OneModeProblem& problem);

}  // namespace turnpoint::benchmark

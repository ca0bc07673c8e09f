#pragma once
#include "tests/benchmark/report.hpp"

namespace turnpoint::benchmark {

/// Measures how long it takes to plan a scene for the first time, and to compute its figures under a finger,
/// with each plate theory. The table also has the ratio of this time to that of Kirchhoff's theory in the
/// same run.
Report bench_planning();

/// Measures how long it takes on average to choose a model and compute the field with it, on random membranes
/// with random tolerances. The baseline is to use `modes` everywhere.
Report bench_planner();

}  // namespace turnpoint::benchmark

#pragma once
#include "tests/benchmark/report.hpp"

namespace turnpoint::benchmark {

/// Measures how long it takes to plan a scene for the first time, and to compute its figures under a finger,
/// with each plate theory. The table also has the ratio of this time to that of Kirchhoff's theory in the
/// same run.
Report bench_planning();

/// Measures what it costs on average to choose a model and compute the field with it, on random surfaces of
/// three kinds with random tolerances, in operations of the solvers and in processor time. It is compared
/// with using `modes` everywhere, and with the cheapest model that truly suffices.
Report bench_planner();

}  // namespace turnpoint::benchmark

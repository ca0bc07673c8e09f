#pragma once
#include "tests/benchmark/report.hpp"

namespace turnpoint::benchmark {

/// How long it takes to plan a scene for the first time, with its figures under a finger, by each plate
/// theory. The ratio is that to Kirchhoff's theory in the same run.
Report bench_planning();

}  // namespace turnpoint::benchmark

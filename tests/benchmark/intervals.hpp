#pragma once
#include "tests/benchmark/report.hpp"

namespace turnpoint::benchmark {

/// Measures how long a report needs, on one core, to compute the intervals of a psychometric function and its
/// band. The data are from a QUEST+ procedure. Two methods are timed: the posterior, and the bootstrap, which
/// reports use for constant stimuli. Takes some seconds.
Report bench_intervals();

}  // namespace turnpoint::benchmark

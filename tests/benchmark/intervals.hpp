#pragma once
#include "tests/benchmark/report.hpp"

namespace turnpoint::benchmark {

/// Times the intervals of a psychometric function after sessions of a QUEST+ procedure: from the posterior,
/// and by the bootstrap for constant stimuli, on one core, each with its band as in a report. Takes some
/// seconds.
Report bench_intervals();

}  // namespace turnpoint::benchmark

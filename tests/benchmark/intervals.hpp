#pragma once
#include "tests/benchmark/report.hpp"

namespace turnpoint::benchmark {

/// The intervals of a psychometric function after sessions of a QUEST+ procedure: from the posterior, and by
/// the bootstrap that constant stimuli have, on one core; each with its band, as for a report. Takes some
/// seconds.
Report bench_intervals();

}  // namespace turnpoint::benchmark

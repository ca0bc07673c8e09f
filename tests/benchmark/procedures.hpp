#pragma once
#include "tests/benchmark/report.hpp"

namespace turnpoint::benchmark {

/// Times a trial of QUEST+ (choose a stimulus, learn from the answer) on a usual and on a fine grid, on one
/// core. If python3 can import questplus (PyPI) or node finds jsquest-plus, times them in the same run. Takes
/// some seconds.
Report bench_procedures();

}  // namespace turnpoint::benchmark

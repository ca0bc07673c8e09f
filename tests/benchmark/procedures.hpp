#pragma once
#include "tests/benchmark/report.hpp"

namespace turnpoint::benchmark {

/// A trial of QUEST+ (choose a stimulus, learn from the answer) on a usual and on a fine grid, on one core,
/// with questplus for Python (PyPI) in the same run where python3 can import it. Takes some seconds.
Report bench_procedures();

}  // namespace turnpoint::benchmark

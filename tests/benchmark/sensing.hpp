#pragma once
#include "tests/benchmark/report.hpp"

namespace turnpoint::benchmark {

/// Measures the time to demodulate eight tones and six captured channels, in relation to the time to
/// synthesise eight tones. Takes some seconds.
Report bench_sensing();

}  // namespace turnpoint::benchmark

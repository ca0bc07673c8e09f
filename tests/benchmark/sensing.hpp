#pragma once
#include "tests/benchmark/report.hpp"

namespace turnpoint::benchmark {

/// Measures what it costs to demodulate six captured channels, in relation to the synthesis of what is
/// measured: eight tones. Takes some seconds.
Report bench_sensing();

}  // namespace turnpoint::benchmark

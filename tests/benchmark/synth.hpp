#pragma once
#include "tests/benchmark/report.hpp"

namespace turnpoint::benchmark {

/// Compares methods of generating a sinusoid: error after a time against cost.
Report bench_synth();

}  // namespace turnpoint::benchmark

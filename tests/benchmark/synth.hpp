#pragma once
#include "tests/benchmark/report.hpp"

namespace turnpoint::benchmark {

/// Compares methods of generating a sinusoid by their error after some time and their cost.
Report bench_synth();

}  // namespace turnpoint::benchmark

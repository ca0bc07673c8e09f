#pragma once
#include "station/benchmark/report.hpp"

namespace turnpoint::benchmark {

/// Ways of making a sinusoid: error after a time against cost.
Report bench_synth();

}  // namespace turnpoint::benchmark

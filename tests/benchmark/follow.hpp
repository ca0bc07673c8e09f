#pragma once
#include "tests/benchmark/report.hpp"

namespace turnpoint::benchmark {

/// The processor time of a surface that follows the finger, beside that of the synthesis of eight tones.
Report bench_follow();

}  // namespace turnpoint::benchmark

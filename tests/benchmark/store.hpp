#pragma once
#include <string>

#include "tests/benchmark/report.hpp"

namespace turnpoint::benchmark {

/// A durable trial through the session log beside bare SQLite, below `directory`: its disk is what is
/// measured.
Report bench_store(const std::string& directory, int trials);

}  // namespace turnpoint::benchmark

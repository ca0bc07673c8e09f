#pragma once
#include <string>

#include "tests/benchmark/report.hpp"

namespace turnpoint::benchmark {

/// Compares durable trials written through the session log with plain SQLite. Measures the disk of
/// `directory`.
Report bench_store(const std::string& directory, int trials);

}  // namespace turnpoint::benchmark

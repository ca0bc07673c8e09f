#pragma once
#include <string>

#include "tests/benchmark/report.hpp"

namespace turnpoint::benchmark {

/// Compares durable trials through the session log with plain SQLite below `directory`, whose disk is what is
/// measured.
Report bench_store(const std::string& directory, int trials);

}  // namespace turnpoint::benchmark

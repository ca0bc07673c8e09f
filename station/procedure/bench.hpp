#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace turnpoint::procedure {

/// One way of running a trial of QUEST+ (choose a stimulus, learn from the answer) on one grid.
struct BenchRow {
  std::string what;  ///< "turnpoint", or a peer's name and version
  std::size_t stimuli = 0, parameters = 0;
  double median_ms = 0, p99_ms = 0;  ///< per trial
  std::size_t memory_bytes = 0;      ///< of the tables and the posterior; 0: not known
};

/// Measures, on one core, 41 stimuli x 8505 and 81 x 45 551 grid points, the grid's guess and lapse included;
/// with questplus for Python (PyPI) in the same run where python3 can import it: rows that cannot be measured
/// are absent. Takes some seconds.
std::vector<BenchRow> bench();

}  // namespace turnpoint::procedure

#pragma once
#include <string>
#include <vector>

namespace turnpoint::benchmark {

/// A method of writing trials, and the cost of a trial with it.
struct DurableTrial {
  std::string what;
  int trials = 0;
  /// time until the event `presented` is safe on the disk, plus time until the trial with its tones and
  /// events is safe there
  double median_ms = 0, p99_ms = 0;
  double ratio = 0;  ///< median time divided by the median time of plain SQLite
};

/// Writes trials into databases below `directory`, whose disk is measured, alternately through a session log
/// and through plain SQLite calls. The plain calls write the same rows in the same transactions with WAL and
/// synchronous FULL, but without triggers, checks and keys. To show how much of the cost is the disk's, plain
/// SQLite is also measured with synchronous OFF, which does not wait for the disk. The files are removed.
/// Throws store::StoreError.
std::vector<DurableTrial> time_durable_trials(const std::string& directory, int trials);

}  // namespace turnpoint::benchmark

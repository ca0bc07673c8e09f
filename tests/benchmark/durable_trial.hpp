#pragma once
#include <string>
#include <vector>

namespace turnpoint::benchmark {

/// A method of writing trials, and the cost of a trial with it.
struct DurableTrial {
  std::string what;
  int trials = 0;
  /// cost of `presented` and of the trial with its tones and events, both durable
  double median_ms = 0, p99_ms = 0;
  double ratio = 0;  ///< median, relative to bare SQLite
};

/// Writes trials into databases below `directory` (its disk is what is measured), alternately through a
/// session log and through plain SQLite calls. The plain calls write the same rows in the same transactions
/// with WAL and synchronous FULL, but without triggers, checks and keys. For comparison there is plain SQLite
/// that does not wait for the disk (synchronous OFF), which shows how much of the cost is the disk's. The
/// files are removed. Throws store::StoreError.
std::vector<DurableTrial> time_durable_trials(const std::string& directory, int trials);

}  // namespace turnpoint::benchmark

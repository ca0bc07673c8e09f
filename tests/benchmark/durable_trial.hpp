#pragma once
#include <string>
#include <vector>

namespace turnpoint::benchmark {

/// One way of writing trials, and what a trial costs with it.
struct DurableTrial {
  std::string what;
  int trials = 0;
  double median_ms = 0, p99_ms = 0;  ///< `presented` and the trial with its tones and events, both durable
  double ratio = 0;                  ///< median, relative to bare SQLite
};

/// Writes trials into databases below `directory` (its disk is what is measured), by turns through a session
/// log and through bare SQLite calls: the same rows, transactions, WAL and synchronous FULL, but no triggers,
/// checks or keys. For comparison also bare SQLite without waiting for the disk (synchronous OFF), which
/// shows how much of the cost is the disk's. The files are removed. Throws store::StoreError.
std::vector<DurableTrial> time_durable_trials(const std::string& directory, int trials);

}  // namespace turnpoint::benchmark

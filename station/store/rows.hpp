#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "station/store/names.hpp"
#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// Which segment, block and attempt of a session a trial belongs to.
struct TrialPlace {
  std::string session_id;
  int segment_index = 1, block_index = 0, attempt = 0;
};

/// Prepared statements that a running session uses again and again.
class RowWriter {
 public:
  explicit RowWriter(Database& database);
  void trial(const TrialPlace& place, TrialRow row, std::int64_t recorded_realtime_ns);
  void event(const TrialPlace& place, std::int64_t event_index, EventRow row);

 private:
  Statement trial_, tone_, signal_, event_, check_, answer_, friction_, program_, estimate_;
};

/// Returns a session's trials with their tones, by (block_index, attempt). Each list is in the order in which
/// the trials were stored.
std::map<std::pair<int, int>, std::vector<TrialRow>> read_trials(Database& database,
                                                                 const std::string& session_id);

}  // namespace turnpoint::store

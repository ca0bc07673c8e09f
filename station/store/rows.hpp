#pragma once
#include <map>
#include <string>
#include <vector>

#include "station/store/names.hpp"
#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// The position of a trial in its session.
struct TrialPlace {
  std::string session_id;
  int segment_index = 1, block_index = 0, attempt = 0;
};

/// Statements that a running session uses repeatedly, prepared once.
class RowWriter {
 public:
  explicit RowWriter(Database& database);
  void trial(const TrialPlace& place, TrialRow row, std::int64_t recorded_realtime_ns);
  void event(const TrialPlace& place, std::int64_t event_index, EventRow row);

 private:
  Statement trial_, tone_, event_;
};

/// A session's trials with their tones, by (block_index, attempt); each list in the order of storing.
std::map<std::pair<int, int>, std::vector<TrialRow>> read_trials(Database& database,
                                                                 const std::string& session_id);

}  // namespace turnpoint::store

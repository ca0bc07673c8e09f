#pragma once
#include <string>
#include <vector>

namespace turnpoint::desk {

/// A stored session, as a line of a list.
struct SessionLine {
  std::string session_id, person, participant, protocol, started, run_mode, status, reason;
  int trials = 0;
  std::vector<std::string> notes;
  /// true if the session was interrupted and has trials, so that it can be continued
  bool resumable = false;
};

/// Returns the sessions of a database, the newest first; empty if there is no database yet. Throws
/// StoreError.
std::vector<SessionLine> session_lines(const std::string& database);

/// True if each word of `search` occurs in the session's participant, protocol, date, run mode, status or
/// notes. Upper and lower case do not matter.
bool matches(const SessionLine& session, const std::string& search);

}  // namespace turnpoint::desk

#pragma once
#include <string>
#include <vector>

#include "station/core/texts.hpp"

namespace turnpoint::view {

/// A stored session, as a line of a list.
struct SessionLine {
  std::string session_id, person, participant, protocol_id, protocol, started, run_mode, status;
  core::Phrase reason;  ///< why it ended, by reason_of_end()
  int trials = 0;
  std::vector<std::string> notes;
  /// true if the session was interrupted and has trials, so that it can be continued
  bool resumable = false;
};

/// Says why a session ended. The database stores the reason in English; one that the station does not know,
/// such as the words of an operator, is the same in every language.
core::Phrase reason_of_end(const std::string& stored);

/// Returns the sessions of a database, the newest first; empty if there is no database yet. Throws
/// StoreError.
std::vector<SessionLine> session_lines(const std::string& database);

/// How the list is ordered: the newest session first, or by study or participant and then the newest first.
enum class SessionOrder { newest, study, participant };
void put_in_order(std::vector<SessionLine>& newest_first, SessionOrder order);

/// True if each word of `search` occurs in the session's participant, protocol, date, run mode, status or
/// notes. Upper and lower case do not matter.
bool matches(const SessionLine& session, const std::string& search);

}  // namespace turnpoint::view

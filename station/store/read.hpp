#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/store/session_log.hpp"

namespace turnpoint::store {

class Database;

/// Selects sessions; an empty member selects all. A participant is written as a code, CODE@STATION, or a
/// SessionRecord::person. If several people have the code, the sessions of all of them are selected.
struct SessionFilter {
  std::string session_id, participant, protocol_id;
};

/// Returns sessions ordered by person, protocol, index and id. The texts of protocol, rig and calibration are
/// left out, because they are long and many sessions share them. Reads only, and works while a session is
/// running. Throws StoreError.
std::vector<SessionRecord> list_sessions(const std::string& database, const SessionFilter& filter = {});
std::vector<SessionRecord> list_sessions(Database& database, const SessionFilter& filter = {});

/// Returns one session, including the texts of its protocol, rig and calibration. Throws StoreError (missing)
/// if there is no session with this id.
SessionRecord session_record(Database& database, const std::string& session_id);

/// Returns the participant codes of all sessions, in alphabetical order.
std::vector<std::string> participants(const std::string& database);

/// All rows of a session. read_session() throws StoreError (missing) if there is no session with this id.
struct StoredSession {
  SessionRecord session;
  std::vector<SegmentStart> segments;  ///< in order of segment_index, from 1
  std::vector<BlockRecord> blocks;     ///< in the order in which they were run
  std::vector<EventRow> events;        ///< in the order in which they were logged
};
StoredSession read_session(const std::string& database, const std::string& session_id);
StoredSession read_session(Database& database, const std::string& session_id);
/// Reads the rows of a session that list_sessions() returned.
StoredSession read_session(Database& database, const SessionRecord& session);

/// A session that can be continued.
struct Interrupted {
  SessionRecord session;
  /// Wall-clock time since the session's last commit. If the clock was set back, this is negative and the age
  /// is unknown.
  double age_s = 0;
};

/// Returns the interrupted session with this id or, if the id is "", the newest one: the one whose trials
/// were stored last, whatever the clock says. Sessions of this database come before merged sessions. Empty if
/// there is none. Sessions without a trial are ignored; they are closed as abandoned when the database is
/// next opened for writing.
std::optional<Interrupted> interrupted_session(const std::string& database,
                                               const std::string& session_id = "");

}  // namespace turnpoint::store

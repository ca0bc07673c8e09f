#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/store/session_log.hpp"

namespace turnpoint::store {

class Database;

/// Selects sessions; "" selects all. A participant is a code, CODE@STATION, or a SessionRecord::person. A
/// code that several people have selects all of them.
struct SessionFilter {
  std::string session_id, participant, protocol_id;
};

/// Sessions ordered by person, protocol, index and id. The texts of protocol, rig and calibration are left
/// out, because many sessions share a few long texts. Only reads; works while a session is running. Throws
/// StoreError.
std::vector<SessionRecord> list_sessions(const std::string& database, const SessionFilter& filter = {});
std::vector<SessionRecord> list_sessions(Database& database, const SessionFilter& filter = {});

/// One session with its texts. Throws StoreError (missing) if there is no session with this id.
SessionRecord session_record(Database& database, const std::string& session_id);

/// Participant codes of all sessions, in alphabetical order.
std::vector<std::string> participants(const std::string& database);

/// A whole session as stored. Throws StoreError (missing) if there is no session with this id.
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
  /// Wall-clock time since its last commit. Negative if the clock was set back since: the age is then
  /// unknown.
  double age_s = 0;
};

/// The interrupted session with this id, or for "" the newest one. The newest is found by the order in which
/// trials were stored, not by the clock; sessions of this database come before merged ones. Empty if there is
/// none. Sessions without a trial are ignored: the next write access closes them as abandoned.
std::optional<Interrupted> interrupted_session(const std::string& database,
                                               const std::string& session_id = "");

}  // namespace turnpoint::store

#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/store/session_log.hpp"

namespace turnpoint::store {

class Database;

/// Which sessions; "" takes all. A participant is a code, CODE@STATION, or what SessionRecord::person says;
/// where several people have the code it takes all of theirs.
struct SessionFilter {
  std::string session_id, participant, protocol_id;
};

/// Sessions in the order of person, protocol, index and id, without the texts of protocol, rig and
/// calibration: a database has many sessions and few texts. Reads only; works beside a running session.
/// Throws StoreError.
std::vector<SessionRecord> list_sessions(const std::string& database, const SessionFilter& filter = {});
std::vector<SessionRecord> list_sessions(Database& database, const SessionFilter& filter = {});

/// One session with its texts. Throws StoreError (missing) where there is none of that id.
SessionRecord session_record(Database& database, const std::string& session_id);

/// Participant codes of all sessions, in alphabetical order.
std::vector<std::string> participants(const std::string& database);

/// A whole session as it stands. Throws StoreError (missing) where there is none of that id.
struct StoredSession {
  SessionRecord session;
  std::vector<SegmentStart> segments;  ///< segment_index 1 first
  std::vector<BlockRecord> blocks;     ///< in the order run
  std::vector<EventRow> events;        ///< in the order logged
};
StoredSession read_session(const std::string& database, const std::string& session_id);
StoredSession read_session(Database& database, const std::string& session_id);
/// The rows of a session that list_sessions() gave.
StoredSession read_session(Database& database, const SessionRecord& session);

/// A session that can be gone on with.
struct Interrupted {
  SessionRecord session;
  /// Wall-clock time since its last commit; below 0 where the clock was set back since: its age is not known
  /// then.
  double age_s = 0;
};

/// The interrupted session of that id, or the newest one for "", by the order in which trials were stored and
/// not by the clock, those of this database before merged ones; none where there is none. Sessions without a
/// trial are not among them: the next write access closes them as abandoned.
std::optional<Interrupted> interrupted_session(const std::string& database,
                                               const std::string& session_id = "");

}  // namespace turnpoint::store

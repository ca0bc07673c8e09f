#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "station/store/error.hpp"

namespace turnpoint::store {

/// What the merge did with one session of the other database.
struct MergedSession {
  enum class What {
    added,      ///< the session was not here before
    extended,   ///< the session was here with fewer rows
    unchanged,  ///< the session was here already
    withdrawn,  ///< the participant has withdrawn here, so the session was left out
  };
  std::string session_id, participant, protocol_id, station_id, sha256;
  What what = What::added;
  std::int64_t trials = 0;  ///< number of rows added
};

const char* name(MergedSession::What what);

struct MergeReport {
  std::vector<MergedSession> sessions;
  /// sessions present here that were withdrawn in the other database
  std::vector<std::string> withdrawn_there;
};

/// Adds the sessions of `source` (another station's database, or a backup) to `database`: all of them or
/// none. Repeating a merge changes nothing. Rows with the same key must be equal. Otherwise nothing is
/// merged, and the error (conflict) names table, key and column. Sessions that were withdrawn here stay out.
/// `source` is only read. Throws StoreError.
MergeReport merge(const std::string& database, const std::string& source);

}  // namespace turnpoint::store

#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "station/store/error.hpp"

namespace turnpoint::store {

/// What the merge did with one session of the other database.
struct MergedSession {
  enum class What {
    added,      ///< the session was not in this database before
    extended,   ///< the session was in this database, but with fewer rows
    unchanged,  ///< the session was already in this database
    withdrawn,  ///< the participant has withdrawn from this database, so the session was left out
  };
  std::string session_id, participant, protocol_id, station_id, sha256;
  What what = What::added;
  std::int64_t trials = 0;  ///< number of trials that were added
};

const char* name(MergedSession::What what);

struct MergeReport {
  std::vector<MergedSession> sessions;
  /// sessions of this database that were withdrawn from the other database
  std::vector<std::string> withdrawn_there;
};

/// Adds the sessions of `source` (another station's database, or a backup) to `database`: all of them or
/// none. Merging again changes nothing. Rows with equal keys must be equal; otherwise nothing is merged, and
/// the error (conflict) names table, key and column. Sessions that were withdrawn from `database` stay out.
/// `source` is opened for reading only. Throws StoreError.
MergeReport merge(const std::string& database, const std::string& source);

}  // namespace turnpoint::store

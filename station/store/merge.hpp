#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "station/store/error.hpp"

namespace turnpoint::store {

/// What merging did with one session of the other database.
struct MergedSession {
  enum class What {
    added,      ///< it was not here
    extended,   ///< it was here with fewer rows
    unchanged,  ///< it is here already
    withdrawn,  ///< its participant withdrew here: left out
  };
  std::string session_id, participant, protocol_id, station_id, sha256;
  What what = What::added;
  std::int64_t trials = 0;  ///< rows that came in
};

const char* name(MergedSession::What what);

struct MergeReport {
  std::vector<MergedSession> sessions;
  std::vector<std::string> withdrawn_there;  ///< sessions here that the other database had withdrawn
};

/// Brings the sessions of `source` (another station's database, or a backup) into `database`, all or none.
/// Repeating it changes nothing. Rows with the same key must be equal: else nothing is merged and the error
/// (conflict) names table, key and column. Sessions that were withdrawn here stay out. `source` is only read.
/// Throws StoreError.
MergeReport merge(const std::string& database, const std::string& source);

}  // namespace turnpoint::store

#pragma once
#include <string>
#include <vector>

#include "station/store/session_log.hpp"

namespace turnpoint::store {

class Database;

/// What a withdrawal took away.
struct Withdrawal {
  std::string participant;
  std::vector<SessionRecord> sessions;  ///< as they stood; empty where only the scrubbing was done again
  std::int64_t trials = 0, tones = 0, events = 0, annotations = 0;
  std::vector<std::string> removed_copies;    ///< backups that held the participant and are gone
  std::vector<std::string> remaining_copies;  ///< copies beside the database that still do
};

/// The one sanctioned delete: all sessions of a participant code, from every table, then from the file's free
/// pages and its log (secure_delete, VACUUM, checkpoint). Tombstones keep merge from bringing them back and
/// the code from being given out again. With a folder of backups ("" for none) a new backup is made and those
/// that hold the participant are removed. Repeating it is harmless. Throws StoreError (missing) for a code
/// that the database never had.
Withdrawal withdraw(const std::string& database, const std::string& participant,
                    const std::string& backup_directory = "");

/// Whether the code was withdrawn here.
bool is_withdrawn(Database& database, const std::string& participant);

}  // namespace turnpoint::store

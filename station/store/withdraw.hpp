#pragma once
#include <string>
#include <vector>

#include "station/store/people.hpp"
#include "station/store/session_log.hpp"

namespace turnpoint::store {

/// Whose sessions to remove. A participant is a code that only one person has, or CODE@STATION; for a joined
/// person all codes are included. `station` and `session_id` limit it to the sessions of that station, or to
/// that session ("" means all). If only one session is withdrawn, the code stays in use.
struct WithdrawOptions {
  std::string participant, station, session_id;
  std::string backup_directory;  ///< "" for none
};

/// What a withdrawal removes, or would remove.
struct Withdrawal {
  std::string participant;
  /// the sessions before removal; empty if only the cleaning of free space was repeated
  std::vector<SessionRecord> sessions;
  std::vector<Bearer> bearers;  ///< codes that will not be assigned again
  std::int64_t trials = 0, tones = 0, events = 0, annotations = 0;
  /// removed copies of the database that contained the sessions: backups, and copies from before a migration
  std::vector<std::string> removed_copies;
  /// files that still contain the sessions or cannot be read; to be removed by hand
  std::vector<std::string> remaining_copies;
};

/// Says what withdraw() would do; only reads. Throws StoreError: missing for a participant whom the database
/// never had, refused if several people have the code, and the original error if the folder of backups cannot
/// be listed.
Withdrawal plan_withdrawal(const std::string& database, const WithdrawOptions& options);

/// The only function that deletes data. It deletes the sessions from every table, then from the file's free
/// pages and its log (secure_delete, VACUUM, checkpoint), then the database's own copies that contain them:
/// those left beside it by interrupted operations and migrations, and, if a folder of backups is given, its
/// backups after a new one was made there. Tombstones keep a merge from bringing the sessions back, and keep
/// the code from being assigned again. Repeating it is harmless and finishes an interrupted withdrawal.
/// Throws StoreError like plan_withdrawal(), before anything is deleted.
Withdrawal withdraw(const std::string& database, const WithdrawOptions& options);

/// True if this code was withdrawn in this database.
bool is_withdrawn(Database& database, const Bearer& bearer);

}  // namespace turnpoint::store

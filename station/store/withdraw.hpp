#pragma once
#include <string>
#include <vector>

#include "station/store/people.hpp"
#include "station/store/session_log.hpp"

namespace turnpoint::store {

/// Whose sessions go. A participant is a code that only one person has, or CODE@STATION; all codes of a
/// joined person go. `station` and `session_id` ("" for all) take only the sessions there, or that one; the
/// code stays in use where only a session was withdrawn.
struct WithdrawOptions {
  std::string participant, station, session_id;
  std::string backup_directory;  ///< "" for none
};

/// What a withdrawal takes away, or would take away.
struct Withdrawal {
  std::string participant;
  std::vector<SessionRecord> sessions;  ///< as they stood; empty where only the scrubbing was done again
  std::vector<Bearer> bearers;          ///< codes that are not given out again
  std::int64_t trials = 0, tones = 0, events = 0, annotations = 0;
  std::vector<std::string> removed_copies;  ///< backups and copies before a migration that held the sessions
  std::vector<std::string> remaining_copies;  ///< still hold them, or cannot be read: to be removed by hand
};

/// What withdraw() would do; reads only. Throws StoreError: missing for a participant that the database never
/// had, refused where several people have the code, and whatever keeps the folder of backups from being
/// listed.
Withdrawal plan_withdrawal(const std::string& database, const WithdrawOptions& options);

/// The one sanctioned delete: the sessions, from every table, then from the file's free pages and its log
/// (secure_delete, VACUUM, checkpoint), then what holds them of the database's own copies: those that
/// interrupted operations and migrations have left beside it, and with a folder of backups, where a new one
/// is made first, its backups. Tombstones keep merge from bringing the sessions back and the code from being
/// given out again. Repeating it is harmless, and finishes what was interrupted. Throws StoreError as
/// plan_withdrawal() does, before anything is deleted.
Withdrawal withdraw(const std::string& database, const WithdrawOptions& options);

/// Whether the code was withdrawn here.
bool is_withdrawn(Database& database, const Bearer& bearer);

}  // namespace turnpoint::store

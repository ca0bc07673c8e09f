#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "station/store/people.hpp"
#include "station/store/session_log.hpp"

namespace turnpoint::store {

/// The sessions to remove. `participant` is CODE@STATION, or a code that only one person has; all codes of a
/// joined person are included. `station` and `session_id` restrict the removal to sessions of that station,
/// or to that session; "" means all. If only one session is withdrawn, the code stays in use.
struct WithdrawOptions {
  std::string participant, station, session_id;
  std::string backup_directory;  ///< folder of backups; "" for none
};

/// What a withdrawal removes, or would remove.
struct Withdrawal {
  std::string participant;
  /// the removed sessions; empty if an earlier call removed them all and this one only erased free space
  /// again
  std::vector<SessionRecord> sessions;
  std::vector<Bearer> bearers;  ///< codes that will not be assigned to another person
  std::int64_t trials = 0, tones = 0, events = 0, annotations = 0;
  /// backups that contained the sessions and were removed
  std::vector<std::string> removed_copies;
  /// files that still contain the sessions or cannot be read; somebody must remove them by hand
  std::vector<std::string> remaining_copies;
};

/// Returns what withdraw() would do, and changes nothing. Throws StoreError: missing if the database never
/// had this participant, refused if several people have the code. If the folder of backups cannot be listed,
/// throws the error of listing it.
Withdrawal plan_withdrawal(const std::string& database, const WithdrawOptions& options);

/// Removes the sessions of a participant. No other function deletes recorded data.
///
/// It deletes the sessions from every table, and then from the file's free pages and its log (secure_delete,
/// VACUUM, checkpoint). Then it deletes copies of this database that contain the sessions: files that
/// interrupted operations have left beside the database, and its backups, if a folder of backups is given.
/// Before it removes backups, it makes a new one.
///
/// Tombstones remain in the database. They prevent a merge from bringing the sessions back, and the code from
/// being assigned again. Repeating the call does no harm and completes an interrupted withdrawal. Before
/// anything is deleted, it throws the errors of plan_withdrawal().
Withdrawal withdraw(const std::string& database, const WithdrawOptions& options);

/// The mark that a withdrawn session leaves (table tombstone): the session must never come back. The code is
/// kept only as a salted hash; "" if it stays in use.
struct Tombstone {
  std::string session_id, salt, participant_sha256;
  std::int64_t withdrawn_realtime_ns = 0;
  std::string station_id;  ///< station of the code
};

std::vector<Tombstone> list_tombstones(Database& database);

/// Withdraws from this database what was withdrawn from another: deletes the sessions to which the tombstones
/// belong, as withdraw() does, and keeps the tombstones. If a tombstone withdraws a code, all sessions with
/// this code at its station go, also those that the other database has never seen. Changes nothing if there
/// is nothing to do; completes a withdrawal that was interrupted. A tombstone whose station or code is not that of its session is not followed.
Withdrawal follow_tombstones(const std::string& database, const std::vector<Tombstone>& tombstones,
                             const std::string& backup_directory = "");

/// True if this code was withdrawn from this database.
bool is_withdrawn(Database& database, const Bearer& bearer);

}  // namespace turnpoint::store

#include "station/store/withdraw.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "station/store/backup.hpp"
#include "station/store/files.hpp"
#include "station/store/identity.hpp"
#include "station/store/open.hpp"
#include "station/store/read.hpp"
#include "station/store/sqlite.hpp"
#include "station/text/number.hpp"

namespace turnpoint::store {

namespace fs = std::filesystem;

namespace {

std::string digest(const std::string& salt, const std::string& participant) {
  return text::sha256(salt + "/" + participant);
}

std::int64_t remove(Database& database, const std::string& table, const std::string& session_id) {
  Statement(database, "DELETE FROM " + table + " WHERE session_id = ?").bind(session_id).run();
  return database.changes();
}

void remove_sessions(Database& database, Withdrawal& withdrawal) {
  const auto salt = new_uuid();
  const auto& code = withdrawal.participant;
  Transaction transaction(database);
  for (const auto& session : withdrawal.sessions) {
    const auto& id = session.session_id;
    Statement(database, "INSERT INTO tombstone VALUES (?,?,?,?)")
        .bind(id, salt, digest(salt, code), realtime_ns())
        .run();
    withdrawal.annotations += remove(database, "annotation", id);
    remove(database, "merged", id);
    remove(database, "link", id);
    remove(database, "unsealed", id);
    withdrawal.events += remove(database, "event", id);
    withdrawal.tones += remove(database, "tone", id);
    withdrawal.trials += remove(database, "trial", id);
    remove(database, "block", id);
    remove(database, "segment", id);
    remove(database, "session", id);
  }
  Statement(database, "DELETE FROM enrolment WHERE participant = ?").bind(code).run();
  Statement(database, "DELETE FROM participant WHERE code = ?").bind(code).run();
  transaction.commit();
}

/// Deleted rows live on in free pages and in the log until the file is rewritten and the log cut to nothing.
void scrub(Database& database) {
  database.execute("PRAGMA wal_checkpoint(TRUNCATE)");
  database.execute("PRAGMA temp_store = MEMORY; VACUUM");
  Statement checkpoint(database, "PRAGMA wal_checkpoint(TRUNCATE)");
  if (checkpoint.step() && checkpoint.integer(0) != 0)
    throw StoreError(Fault::busy,
                     fmt::format("database {}: the rows are deleted, but a reader keeps the log from "
                                 "being cut; end the other program and withdraw again",
                                 database.path()));
}

bool holds(const std::string& path, const std::string& participant) {
  try {
    return !list_sessions(path, {"", participant, ""}).empty();
  } catch (const StoreError&) {
    return true;  // what cannot be read may hold anything
  }
}

/// Files beside the database that were once copies of it: before a migration, or damaged and set aside.
std::vector<std::string> copies_beside(const std::string& database, const std::string& participant) {
  std::vector<std::string> copies;
  const auto stem = fs::path(database).filename().string();
  for (const auto& entry : fs::directory_iterator(fs::absolute(database).parent_path())) {
    const auto name = entry.path().filename().string();
    const bool copy = name.rfind(stem + ".before-v", 0) == 0 || name.rfind(stem + ".damaged-", 0) == 0;
    const bool part = name.size() > 4 && (name.ends_with("-wal") || name.ends_with("-shm"));
    if (copy && !part && holds(entry.path().string(), participant)) copies.push_back(entry.path().string());
  }
  return copies;
}

}  // namespace

bool is_withdrawn(Database& database, const std::string& participant) {
  Statement rows(database, "SELECT DISTINCT salt, participant_sha256 FROM tombstone");
  while (rows.step())
    if (rows.text(1) == digest(rows.text(0), participant)) return true;
  return false;
}

Withdrawal withdraw(const std::string& path, const std::string& participant,
                    const std::string& backup_directory) {
  Withdrawal withdrawal;
  withdrawal.participant = participant;
  {
    auto writer = open_writer(path, IfMissing::fail);
    auto& database = writer.database;
    if (!participant.empty()) withdrawal.sessions = list_sessions(database, {"", participant, ""});
    if (withdrawal.sessions.empty() && !is_withdrawn(database, participant))
      throw StoreError(Fault::missing,
                       fmt::format("withdraw: database {} has no participant \"{}\"; nothing was removed",
                                   path, participant));
    database.execute("PRAGMA secure_delete = ON");
    remove_sessions(database, withdrawal);
    scrub(database);
  }
  withdrawal.remaining_copies = copies_beside(path, participant);
  if (backup_directory.empty()) return withdrawal;
  const auto fresh = backup(path, {backup_directory, 0}).path;
  for (const auto& old : backups_in(backup_directory, path)) {
    if (old == fresh || !holds(old, participant)) continue;
    fs::remove(old);
    fs::remove(old + ".sha256");
    withdrawal.removed_copies.push_back(old);
  }
  sync_path(backup_directory);
  return withdrawal;
}

}  // namespace turnpoint::store

#include "station/store/withdraw.hpp"

#include <unistd.h>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "station/core/number.hpp"
#include "station/store/backup.hpp"
#include "station/store/backup_folder.hpp"
#include "station/store/files.hpp"
#include "station/store/open.hpp"
#include "station/store/read.hpp"
#include "station/store/schema.hpp"
#include "station/store/seal.hpp"
#include "station/store/sqlite.hpp"
#include "station/store/whole_file.hpp"
#include "station/system/clocks.hpp"
#include "station/system/uuid.hpp"

namespace turnpoint::store {

/// Files beside a database that contain some of the given sessions, or that cannot be read and therefore may
/// contain them.
struct Copies {
  std::vector<std::string> own;  ///< backups of this database
  /// Files that must not be removed without asking: backups of other databases, damaged files that were set
  /// aside, and files that cannot be read.
  std::vector<std::string> foreign;
};

/// Searches the folder of the database, and a folder of backups unless `backup_folder` is "". Throws
/// StoreError if a folder cannot be listed.
Copies copies_of(const std::string& path, Database& database, const std::string& backup_folder,
                 const std::vector<std::string>& session_ids);

/// Removes the files in `own`, and the files that interrupted backups have left in the folder of backups.
void remove_copies(const Copies& copies, const std::string& backup_folder);

namespace {

enum class Holds { no, yes, unreadable };

/// Throws StoreError if the disk fails, because then nobody knows.
Holds holds(const std::string& path, const std::vector<std::string>& session_ids) {
  // somebody else's file in a shared folder
  if (::access(path.c_str(), R_OK) != 0 && errno == EACCES) return Holds::unreadable;
  try {
    for (const auto* suffix : {"-wal", "-journal"})
      // Data in SQLite's log are not yet in the database file, so reading only that file could miss a
      // session.
      if (file_size(path + suffix) > 0) return Holds::unreadable;
    return looked_at(path, [&] {
      Database copy(path, Database::Access::immutable);
      require_schema(copy);
      Statement rows(copy, "SELECT 1 FROM session WHERE session_id = ?");
      return std::any_of(session_ids.begin(), session_ids.end(),
                         [&](const auto& id) { return rows.bind(id).step(); })
                 ? Holds::yes
                 : Holds::no;
    });
  } catch (const StoreError& error) {
    const auto kind = error.kind();
    if (kind == ErrorKind::corrupt || kind == ErrorKind::not_a_database || kind == ErrorKind::other_schema)
      return Holds::unreadable;
    throw;
  }
}

bool is_log(const std::string& name) {
  return std::any_of(std::begin(kLogSuffixes), std::end(kLogSuffixes),
                     [&](const char* suffix) { return name.ends_with(suffix); });
}

}  // namespace

Copies copies_of(const std::string& path, Database& database, const std::string& backup_folder,
                 const std::vector<std::string>& session_ids) {
  Copies copies;
  const auto stem = std::filesystem::path(path).filename().string();
  for (const auto& name : list_folder(folder_of(path))) {
    if (!name.starts_with(stem + ".damaged-") || is_log(name)) continue;
    const auto file = folder_of(path) + "/" + name;
    if (holds(file, session_ids) != Holds::no) copies.foreign.push_back(file);
  }
  if (backup_folder.empty()) return copies;
  const auto id = database.text("SELECT value FROM meta WHERE key = 'database_id'");
  for (const auto& backup : stored_backups(canonical(backup_folder))) {
    const auto found = holds(backup.path, session_ids);
    if (found == Holds::no) continue;
    if (found == Holds::yes && !backup.trouble.empty())
      throw StoreError(ErrorKind::io,
                       fmt::format("backup {} could not be read: {}", backup.path, backup.trouble));
    (found == Holds::yes && backup.database_id == id ? copies.own : copies.foreign).push_back(backup.path);
  }
  return copies;
}

void remove_copies(const Copies& copies, const std::string& backup_folder) {
  for (const auto& path : copies.own) {
    remove_backup(path);
    sync_path(folder_of(path));
  }
  if (backup_folder.empty()) return;
  const auto folder = canonical(backup_folder);
  const BackupFolderLock lock(folder);
  remove_interrupted_backups(folder);
  sync_path(folder);
}

namespace {

std::string digest(const std::string& salt, const std::string& code) {
  return core::sha256(salt + "/" + code);
}

/// True if this code has a tombstone (the mark of a withdrawal): of this station, or of any station if
/// `station` is "".
bool has_tombstone(Database& database, const std::string& station, const std::string& code) {
  Statement rows(database,
                 "SELECT DISTINCT salt, participant_sha256 FROM tombstone WHERE ?1 IN ('', station_id)");
  rows.bind(station);
  while (rows.step())
    if (rows.text(1) == digest(rows.text(0), code)) return true;
  return false;
}

/// Call this for a name without sessions. Throws unless this participant's sessions were withdrawn earlier.
void require_withdrawn_before(Database& database, const WithdrawOptions& options) {
  const auto at = options.participant.rfind('@');
  const auto code = options.participant.substr(0, at);
  const auto station = at == std::string::npos ? options.station : options.participant.substr(at + 1);
  if (!options.participant.empty() && has_tombstone(database, station, code)) return;
  throw StoreError(
      ErrorKind::missing,
      fmt::format("withdraw: database {} has no participant \"{}\"{}; nothing was removed", database.path(),
                  options.participant, options.station.empty() ? "" : " at station " + options.station));
}

/// Returns the codes of the person who is to be withdrawn; only those of one station if the options name a
/// station.
std::vector<Bearer> chosen_bearers(const People& people, const WithdrawOptions& options) {
  auto persons = people.named(options.participant);
  for (auto& person : persons)
    std::erase_if(person, [&](const auto& bearer) {
      return !options.station.empty() && bearer.station_id != options.station;
    });
  std::erase_if(persons, [](const auto& person) { return person.empty(); });
  if (persons.empty()) return {};
  if (persons.size() > 1) only_person(people, options.participant, "withdraw");
  return persons.front();
}

Withdrawal choose(Database& database, const WithdrawOptions& options) {
  Withdrawal withdrawal;
  withdrawal.participant = options.participant;
  const auto bearers = chosen_bearers(People(database), options);
  for (auto& session : list_sessions(database, {options.session_id, "", ""})) {
    const Bearer bearer{session.start.station_id, session.start.participant};
    if (std::find(bearers.begin(), bearers.end(), bearer) != bearers.end())
      withdrawal.sessions.push_back(std::move(session));
  }
  if (options.session_id.empty()) withdrawal.bearers = bearers;
  if (withdrawal.sessions.empty() && !options.session_id.empty())
    throw StoreError(ErrorKind::missing,
                     fmt::format("withdraw: participant \"{}\" has no session {}; nothing was removed",
                                 options.participant, options.session_id));
  if (withdrawal.sessions.empty() && bearers.empty()) require_withdrawn_before(database, options);
  return withdrawal;
}

std::vector<std::string> ids_of(Database& database, const Withdrawal& withdrawal) {
  std::vector<std::string> ids;
  for (const auto& session : withdrawal.sessions) ids.push_back(session.session_id);
  Statement gone(database, "SELECT session_id FROM tombstone");
  while (gone.step()) ids.push_back(gone.text(0));
  return ids;
}

std::int64_t remove(Database& database, const std::string& table, const std::string& session_id) {
  Statement(database, "DELETE FROM " + table + " WHERE session_id = ?").bind(session_id).run();
  return database.changes();
}

std::int64_t count(Database& database, const std::string& table, const std::string& session_id) {
  Statement rows(database, "SELECT count(*) FROM " + table + " WHERE session_id = ?");
  rows.bind(session_id).step();
  return rows.integer(0);
}

void count_rows(Database& database, Withdrawal& withdrawal) {
  for (const auto& session : withdrawal.sessions) {
    withdrawal.trials += count(database, "trial", session.session_id);
    withdrawal.tones += count(database, "tone", session.session_id);
    withdrawal.events += count(database, "event", session.session_id);
    withdrawal.annotations += count(database, "annotation", session.session_id);
  }
}

void remove_bearer(Database& database, const Bearer& bearer) {
  Statement(database, "DELETE FROM enrolment WHERE station_id = ? AND participant = ?")
      .bind(bearer.station_id, bearer.code)
      .run();
  Statement(
      database,
      "DELETE FROM same_person WHERE (station_a = ?1 AND code_a = ?2) OR (station_b = ?1 AND code_b = ?2)")
      .bind(bearer.station_id, bearer.code)
      .run();
  Statement(
      database,
      "DELETE FROM participant WHERE code = ?1 AND NOT EXISTS (SELECT 1 FROM session WHERE participant = ?1)"
      " AND NOT EXISTS (SELECT 1 FROM enrolment WHERE participant = ?1)")
      .bind(bearer.code)
      .run();
}

std::vector<Tombstone> new_tombstones(const Withdrawal& withdrawal) {
  const auto salt = system::new_uuid();
  const bool code_goes = !withdrawal.bearers.empty();
  std::vector<Tombstone> tombstones;
  for (const auto& session : withdrawal.sessions)
    tombstones.push_back({session.session_id, salt, code_goes ? digest(salt, session.start.participant) : "",
                          system::realtime_ns(), session.start.station_id});
  return tombstones;
}

// A row of `meta` with this key says that sessions were deleted, but not yet from the free pages of the file
// and from its copies. Its value is the folder of the backups; "" for none. Whoever follows tombstones next,
// with a folder of backups if that withdrawal had one, completes it.
constexpr const char* kErasing = "erasing";

/// True if a withdrawal was interrupted that can be completed with this folder of backups.
bool can_complete(Database& database, const std::string& backup_directory) {
  Statement row(database, "SELECT 1 FROM meta WHERE key = ? AND (value = '' OR ? <> '')");
  return row.bind(kErasing, backup_directory).step();
}

/// Writes the tombstones (the marks of withdrawals), and deletes the sessions and codes that they withdraw.
void remove_sessions(Database& database, const std::vector<Tombstone>& tombstones,
                     const std::vector<Bearer>& bearers, const std::string& backup_directory) {
  SealedTransaction transaction(database);
  Statement(database,
            "INSERT INTO meta VALUES (?1, ?2) ON CONFLICT (key) DO UPDATE SET value = ?2 WHERE value = ''")
      .bind(kErasing, backup_directory)
      .run();
  for (const auto& stone : tombstones) {
    Statement(database, "INSERT INTO tombstone VALUES (?,?,?,?,?)")
        .bind(stone.session_id, stone.salt, stone.participant_sha256, stone.withdrawn_realtime_ns,
              stone.station_id)
        .run();
    for (const auto* table :
         {"annotation", "merged", "renamed", "link", "self_test", "answer", "friction_level", "program",
          "estimate", "event", "signal", "tone", "trial", "block", "segment", "session"})
      remove(database, table, stone.session_id);
  }
  for (const auto& bearer : bearers) remove_bearer(database, bearer);
  for (const auto& [table, key] : {std::pair("protocol", "protocol_key"), std::pair("rig", "rig_key"),
                                   std::pair("calibration", "calibration_id")})
    database.execute(fmt::format(
        "DELETE FROM {0} WHERE NOT EXISTS (SELECT 1 FROM session WHERE session.{1} = {0}.{1})", table, key));
  transaction.commit();
}

/// Removes what is left of deleted rows: rewrites the file without its free pages, and empties the log.
void scrub(Database& database) {
  database.execute("PRAGMA wal_checkpoint(TRUNCATE)");
  database.execute("PRAGMA temp_store = MEMORY; VACUUM");
  Statement checkpoint(database, "PRAGMA wal_checkpoint(TRUNCATE)");
  if (!checkpoint.step() || checkpoint.integer(0) != 0)
    throw StoreError(
        ErrorKind::busy,
        fmt::format("database {}: the rows are deleted, but another program is reading the database, so its "
                    "log could not be emptied; end that program and withdraw again",
                    database.path()));
}

void note_copies(Withdrawal& withdrawal, const Copies& copies) {
  withdrawal.removed_copies = copies.own;
  withdrawal.remaining_copies = copies.foreign;
}

}  // namespace

bool is_withdrawn(Database& database, const Bearer& bearer) {
  return has_tombstone(database, bearer.station_id, bearer.code);
}

Withdrawal plan_withdrawal(const std::string& name, const WithdrawOptions& options) {
  const auto path = canonical(name);
  auto database = open_reader(path);
  auto withdrawal = choose(database, options);
  count_rows(database, withdrawal);
  note_copies(withdrawal, copies_of(path, database, options.backup_directory, ids_of(database, withdrawal)));
  return withdrawal;
}

namespace {

/// Deletes the chosen sessions from the database and its free pages, and removes the backups that contain
/// them.
void carry_out(const std::string& path, Database& database, Withdrawal& withdrawal,
               const std::vector<Tombstone>& tombstones, const std::string& backup_directory) {
  count_rows(database, withdrawal);
  auto ids = ids_of(database, withdrawal);
  // throws if a folder cannot be read, before anything is deleted
  copies_of(path, database, backup_directory, ids);
  database.execute("PRAGMA secure_delete = ON");
  remove_sessions(database, tombstones, withdrawal.bearers, backup_directory);
  scrub(database);
  try {
    if (!backup_directory.empty()) backup(path, {backup_directory, 0});
    const auto copies = copies_of(path, database, backup_directory, ids);
    note_copies(withdrawal, copies);
    remove_copies(copies, backup_directory);
    SealedTransaction transaction(database);
    Statement(database, "DELETE FROM meta WHERE key = ? AND (value = '' OR ? <> '')")
        .bind(kErasing, backup_directory)
        .run();
    transaction.commit();
  } catch (const StoreError& error) {
    throw StoreError(error.kind(), fmt::format("withdraw: the sessions were removed from the database, but "
                                               "copies of it may still contain them: {}; then withdraw again",
                                               error.what()));
  }
}

/// True if this tombstone (the mark of a withdrawal) withdraws the code, not only one session.
bool withdraws(const Tombstone& stone, const Bearer& bearer) {
  return stone.station_id == bearer.station_id && stone.participant_sha256 == digest(stone.salt, bearer.code);
}

/// What tombstones of another database have to remove from this one, and the tombstones that then remain.
struct Following {
  Withdrawal withdrawal;
  std::vector<Tombstone> tombstones;
};

/// Takes every session of a withdrawn code, also those that the other database has never seen. A tombstone
/// that names another station or another person than its session is not followed.
Following following(Database& database, const std::vector<Tombstone>& tombstones) {
  Following follow;
  Statement known(database, "SELECT 1 FROM tombstone WHERE session_id = ?");
  const auto is_new = [&](const std::string& id) { return !known.bind(id).step(); };
  std::set<std::string> foreign, there;
  for (auto& session : list_sessions(database, {})) {
    const Bearer bearer{session.start.station_id, session.start.participant};
    const auto& id = session.session_id;
    const auto own = std::find_if(tombstones.begin(), tombstones.end(), [&](const auto& stone) {
      return stone.session_id == id && stone.station_id == bearer.station_id &&
             (stone.participant_sha256.empty() || withdraws(stone, bearer));
    });
    const auto of_code = std::find_if(tombstones.begin(), tombstones.end(),
                                      [&](const auto& stone) { return withdraws(stone, bearer); });
    if (own == tombstones.end() && of_code == tombstones.end()) {
      foreign.insert(id);
      continue;
    }
    auto stone = own != tombstones.end() ? *own : *of_code;
    stone.session_id = id;
    there.insert(id);
    follow.tombstones.push_back(std::move(stone));
    follow.withdrawal.sessions.push_back(std::move(session));
  }
  for (const auto& stone : tombstones)
    if (foreign.count(stone.session_id) + there.count(stone.session_id) == 0 && is_new(stone.session_id))
      follow.tombstones.push_back(stone);
  Statement codes(
      database,
      "SELECT station_id, participant FROM enrolment UNION SELECT station_id, participant FROM session");
  while (codes.step()) {
    const Bearer bearer{codes.text(0), codes.text(1)};
    if (std::any_of(tombstones.begin(), tombstones.end(),
                    [&](const auto& stone) { return withdraws(stone, bearer); }))
      follow.withdrawal.bearers.push_back(bearer);
  }
  return follow;
}

}  // namespace

Withdrawal withdraw(const std::string& name, const WithdrawOptions& options) {
  const auto path = canonical(name);
  auto writer = open_writer(path, IfMissing::fail);
  auto& database = writer.database;
  check_pages(database);
  auto withdrawal = choose(database, options);
  carry_out(path, database, withdrawal, new_tombstones(withdrawal), options.backup_directory);
  return withdrawal;
}

std::vector<Tombstone> list_tombstones(Database& database) {
  std::vector<Tombstone> tombstones;
  Statement rows(
      database,
      "SELECT session_id, salt, participant_sha256, withdrawn_realtime_ns, station_id FROM tombstone"
      " ORDER BY session_id");
  while (rows.step())
    tombstones.push_back({rows.text(0), rows.text(1), rows.text(2), rows.integer(3), rows.text(4)});
  return tombstones;
}

Withdrawal follow_tombstones(const std::string& name, const std::vector<Tombstone>& tombstones,
                             const std::string& backup_directory) {
  const auto path = canonical(name);
  {
    auto reader = open_reader(path);
    if (const auto follow = following(reader, tombstones); follow.tombstones.empty() &&
                                                           follow.withdrawal.bearers.empty() &&
                                                           !can_complete(reader, backup_directory))
      return {};
  }
  auto writer = open_writer(path, IfMissing::fail);
  auto& database = writer.database;
  check_pages(database);
  auto follow = following(database, tombstones);
  carry_out(path, database, follow.withdrawal, follow.tombstones, backup_directory);
  return std::move(follow.withdrawal);
}

}  // namespace turnpoint::store

#include "station/store/sqlite.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

namespace turnpoint::store {

namespace {

ErrorKind kind_of(int code) {
  switch (code & 0xff) {
    case SQLITE_FULL:
      return ErrorKind::disk_full;
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return ErrorKind::read_only;
    case SQLITE_CORRUPT:
      return ErrorKind::corrupt;
    case SQLITE_NOTADB:
      return ErrorKind::not_a_database;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return ErrorKind::busy;
    case SQLITE_CANTOPEN:
      return ErrorKind::cannot_open;
    case SQLITE_CONSTRAINT:
      return ErrorKind::refused;
    default:
      return ErrorKind::io;
  }
}

const char* advice(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::disk_full:
      return "rows committed before are intact; free some space, then continue (the current trial is not "
             "lost)";
    case ErrorKind::read_only:
      return "make the file and its folder writable, or choose a database in another place";
    case ErrorKind::corrupt:
      return "the file was not changed; make a copy of it for safety and restore the newest good backup "
             "(turnpoint backup --db FILE --dir FOLDER --restore)";
    case ErrorKind::not_a_database:
      return "name a Turnpoint database, or a file that does not exist yet";
    case ErrorKind::busy:
      return "another program has the database open; end that program first";
    case ErrorKind::cannot_open:
      return "check the permissions of the file and of its folder; nothing is known to be wrong with its "
             "content";
    case ErrorKind::refused:
      return "the row violates a rule of the database and was not written";
    default:
      return "check the disk; rows committed before are intact";
  }
}

constexpr auto kTooLarge =
    "rows committed before are intact; use a disk with ext4 (FAT32 has files of at most 4 GB), or raise the "
    "limit on "
    "the size of files (ulimit -f)";

int flags_of(Database::Access access) {
  const int common = SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_URI | SQLITE_OPEN_EXRESCODE;
  switch (access) {
    case Database::Access::read_only:
    case Database::Access::immutable:
      return common | SQLITE_OPEN_READONLY;
    case Database::Access::read_write:
      return common | SQLITE_OPEN_READWRITE;
    case Database::Access::create:
      return common | SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  }
  return common;
}

/// Returns the path as a URI with special characters escaped.
std::string uri_of(const std::string& path, Database::Access access) {
  std::string uri = "file:";
  for (const char c : path) {
    if (c == '%' || c == '?' || c == '#')
      uri += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    else
      uri += c;
  }
  return access == Database::Access::immutable ? uri + "?immutable=1" : uri;
}

}  // namespace

Statement::Statement(Database& database, const std::string& sql) : database_(&database) {
  const int code = sqlite3_prepare_v3(database.handle(), sql.data(), static_cast<int>(sql.size()),
                                      SQLITE_PREPARE_PERSISTENT, &statement_, nullptr);
  if (code != SQLITE_OK) database.fail(code, "prepare " + sql.substr(0, 60));
}

Statement::Statement(Statement&& other) noexcept
    : database_(other.database_), statement_(std::exchange(other.statement_, nullptr)) {}

Statement::~Statement() { sqlite3_finalize(statement_); }

bool Statement::step() {
  const int code = sqlite3_step(statement_);
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  const std::string sql = sqlite3_sql(statement_);
  sqlite3_reset(statement_);
  database_->fail(code, sql.substr(0, sql.find('(')));
}

void Statement::run() {
  while (step()) {
  }
  reset();
}

void Statement::reset() { sqlite3_reset(statement_); }

int Statement::columns() const { return sqlite3_column_count(statement_); }
bool Statement::is_null(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_NULL; }
bool Statement::is_real(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_FLOAT; }
bool Statement::is_text(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_TEXT; }
bool Statement::is_blob(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_BLOB; }
std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_, column); }
double Statement::real(int column) const { return sqlite3_column_double(statement_, column); }

std::string Statement::text(int column) const {
  const auto* bytes = is_blob(column)
                          ? static_cast<const char*>(sqlite3_column_blob(statement_, column))
                          : reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
  if (bytes == nullptr) return "";
  return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))};
}

std::optional<std::int64_t> Statement::maybe_integer(int column) const {
  return is_null(column) ? std::nullopt : std::optional(integer(column));
}
void Statement::bind_integer(int index, std::int64_t value) {
  if (const int code = sqlite3_bind_int64(statement_, index, value)) database_->fail(code, "bind");
}
void Statement::bind_real(int index, double value) {
  // SQLite would silently store NaN as NULL, so the value would be missing.
  if (!std::isfinite(value))
    throw StoreError(ErrorKind::refused,
                     fmt::format("database {}: parameter {} of {} is not a finite number; the row "
                                 "was not written",
                                 database_->path(), index, sqlite3_sql(statement_)));
  if (const int code = sqlite3_bind_double(statement_, index, value)) database_->fail(code, "bind");
}
void Statement::bind_text(int index, const char* value, std::size_t size) {
  const int code = sqlite3_bind_text64(statement_, index, value, size, SQLITE_TRANSIENT, SQLITE_UTF8);
  if (code != SQLITE_OK) database_->fail(code, "bind");
}
void Statement::bind_blob(int index, const std::string& bytes) {
  // A null pointer would bind NULL, so an empty value needs a pointer too.
  const int code = sqlite3_bind_blob64(statement_, index, bytes.data(), bytes.size(), SQLITE_TRANSIENT);
  if (code != SQLITE_OK) database_->fail(code, "bind");
}
void Statement::bind_null(int index) {
  if (const int code = sqlite3_bind_null(statement_, index)) database_->fail(code, "bind");
}

Database::Database(const std::string& path, Access access) : path_(path) {
  const auto name = path == ":memory:" ? path : uri_of(path, access);
  const int code = sqlite3_open_v2(name.c_str(), &handle_, flags_of(access), nullptr);
  if (code == SQLITE_OK) return;
  const int system = sqlite3_system_errno(handle_);
  const std::string reason = sqlite3_errmsg(handle_);
  sqlite3_close(handle_);
  const auto kind = kind_of(code);
  throw StoreError(kind,
                   fmt::format("open database {}: {}{}; {}", path, reason,
                               system != 0 ? fmt::format(" ({})", std::strerror(system)) : "", advice(kind)));
}

// The cached statements belong to the old object, so they are not moved. Each is prepared again when it is
// next used.
Database::Database(Database&& other) noexcept
    : path_(std::move(other.path_)), handle_(std::exchange(other.handle_, nullptr)) {
  other.begin_.reset();
  other.commit_.reset();
}

Database::~Database() {
  begin_.reset();
  commit_.reset();
  sqlite3_close_v2(handle_);
}

Statement& Database::begin_statement() {
  if (!begin_) begin_ = std::make_unique<Statement>(*this, "BEGIN IMMEDIATE");
  return *begin_;
}

Statement& Database::commit_statement() {
  if (!commit_) commit_ = std::make_unique<Statement>(*this, "COMMIT");
  return *commit_;
}

void Database::execute(const std::string& sql) {
  const int code = sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(code, sql.substr(0, 60));
}

std::int64_t Database::integer(const std::string& sql) {
  Statement statement(*this, sql);
  return statement.step() ? statement.integer(0) : 0;
}

std::string Database::text(const std::string& sql) {
  Statement statement(*this, sql);
  return statement.step() ? statement.text(0) : "";
}

int Database::changes() const { return sqlite3_changes(handle_); }

void Database::fail(int code, const std::string& what) const {
  const auto kind = kind_of(code);
  if (kind == ErrorKind::io && sqlite3_system_errno(handle_) == EFBIG)
    throw StoreError(
        kind, fmt::format("database {}: {}: the file may not become larger; {}", path_, what, kTooLarge));
  throw StoreError(
      kind, fmt::format("database {}: {}: {}; {}", path_, what, sqlite3_errmsg(handle_), advice(kind)));
}

Transaction::Transaction(Database& database) : database_(database) { database_.begin_statement().run(); }

Transaction::~Transaction() {
  // If SQLite has already rolled back by itself, there is nothing to do.
  if (open_ && sqlite3_get_autocommit(database_.handle()) == 0)
    sqlite3_exec(database_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Transaction::commit() {
  database_.commit_statement().run();
  open_ = false;
}

void copy_database(Database& from, Database& to) {
  sqlite3_backup* backup = sqlite3_backup_init(to.handle(), "main", from.handle(), "main");
  if (backup == nullptr) to.fail(sqlite3_errcode(to.handle()), "copy " + from.path());
  int code = SQLITE_BUSY;
  // Copy all pages in one step. This gives a consistent snapshot and, in WAL mode, does not block writers.
  for (int tries = 0; tries < 1000 && (code == SQLITE_BUSY || code == SQLITE_LOCKED); ++tries) {
    if (tries > 0) sqlite3_sleep(5);
    code = sqlite3_backup_step(backup, -1);
  }
  sqlite3_backup_finish(backup);
  if (code != SQLITE_DONE) to.fail(code, "copy " + from.path());
}

}  // namespace turnpoint::store

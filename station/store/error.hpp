#pragma once
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace turnpoint::store {

/// The kind of a database error. The caller should react differently to each kind.
enum class ErrorKind {
  disk_full,       ///< earlier rows are intact; repeat the same call once there is space
  read_only,       ///< the file, folder or disk cannot be written
  corrupt,         ///< the file is damaged; it was not changed
  not_a_database,  ///< the file is empty, or it is not a Turnpoint database
  other_schema,    ///< another version of the program wrote the database
  cannot_open,     ///< the file exists but cannot be opened: its permissions forbid it, or it is a folder
  other_machine,   ///< the database belongs to another machine; somebody has to say what happened
  busy,            ///< another station process is using the database
  missing,         ///< there is no such file, session or participant
  conflict,        ///< rows to be added contradict existing rows
  refused,         ///< the rules of the store forbid the operation
  no_disk,         ///< the place of a backup is not on a disk of its own
  io,              ///< any other error of the disk
};

constexpr std::array store_error_names{
    "disk_full", "read_only", "corrupt",  "not_a_database", "other_schema", "cannot_open", "other_machine",
    "busy",      "missing",   "conflict", "refused",        "no_disk",      "io"};
/// Returns the name of a kind of error, as in the text catalogue.
constexpr const char* error_name(ErrorKind kind) {
  return store_error_names.at(static_cast<std::size_t>(kind));
}

/// Thrown for every failure of the store. The message says what was tried, on which file, what SQLite or the
/// system reported, and what to do.
class StoreError : public std::runtime_error {
 public:
  StoreError(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

}  // namespace turnpoint::store

#pragma once
#include <stdexcept>
#include <string>

namespace turnpoint::store {

/// The kind of database error, by what the caller can do about it.
enum class ErrorKind {
  disk_full,       ///< earlier rows are intact; repeat the same call once there is space
  read_only,       ///< the file, folder or disk cannot be written
  corrupt,         ///< the file is damaged; it was not changed
  not_a_database,  ///< empty, or not a Turnpoint database
  newer_schema,    ///< written by a newer release
  cannot_open,     ///< the file exists but cannot be opened: wrong permissions, or it is a folder
  busy,            ///< another station process is using it
  missing,         ///< no such file, session or participant
  conflict,        ///< rows contradict existing ones
  refused,         ///< the store's rules forbid it
  io,              ///< any other disk error
};

/// Every failure of the store. The message says what was tried, on which file, what SQLite or the system
/// reported, and what to do.
class StoreError : public std::runtime_error {
 public:
  StoreError(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

}  // namespace turnpoint::store

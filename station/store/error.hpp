#pragma once
#include <stdexcept>
#include <string>

namespace turnpoint::store {

/// What went wrong with a database, as far as the caller can do something about it.
enum class Fault {
  disk_full,       ///< earlier rows are intact; the same call may be repeated once there is space
  read_only,       ///< file, folder or disk cannot be written
  corrupt,         ///< the file is damaged; it is left untouched
  not_a_database,  ///< empty, or something else than a Turnpoint database
  newer_schema,    ///< written by a newer release
  cannot_open,     ///< it is there and cannot be opened: its permissions, or a folder where a file should be
  busy,            ///< another station process has it
  missing,         ///< no such file, session or participant
  conflict,        ///< rows contradict what is there
  refused,         ///< the rules of the data forbid it
  io,              ///< anything else that the disk reports
};

/// Every failure of the store. The message says what was tried, on which file, what SQLite or the system
/// said, and what to do.
class StoreError : public std::runtime_error {
 public:
  StoreError(Fault fault, const std::string& message) : std::runtime_error(message), fault_(fault) {}
  Fault fault() const { return fault_; }

 private:
  Fault fault_;
};

}  // namespace turnpoint::store

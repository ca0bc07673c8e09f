#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "station/core/file_descriptor.hpp"
#include "station/store/error.hpp"

namespace turnpoint::store {

// The files of a database: their names, owners and permissions. If root creates a file in another user's
// folder, the file is given to that user: the station runs as that user and must be able to write it. All
// functions throw StoreError.

/// Throws an error for a failed system call: "WHAT: No space left on device; ADVICE".
[[noreturn]] void fail_system(ErrorKind kind, const std::string& what, int code, const std::string& advice);
ErrorKind kind_of_errno(int code);

/// The endings of the files that SQLite keeps beside a database in use. Always move these files together with
/// the database.
inline constexpr const char* kLogSuffixes[] = {"-wal", "-shm", "-journal"};

/// True if there is a file or folder with this name. Throws if the system does not say whether there is one.
bool file_exists(const std::string& path);
/// Size in bytes; 0 if there is no such file.
std::uint64_t file_size(const std::string& path);
/// Reads all bytes of a file. Throws on a read error, so that a partly read file never looks complete.
std::string read_bytes(const std::string& path);
/// SHA-256 of a file of any size, read piece by piece.
std::string sha256_of_file(const std::string& path);
/// Returns the absolute path of the folder that contains a file.
std::string folder_of(const std::string& path);
/// Returns the names in a folder, sorted. Throws if the folder is missing or cannot be listed completely.
std::vector<std::string> list_folder(const std::string& path);

/// Returns the absolute path of a file with all links resolved. A database then has the same lock, whichever
/// of its paths was given.
std::string canonical(const std::string& path);

/// Opens the lock file, and creates it if it is missing. Throws if it is a symbolic link or has a second name
/// (hard link), and leaves it unchanged.
core::FileDescriptor open_lock(const std::string& path);

/// Creates an empty file that only its owner may read.
void create_private(const std::string& path);
/// If root created the file, gives it to the owner of the folder.
void give_to_owner_of_folder(const std::string& path);
/// Gives a file the permissions of the file `original`, restricted to those that are useful for data files.
/// If `original` does not exist, only the owner may read the file. If `original` is "", the file gets the
/// permissions of a new database: 0640.
void permit_as(const std::string& original, const std::string& path);

/// Syncs the contents of a file or folder to disk.
void sync_path(const std::string& path);

/// Returns look(). If that finds the file damaged or not a database, reads the file through and looks once
/// more: SQLite says so, too, when the disk fails to read. Throws StoreError.
template <class Look>
auto looked_at(const std::string& path, const Look& look) {
  try {
    return look();
  } catch (const StoreError& error) {
    if (error.kind() != ErrorKind::corrupt && error.kind() != ErrorKind::not_a_database) throw;
  }
  sha256_of_file(path);
  return look();
}

void rename_file(const std::string& from, const std::string& to);
/// Removes a file if it exists.
void remove_file(const std::string& path);
/// Removes a database and the files that SQLite keeps beside it. The log is removed first.
void remove_database(const std::string& path);

}  // namespace turnpoint::store

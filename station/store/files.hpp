#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "station/store/error.hpp"
#include "station/system/file_descriptor.hpp"

namespace turnpoint::store {

// The files of a database: their names, owners and permissions. Files that root creates in another user's
// folder are given to that user, because the station runs as that user and must be able to write them. All
// functions throw StoreError.

/// Reports a failed system call: "WHAT: No space left on device; ADVICE".
[[noreturn]] void fail_system(ErrorKind kind, const std::string& what, int code, const std::string& advice);
ErrorKind kind_of_errno(int code);

/// The files that SQLite keeps beside a database in use. They belong to the database, so always move them
/// together with it.
inline constexpr const char* kLogSuffixes[] = {"-wal", "-shm", "-journal"};

/// True if a file or folder of this name exists. Throws if that cannot be determined.
bool file_exists(const std::string& path);
/// Size in bytes; 0 if there is no such file.
std::uint64_t file_size(const std::string& path);
/// Reads all bytes of a file. A read error is reported and never taken for the end of the file.
std::string read_bytes(const std::string& path);
/// SHA-256 of a file of any size, read piece by piece.
std::string sha256_of_file(const std::string& path);
/// The absolute path of the folder that contains a file.
std::string folder_of(const std::string& path);
/// The sorted names in a folder. Throws if the folder is missing or cannot be read to its end.
std::vector<std::string> list_folder(const std::string& path);

/// The absolute path of a file with all links resolved, so that two names of one database share a lock.
std::string canonical(const std::string& path);

/// Opens the lock file and creates it if missing. If a link or a file with a second name is in its place, it
/// is refused and not changed.
system::FileDescriptor open_lock(const std::string& path);

/// Creates an empty file that only its owner may read.
void create_private(const std::string& path);
/// If root created the file, gives it to the owner of the folder.
void give_to_owner_of_folder(const std::string& path);
/// Gives a file the permissions of another one, restricted to those that make sense for data files. If the
/// other file does not exist, the file stays private. For "" it gets those of a new database: 0640.
void permit_as(const std::string& original, const std::string& path);

/// Syncs the contents of a file or folder to disk.
void sync_path(const std::string& path);

void rename_file(const std::string& from, const std::string& to);
/// Removes a file if it exists.
void remove_file(const std::string& path);
/// Removes a database with the files that SQLite keeps beside it, beginning with the log.
void remove_database(const std::string& path);

}  // namespace turnpoint::store

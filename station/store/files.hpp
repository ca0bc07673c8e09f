#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "station/store/error.hpp"

namespace turnpoint::store {

// The files of a database: their names, whose they are, and who may read them. What root makes anew in
// another user's folder is that user's: the station, which runs as itself, goes on with it. All throw
// StoreError.

/// A call of the system that failed: "WHAT: No space left on device; ADVICE".
[[noreturn]] void fail_system(Fault fault, const std::string& what, int code, const std::string& advice);
Fault fault_of_errno(int code);

/// What SQLite keeps beside a database that is in use. A database is its file and these: whoever moves one
/// moves all.
inline constexpr const char* kLogSuffixes[] = {"-wal", "-shm", "-journal"};

/// True where there is such a file or folder. Throws for anything but a plain no.
bool file_exists(const std::string& path);
/// In bytes; 0 where there is no such file.
std::uint64_t file_size(const std::string& path);
/// All bytes of a file; a read error is an error, not the end of the file.
std::string read_bytes(const std::string& path);
/// SHA-256 of a file of any size, read piece by piece.
std::string sha256_of_file(const std::string& path);
/// The folder that a file is in, absolute.
std::string folder_of(const std::string& path);
/// Names in a folder, sorted. A folder that cannot be listed to its end is an error, a missing one too.
std::vector<std::string> list_folder(const std::string& path);

/// The absolute name of the real file behind links, so that two names of one database share one lock.
std::string canonical(const std::string& path);

/// Opens the lock file, and makes it where there is none. Whatever else stands there, a link or a file with a
/// second name, is refused and left alone. Returns its descriptor.
int open_lock(const std::string& path);

/// Makes an empty file that only its owner may read.
void create_private(const std::string& path);
/// A file that root has made becomes the folder's owner's.
void give_to_owner_of_folder(const std::string& path);
/// Gives a file the permissions of another, as far as files of data have them; it stays private where there
/// is no other. For "" those of a new database: 0640.
void permit_as(const std::string& original, const std::string& path);

/// Makes a file's or folder's contents durable.
void sync_path(const std::string& path);

void rename_file(const std::string& from, const std::string& to);
/// Removes a file, if there is one.
void remove_file(const std::string& path);
/// The same with what SQLite keeps beside it, the log first.
void remove_database(const std::string& path);

}  // namespace turnpoint::store

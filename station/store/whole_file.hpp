#pragma once
#include <functional>
#include <string>

#include "station/store/sqlite.hpp"

namespace turnpoint::store {

// Functions that make a database file under another name, close it, open it again, check it, and only then
// rename it. Readers therefore see a complete file or none. Callers must hold the database's StationLock. All
// functions throw StoreError.

/// Makes a new, empty database. Throws StoreError (missing) if a log or an unfinished restore with this name
/// exists, because then a database of this name has been lost.
void create_file(const std::string& path);

/// Copies all of `from` into the file `to`, reads the copy back and checks it. `finish` may change the copy
/// before the check. Only the owner may read the file until it is complete. Then it gets the permissions of
/// the file `original`, from which `from` was read.
void copy_to_file(Database& from, const std::string& to, const std::string& original,
                  const std::function<void(Database&)>& finish = {});

/// Throws if the file does not exist. The message says so if only its log or an unfinished restore exists.
void refuse_absent(const std::string& path);

/// Replaces the database by `path`.restored, which copy_to_file() made. Returns the name under which the old
/// file and its log are kept; "" if there was none. If the replacement was interrupted, call this again to
/// complete it.
std::string replace_by_restored(const std::string& path);

/// Removes the unfinished files that interrupted operations on this database have left.
void remove_leftovers(const std::string& path);

/// Checks the whole file with PRAGMA quick_check and foreign_key_check. Throws StoreError (corrupt) with
/// their output.
void check_pages(Database& database);

/// Checks what can be checked without reading the whole file: header and length, the first page of every
/// table, and the last trial with all its rows. Throws StoreError (corrupt).
void check_ends(Database& database);

/// Returns the current UTC time with milliseconds, for file names.
std::string time_stamp();

}  // namespace turnpoint::store

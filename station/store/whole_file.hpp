#pragma once
#include <functional>
#include <string>

#include "station/store/sqlite.hpp"

namespace turnpoint::store {

// A database file appears complete or not at all. It is made under another name, closed, opened again and
// checked, and only then renamed. Callers hold the database's StationLock. All functions throw StoreError.

/// Makes a new, empty database. Refuses (missing) if a log or an unfinished restore exists beside the name.
void create_file(const std::string& path);

/// Writes all of `from` into the file `to`, reads it back and checks it. `finish` may change the copy before
/// the check. The file is private until it is complete; then it gets the permissions of `original`, the file
/// that `from` was read from.
void copy_to_file(Database& from, const std::string& to, const std::string& original,
                  const std::function<void(Database&)>& finish = {});

/// Throws if the file does not exist, or only its log or an unfinished restore does.
void refuse_absent(const std::string& path);

/// Replaces the database by `path`.restored, which copy_to_file() made. Returns the name under which the old
/// file and its log are kept; "" if there was none. If this is interrupted, repeating it completes the
/// replacement.
std::string replace_by_restored(const std::string& path);

/// Removes the unfinished files of interrupted operations on this database.
void remove_leftovers(const std::string& path);

/// Runs PRAGMA quick_check and foreign_key_check on the whole file. Throws StoreError (corrupt) with their
/// output.
void check_pages(Database& database);

/// Checks what can be checked without reading the whole file: its header and length, the first page of every
/// table, and the last trial with all its rows. Throws StoreError (corrupt).
void check_ends(Database& database);

/// The current UTC time with milliseconds, for file names that people read.
std::string time_stamp();

}  // namespace turnpoint::store

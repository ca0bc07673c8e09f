#pragma once
#include <functional>
#include <string>

#include "station/store/sqlite.hpp"

namespace turnpoint::store {

// A database appears under its name whole, or not at all: it is made under another name, closed, opened again
// and checked, and only then renamed. Callers hold the database's StationLock. All throw StoreError.

/// Makes a new, empty database. Refuses (missing) where a log or a half-done restore stands beside the name.
void create_file(const std::string& path);

/// Writes all of `from` into the file `to` and checks what can be read back. `finish` may change the copy
/// before that. Private until then; afterwards with the permissions of `original`, the file that `from` was
/// read from.
void copy_to_file(Database& from, const std::string& to, const std::string& original,
                  const std::function<void(Database&)>& finish = {});

/// Throws where there is no such file, or no more than its log or a half-done restore.
void refuse_absent(const std::string& path);

/// Puts `path`.restored, which copy_to_file() made, in the place of the database, and gives the name under
/// which the old file and its log are kept; "" where there was none. Wherever this is interrupted, doing it
/// again goes on.
std::string replace_by_restored(const std::string& path);

/// Removes what interrupted operations on this database have left: files that never got their name.
void remove_leftovers(const std::string& path);

/// PRAGMA quick_check and foreign_key_check of the whole file; throws StoreError (corrupt) with what they
/// say.
void check_pages(Database& database);

/// What can be checked without reading the whole file: its header and length, the first page of every table,
/// and the last trial with all that belongs to it. Throws StoreError (corrupt).
void check_ends(Database& database);

/// UTC with milliseconds, for names that people read.
std::string time_stamp();

}  // namespace turnpoint::store

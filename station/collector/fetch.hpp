#pragma once
#include <string>

#include "station/store/read.hpp"

namespace turnpoint::collector {

/// True if `database` is the address of a database on a server: postgresql://... or postgres://...
bool is_server(const std::string& database);

/// A database for a command that reads. A database on a server is first copied to a temporary file, which
/// only its owner may read and which the destructor removes. So every command reads the same rows with the
/// same code, whether they come from a file or a server. Only a few rows are in memory at a time.
///
/// The copy has the trials, events and so on of the sessions that the filter selects, and what identifies all
/// others (participants and their places, sessions, protocols), so that a participant has the same name in
/// each copy.
class ReadableDatabase {
 public:
  /// Throws ServerError, or store::StoreError (corrupt) if rows on the server differ from their checksums.
  explicit ReadableDatabase(const std::string& database, const store::SessionFilter& filter = {});
  ReadableDatabase(const ReadableDatabase&) = delete;
  ReadableDatabase& operator=(const ReadableDatabase&) = delete;
  ~ReadableDatabase();

  const std::string& path() const { return path_; }

 private:
  void fetch(const std::string& server, const store::SessionFilter& filter);
  void discard();

  /// path of the file, and the temporary folder of the copy ("" if there is no copy)
  std::string path_, folder_;
};

}  // namespace turnpoint::collector

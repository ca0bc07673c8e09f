#pragma once
#include <string>
#include <vector>

#include "station/store/checksum.hpp"

namespace turnpoint::store {

struct VerifyOptions {
  std::string session_id;  ///< check only this session; "" checks all
  std::string against;     ///< path of a sessions.csv that was exported earlier; "" for none
};

struct Verification {
  /// problems of the file as a whole (file_problems), and sessions that were exported but are no longer in it
  std::vector<std::string> problems;
  std::vector<VerifiedSession> sessions;
  bool good() const;
};

/// Checks what belongs to no single session: tables, columns, indexes, triggers and views are those that the
/// program makes; the tables without a chain of checksums, the list of sessions and their status agree with
/// the seal (seal.hpp); every participant, protocol, rig and calibration belongs to a session. Returns one
/// sentence for each problem.
std::vector<std::string> file_problems(Database& database);

/// Checks the pages and references of a database, file_problems(), and the checksum chain of every session.
/// With `against`, each session of the export must also exist, and one of its links must have the exported
/// checksum. (It need not be the last link: the session may have been continued after the export.) Reads
/// only. Throws StoreError if the database or the export cannot be read.
Verification verify(const std::string& database, const VerifyOptions& options = {});

}  // namespace turnpoint::store

#pragma once
#include <string>
#include <vector>

#include "station/store/checksum.hpp"

namespace turnpoint::store {

struct VerifyOptions {
  std::string session_id;  ///< only this session; "" checks all
  std::string against;     ///< a sessions.csv exported earlier; "" for none
};

struct Verification {
  /// problems of the file as a whole, and exported sessions missing from it
  std::vector<std::string> problems;
  std::vector<VerifiedSession> sessions;
  bool good() const;
};

/// Checks the pages and references of a database and the chain of every session. With `against`, each
/// exported session must exist and contain the exported checksum as one of its links: a session continued
/// after the export has more rows, but unchanged old ones. Only reads. Throws StoreError if the file cannot
/// be read as a database or an export.
Verification verify(const std::string& database, const VerifyOptions& options = {});

}  // namespace turnpoint::store

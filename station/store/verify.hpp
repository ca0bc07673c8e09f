#pragma once
#include <string>
#include <vector>

#include "station/store/checksum.hpp"

namespace turnpoint::store {

struct VerifyOptions {
  std::string session_id;  ///< only this one; "" checks all
  std::string against;     ///< a sessions.csv that was exported before; "" for none
};

struct Verification {
  std::vector<std::string> problems;  ///< of the file as a whole, and of sessions that it no longer holds
  std::vector<VerifiedSession> sessions;
  bool good() const;
};

/// Checks pages, references and the chain of every session of a database. With `against`, each session that
/// the export lists must be there and hold the exported checksum as one of its links: a session that was
/// continued after the export has grown, but not changed. Reads only. Throws StoreError where the file cannot
/// be read as a database or an export.
Verification verify(const std::string& database, const VerifyOptions& options = {});

}  // namespace turnpoint::store

#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "station/store/names.hpp"
#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// The rule that turns rows into hashed bytes. The bytes of an encoding never change. A later release that
/// adds columns or tables adds an encoding, and old links are still checked with their own.
constexpr int kEncoding = 1;

/// The last row of each table that belongs to a session, given by its key. Tables without rows have a value
/// below the first key.
struct Extent {
  std::int64_t segment = 0;  ///< segment_index of the last segment; the first has index 1
  std::int64_t block = -1;   ///< run_order of the last block
  std::int64_t trial = -1;   ///< trial_index of the last trial, whose tones are included
  std::int64_t event = -1;   ///< event_index of the last event
  bool operator==(const Extent&) const = default;
};

/// One link of a session's chain. Its checksum covers the previous link, the status and all rows committed
/// with it: SHA-256 of "turnpoint/ENCODING INDEX PREVIOUS", status, reason and the rows, in this order. The
/// first link also covers the session's participant, protocol, rig and calibration. Annotations are not
/// covered, because they are added afterwards.
struct Link {
  std::int64_t index = -1;  ///< position of the link in the chain, from 0; -1 for the empty chain
  std::int64_t encoding = kEncoding;
  Extent last;
  std::string status, status_reason;  ///< status of the session when the link was made
  std::string sha256;                 ///< checksum in hexadecimal; "" for the empty chain
};

class Encoder;

/// Extends the chain of one session. Every transaction that writes rows of the session adds one link.
class Chain {
 public:
  /// Continues after the last link in the database.
  Chain(Database& database, std::string session_id);
  ~Chain();
  /// Writes a link over everything written since the last one. Call it inside the caller's transaction.
  Link add();
  /// Call this once the transaction that wrote this link has been committed.
  void accept(Link link) { last_ = std::move(link); }
  const Link& last() const { return last_; }

 private:
  Database* database_;
  std::string session_id_;
  std::unique_ptr<Encoder> encoder_;
  Link last_;
};

/// The result of checking one session.
struct VerifiedSession {
  std::string session_id, participant, protocol_id;
  std::int64_t trials = 0, links = 0;
  std::string last_sha256;            ///< "" for a session that an earlier release recorded without a chain
  std::vector<std::string> problems;  ///< differences from what was recorded; empty if there are none
};

/// Checks every link of a session against its rows, and the rows against the links. `schema` is "main" or the
/// name of an attached database. If somebody rewrote both the rows and the links, this check passes: to
/// detect that, compare the last checksum with one exported earlier (holds_link).
VerifiedSession verify_session(Database& database, const std::string& session_id,
                               const std::string& schema = "main");

/// Checks every session as verify_session() does. Rows that belong to no session are found by check_pages
/// (whole_file.hpp).
std::vector<VerifiedSession> verify_database(Database& database, const std::string& schema = "main");

/// True if the session's chain contains a link with this checksum.
bool holds_link(Database& database, const std::string& session_id, const std::string& sha256);

/// The checksum of a session's last link; "" if it has no chain.
std::string last_checksum(Database& database, const std::string& session_id);

/// SHA-256 over every row of a session except its status; annotations are included. It is equal in two
/// databases exactly if they contain the same session.
std::string session_checksum(Database& database, const std::string& schema, const std::string& session_id);

}  // namespace turnpoint::store

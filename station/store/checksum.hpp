#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/store/names.hpp"
#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// The keys of a session's last row in each table. If a table has no rows, its value is below the first key.
struct Extent {
  std::int64_t segment = 0;  ///< segment_index of the last segment; the first has index 1
  std::int64_t block = -1;   ///< run_order of the last block
  std::int64_t trial = -1;   ///< trial_index of the last trial; the tones of that trial are included
  std::int64_t event = -1;   ///< event_index of the last event
  bool operator==(const Extent&) const = default;
};

/// One link of a session's checksum chain. Its checksum covers the previous link, the session's status, and
/// all rows committed together with the link: SHA-256 of "turnpoint/SCHEMA INDEX PREVIOUS", status, reason
/// and the rows, in this order. The first link also covers the session's participant, protocol, rig and
/// calibration. Annotations are not covered, because they may be added afterwards; the seal covers them
/// (seal.hpp).
struct Link {
  std::int64_t index = -1;  ///< position in the chain, from 0; -1 if the chain is empty
  Extent last;
  std::string status, status_reason;  ///< status of the session when this link was made
  std::string sha256;                 ///< checksum in hexadecimal; "" if the chain is empty
};

class Encoder;

/// Extends the chain of one session. Each transaction that writes rows of the session adds one link.
class Chain {
 public:
  /// Continues after the last link that the database contains.
  Chain(Database& database, std::string session_id);
  ~Chain();
  /// Writes a link over all rows that were written since the previous link. Call it inside the transaction
  /// that wrote the rows.
  Link add();
  /// Call this after the transaction with this link was committed.
  void accept(Link link) { last_ = std::move(link); }
  const Link& last() const { return last_; }

 private:
  Database* database_;
  std::string session_id_;
  std::unique_ptr<Encoder> encoder_;
  Link last_;
};

/// Returns the bytes that are hashed for a row: each value with its type and length, so that different rows
/// never give the same bytes.
std::string row_bytes(const Statement& row);

/// The result of checking one session.
struct VerifiedSession {
  std::string session_id, participant, protocol_id;
  std::int64_t trials = 0, links = 0;
  std::string last_sha256;            ///< checksum of the last link; "" if the links are missing
  std::vector<std::string> problems;  ///< differences from what was recorded; empty if there are none
};

/// Checks every link of a session against the rows that it covers, and checks that a link covers every row.
/// `schema` is "main" or the name of an attached database. The check cannot detect that somebody rewrote both
/// the rows and the links. To detect that, compare the last checksum with one that was exported earlier
/// (holds_link).
VerifiedSession verify_session(Database& database, const std::string& session_id,
                               const std::string& schema = "main");

/// Checks every session with verify_session().
std::vector<VerifiedSession> verify_database(Database& database, const std::string& schema = "main");

/// Computes the checksums of all links of a session anew, after its station got another name (station.hpp).
void renew_links(Database& database, const std::string& session_id);

/// True if one link of the session's chain has this checksum, or had it under an earlier name of its station.
bool holds_link(Database& database, const std::string& session_id, const std::string& sha256);

/// Returns the SHA-256 over the annotations of a session, which its chain does not cover.
std::string annotations_checksum(Database& database, const std::string& session_id);

/// Returns a link of the session's chain; empty if the chain has no link with this index.
std::optional<Link> link_at(Database& database, const std::string& session_id, std::int64_t index);

/// Returns the SHA-256 over all rows of a session, with annotations and without the status. Two databases
/// give the same value if and only if their copies of the session are equal apart from the status.
std::string session_checksum(Database& database, const std::string& schema, const std::string& session_id);

}  // namespace turnpoint::store

#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "station/store/records.hpp"
#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// How rows become the bytes that are hashed. Within one encoding these bytes never change: a later release
/// that adds columns or tables (signals) adds an encoding, and old links are still checked by theirs.
constexpr int kEncoding = 1;

/// The last row of each table that belongs to a session, by its key; below the first key where there is none.
struct Extent {
  std::int64_t segment = 0;  ///< segment_index, from 1
  std::int64_t block = -1;   ///< run_order
  std::int64_t trial = -1;   ///< trial_index; its tones come with it
  std::int64_t event = -1;   ///< event_index
  bool operator==(const Extent&) const = default;
};

/// One link of a session's chain. Its checksum covers the link before it, the status and all rows committed
/// with it: SHA-256 of "turnpoint/ENCODING INDEX PREVIOUS", status, reason and the rows, in this order. The
/// first link also covers what the session was begun with: participant, protocol, rig and calibration.
/// Annotations are outside, since they are added afterwards.
struct Link {
  std::int64_t index = -1;  ///< from 0; -1 is the empty chain
  std::int64_t encoding = kEncoding;
  Extent last;
  std::string status, status_reason;  ///< the session's when the link was made
  std::string sha256;                 ///< hexadecimal; "" for the empty chain
};

class Encoder;

/// Extends the chain of one session. Every transaction that writes rows of the session adds one link.
class Chain {
 public:
  /// Goes on after the last link that the database holds.
  Chain(Database& database, std::string session_id);
  ~Chain();
  /// Inside the caller's transaction: writes a link over everything that was written since the last one.
  Link add();
  /// The transaction that wrote this link has been committed.
  void accept(Link link) { last_ = std::move(link); }
  const Link& last() const { return last_; }

 private:
  Database* database_;
  std::string session_id_;
  std::unique_ptr<Encoder> encoder_;
  Link last_;
};

/// What checking one session has shown.
struct VerifiedSession {
  std::string session_id, participant, protocol_id;
  std::int64_t trials = 0, links = 0;
  std::string last_sha256;            ///< "" for a session that an earlier release recorded without a chain
  std::vector<std::string> problems;  ///< empty where every row is as it was written
};

/// Checks every link of a session against its rows, and the rows against the links. `schema` is "main" or the
/// name of an attached database. A session whose rows and links were both rewritten passes: compare its last
/// checksum with one that was exported before (holds_link).
VerifiedSession verify_session(Database& database, const std::string& session_id,
                               const std::string& schema = "main");

/// The same for every session. Rows that belong to no session are found by check_pages (whole_file.hpp).
std::vector<VerifiedSession> verify_database(Database& database, const std::string& schema = "main");

/// True where the chain of the session holds a link with that checksum.
bool holds_link(Database& database, const std::string& session_id, const std::string& sha256);

/// The checksum of a session's last link; "" where it has no chain.
std::string last_checksum(Database& database, const std::string& session_id);

/// SHA-256 over every row of a session but its status, annotations included: equal in two databases exactly
/// where they hold the same session.
std::string session_checksum(Database& database, const std::string& schema, const std::string& session_id);

}  // namespace turnpoint::store

#pragma once
#include <memory>
#include <string>
#include <vector>

#include "station/store/error.hpp"
#include "station/store/names.hpp"

namespace turnpoint::store {

/// What a database contains about a session, for resuming and for reports.
struct SessionRecord {
  std::string session_id;  ///< UUID
  int session_index = 0;   ///< from 1, per participant and protocol
  int sequence_index = 0;  ///< the participant's place in the protocol's counterbalancing, from 0
  SessionStatus status = SessionStatus::running;
  std::string status_reason;
  SessionStart start;
  std::string person;  ///< name of this participant in this database: the code, or CODE@STATION
  int segments = 0;
  int trials = 0;  ///< committed trials of every type and outcome
  /// wall-clock time at which the last trial or segment was committed
  std::int64_t last_activity_realtime_ns = 0;
  /// increases with every trial of this database, even if the clock goes back
  std::int64_t last_trial_id = 0;
  bool merged = false;                   ///< true if the session came from another database
  std::vector<std::string> annotations;  ///< oldest first
  std::string
      checksum;  ///< last link of its chain (checksum.hpp); "" if an earlier release recorded the session
};

/// Writes one session. This is the station's only write connection (WAL, synchronous FULL, foreign keys, an
/// exclusive lock against a second station). Not thread-safe; it belongs to the session thread. When a call
/// returns, its rows are durable. Throws StoreError with what was tried, on which file, SQLite's own message
/// and what to do.
class SessionLog {
 public:
  /// Opens or creates the database (migrating an older schema) and begins a session. A new participant code
  /// gets the protocol's next free sequence index.
  static SessionLog begin(const std::string& database, const SessionStart& start,
                          const SegmentStart& segment);

  /// Opens a new segment of an interrupted session. If a trial was presented but never ended, an event
  /// `aborted` is added and the session has to present it again.
  static SessionLog resume(const std::string& database, const std::string& session_id,
                           const SegmentStart& segment);

  SessionLog(SessionLog&&) noexcept;
  SessionLog& operator=(SessionLog&&) noexcept;
  ~SessionLog();

  const SessionRecord& session() const;                   ///< includes the checksum of the last commit
  const std::vector<BlockRecord>& stored_blocks() const;  ///< for a resumed session; empty for a new one

  /// Begins a block, or continues one that is already in the log (same index and attempt). In that case the
  /// description must be the same.
  void begin_block(const BlockStart& block);

  /// Stores at once that a stimulus is about to be presented, so that an interrupted trial leaves a trace.
  void presented(int trial_index, std::int64_t time_ns);

  /// Keeps the event in memory until the next commit of a trial or state change.
  void event(EventRow event);

  /// Commits a trial, its tones and the collected events in one transaction. If it throws, nothing was
  /// written and nothing is lost: make the same call again, for example once a full disk has space.
  void append(const TrialRow& trial);

  void annotate(const std::string& text);
  void finish(SessionStatus status, const std::string& reason);

 private:
  struct Impl;
  explicit SessionLog(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace turnpoint::store

#pragma once
#include <memory>
#include <string>
#include <vector>

#include "station/store/error.hpp"
#include "station/store/records.hpp"

namespace turnpoint::store {

/// What stands in a database about a session, for resume and for reports.
struct SessionRecord {
  std::string session_id;  ///< UUID
  int session_index = 0;   ///< from 1, within participant and protocol
  int sequence_index = 0;  ///< the participant's, from 0, within the protocol
  SessionStatus status = SessionStatus::running;
  std::string status_reason;
  SessionStart start;
  std::string person;  ///< what this participant is called in this database: the code, or CODE@STATION
  int segments = 0;
  int trials = 0;                              ///< committed, of every type and outcome
  std::int64_t last_activity_realtime_ns = 0;  ///< wall clock of the last commit of a trial or segment
  std::int64_t last_trial_id = 0;        ///< rises with every trial of this database, whatever the clock says
  bool merged = false;                   ///< came from another database
  std::vector<std::string> annotations;  ///< oldest first
  std::string
      checksum;  ///< the last link of its chain (checksum.hpp); "" where an earlier release recorded it
};

/// A block of a stored session with its finished trials, in the order run.
struct BlockRecord {
  BlockStart start;
  std::vector<TrialRow> trials;
};

/// The writer of one session: the only write connection of the station (WAL, synchronous FULL, foreign keys,
/// an exclusive lock against a second station). Not thread-safe; lives on the session thread.
/// Every call that returns has made its rows durable. Throws StoreError with what was tried, on which file,
/// SQLite's own message and what to do.
class SessionLog {
 public:
  /// Opens or creates the database (migrating an older schema) and begins a session. A participant code
  /// that is new gets the next sequence index of the protocol.
  static SessionLog begin(const std::string& database, const SessionStart& start,
                          const SegmentStart& segment);

  /// Opens a new segment of an interrupted session. A trial that was presented but never ended gets an event
  /// `aborted`, and is the session's to present again.
  static SessionLog resume(const std::string& database, const std::string& session_id,
                           const SegmentStart& segment);

  SessionLog(SessionLog&&) noexcept;
  SessionLog& operator=(SessionLog&&) noexcept;
  ~SessionLog();

  const SessionRecord& session() const;                   ///< with the checksum of the last commit
  const std::vector<BlockRecord>& stored_blocks() const;  ///< of a resumed session; empty for a new one

  /// A block that the log knows already (same index and attempt) goes on; it must be described the same way.
  void begin_block(const BlockStart& block);

  /// Committed before a stimulus: an interrupted trial leaves this trace.
  void presented(int trial_index, std::int64_t time_ns);

  /// Kept in memory until the next commit of a trial or state change.
  void event(EventRow event);

  /// One transaction: the trial, its tones and the events gathered since the last. When it throws nothing was
  /// written and nothing forgotten: the same call may be made again, once a full disk has space.
  void append(const TrialRow& trial);

  void annotate(const std::string& text);
  void finish(SessionStatus status, const std::string& reason);

 private:
  struct Impl;
  explicit SessionLog(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace turnpoint::store

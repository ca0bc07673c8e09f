#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "station/store/error.hpp"
#include "station/store/names.hpp"

namespace turnpoint::store {

/// What a database knows about a session. Needed to resume the session and to report on it.
struct SessionRecord {
  std::string session_id;     ///< UUID
  int session_index = 0;      ///< number of the session, from 1, for this participant and protocol
  int sequence_index = 0;     ///< the participant's number in the protocol's counterbalancing, from 0
  bool leased_place = false;  ///< true if a collector leased that number, so that no other station assigns it
  SessionStatus status = SessionStatus::running;
  std::string status_reason;
  SessionStart start;
  std::string person;  ///< name of this participant in this database: a code, or CODE@STATION
  int segments = 0;
  int trials = 0;  ///< number of committed trials, of every type and outcome
  /// wall-clock time at which the last trial or segment was committed
  std::int64_t last_activity_realtime_ns = 0;
  /// Highest id of the session's trials. Ids increase with every trial stored in this database, whatever the
  /// clock says.
  std::int64_t last_trial_id = 0;
  bool merged = false;                   ///< true if the session came from another database
  std::vector<std::string> annotations;  ///< notes of researchers, oldest first
  std::string checksum;                  ///< last link of the session's checksum chain (checksum.hpp)
};

/// Throws StoreError if no session could be recorded in this database: too little space, a file or folder
/// that cannot be written, or a damaged file (a file of up to 16 MiB is read as a whole). A file that does
/// not exist yet is fine. Changes nothing.
void require_recordable(const std::string& path);

/// Writes one session. It has the station's only connection for writing (WAL, synchronous FULL, foreign keys)
/// and holds a lock against a second station. Not thread-safe; it belongs to the session thread. When a
/// function other than event() returns, its rows are durable. Throws StoreError: the message says what was
/// tried, on which file, what SQLite reported, and what to do.
class SessionLog {
 public:
  /// Opens or creates the database, and begins a session. A new participant gets the protocol's next free
  /// sequence index.
  static SessionLog begin(const std::string& database, const SessionStart& start,
                          const SegmentStart& segment);

  /// Continues an interrupted session in a new segment (a new run of the program). If a trial was presented
  /// but never ended, adds an event `aborted`; the session then presents that trial again.
  static SessionLog resume(const std::string& database, const std::string& session_id,
                           const SegmentStart& segment);

  SessionLog(SessionLog&&) noexcept;
  SessionLog& operator=(SessionLog&&) noexcept;
  ~SessionLog();

  const SessionRecord& session() const;  ///< the session's record; its checksum is that of the last commit

  /// Begins a block. If the log already has a block with this index and attempt, continues that block; its
  /// other values must then be equal.
  void begin_block(const BlockStart& block);

  /// Stores at once that a stimulus is about to be presented. An interrupted trial then leaves a trace in the
  /// log.
  void presented(int trial_index, std::int64_t time_ns);

  /// Keeps an event in memory. It is written together with the next trial or change of state.
  void event(EventRow event);
  /// Commits the events kept in memory, such as the answer to a question.
  void keep_events();

  /// Commits a trial, its tones and the events kept in memory, in one transaction. If this throws, nothing
  /// was written and nothing is lost. Make the same call again, for example once there is space on a full
  /// disk.
  void append(const TrialRow& trial);

  void annotate(const std::string& text);
  void finish(SessionStatus status, const std::string& reason);

 private:
  struct Impl;
  explicit SessionLog(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Adds a researcher's note to a session that is not running. The rows of its trials do not change. Throws
/// StoreError, or core::UsageError for an empty note.
void annotate(const std::string& database, const std::string& session_id, const std::string& text);

}  // namespace turnpoint::store

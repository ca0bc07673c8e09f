#include "station/store/session_log.hpp"

#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "station/core/number.hpp"
#include "station/core/usage_error.hpp"
#include "station/store/checksum.hpp"
#include "station/store/fields.hpp"
#include "station/store/open.hpp"
#include "station/store/people.hpp"
#include "station/store/places.hpp"
#include "station/store/read.hpp"
#include "station/store/rows.hpp"
#include "station/store/seal.hpp"
#include "station/store/station.hpp"
#include "station/store/whole_file.hpp"
#include "station/store/withdraw.hpp"
#include "station/system/clocks.hpp"
#include "station/system/uuid.hpp"

namespace turnpoint::store {
namespace {

/// Free space that must be available when a session begins. A long session writes several MiB.
constexpr std::uint64_t kFreeBytesWanted = 16U << 20U;
/// A file of this size is read within a second, even from a memory card.
constexpr std::uintmax_t kQuickToRead_B = 16U << 20U;

void require_space(const std::string& database) {
  struct statvfs disk {};
  auto folder = std::filesystem::absolute(database).parent_path().string();
  // if the folder does not exist, continue: opening the file gives a better message
  if (::statvfs(folder.c_str(), &disk) != 0) return;
  const auto free_bytes = static_cast<std::uint64_t>(disk.f_bavail) * disk.f_frsize;
  if (free_bytes >= kFreeBytesWanted) return;
  throw StoreError(ErrorKind::disk_full,
                   fmt::format("database {}: only {} MiB are free on its disk, and a session needs {} MiB; "
                               "nothing was written; free some space, then begin again",
                               database, free_bytes >> 20U, kFreeBytesWanted >> 20U));
}

}  // namespace

void require_recordable(const std::string& path) {
  require_space(path);
  const auto folder = std::filesystem::absolute(path).parent_path().string();
  const bool exists = std::filesystem::exists(path);
  for (const auto& place : {folder, exists ? path : folder})
    if (::access(place.c_str(), W_OK) != 0)
      throw StoreError(
          ErrorKind::read_only,
          fmt::format("database {}: {} cannot be written ({}); nothing was changed; make it writable, "
                      "or choose a database in another place",
                      path, place, std::generic_category().message(errno)));
  if (!exists) return;
  auto database = open_reader(path);
  require_own_machine(database, machine_identity());
  if (std::filesystem::file_size(path) <= kQuickToRead_B) check_pages(database);
  list_sessions(database);
}

namespace {

void refuse(Database& database, ErrorKind kind, const std::string& what) {
  throw StoreError(kind, fmt::format("database {}: {}", database.path(), what));
}

/// Returns the participant's sequence index in the protocol's counterbalancing. A known participant keeps the
/// index. A new one gets a free place (next_place()), so that withdrawals leave no gaps in the design.
int enrol(Database& database, const SessionStart& start, std::int64_t now_ns) {
  const Bearer bearer{start.station_id, start.participant};
  if (is_withdrawn(database, bearer))
    throw StoreError(
        ErrorKind::refused,
        fmt::format(
            "database {}: participant {} has withdrawn; this code cannot be used again; choose a new code",
            database.path(), start.participant));
  Statement known(
      database,
      "SELECT sequence_index FROM enrolment WHERE protocol_id = ? AND station_id = ? AND participant = ?");
  auto same = People(database).same_as(bearer);
  same.insert(same.begin(), bearer);  // prefer the index that this station assigned
  for (const auto& one : same) {
    known.bind(start.protocol_id, one.station_id, one.code);
    if (known.step()) return static_cast<int>(known.integer(0));
  }
  Statement earlier(
      database,
      "SELECT sequence_index FROM session JOIN protocol USING (protocol_key) WHERE protocol_id = ?"
      " AND station_id = ? AND participant = ? ORDER BY session_index DESC LIMIT 1");
  for (const auto& one : same) {
    earlier.bind(start.protocol_id, one.station_id, one.code);
    if (earlier.step()) return static_cast<int>(earlier.integer(0));
  }
  const auto place = next_place(database, start, now_ns);
  Statement(database, "INSERT OR IGNORE INTO participant VALUES (?)").bind(start.participant).run();
  Statement(database, "INSERT INTO enrolment VALUES (?,?,?,?)")
      .bind(start.station_id, start.protocol_id, start.participant, place)
      .run();
  return static_cast<int>(place);
}

/// Stores a text (protocol, rig or calibration) under the hash of its fields, unless another session has
/// stored the same text already. Returns the hash.
std::string keep(Database& database, const Table<SessionRecord>& table, const SessionRecord& session,
                 const std::string& key) {
  auto sql = insert_sql(table);
  Statement statement(database, sql.replace(0, 6, "INSERT OR IGNORE"));
  bind_row(statement, table, session, key).run();
  return key;
}

std::string keep_protocol(Database& database, const SessionRecord& session) {
  const auto& start = session.start;
  return keep(database, protocol_table(), session,
              core::sha256(start.protocol_id + '\n' + start.protocol_version + '\n' + start.protocol_sha256 +
                           '\n' + start.protocol_text + '\n' + start.protocol_canonical));
}

std::string keep_rig(Database& database, const SessionRecord& session) {
  const auto& start = session.start;
  return keep(database, rig_table(), session,
              core::sha256(start.rig_name + '\n' + start.rig_sha256 + '\n' + start.rig_text));
}

int next_session_index(Database& database, const SessionStart& start) {
  Statement last(database,
                 "SELECT coalesce(max(session_index), 0) FROM session JOIN protocol USING (protocol_key)"
                 " WHERE station_id = ? AND participant = ? AND protocol_id = ?");
  std::int64_t highest = 0;
  for (const auto& bearer : People(database).same_as({start.station_id, start.participant})) {
    last.bind(bearer.station_id, bearer.code, start.protocol_id).step();
    highest = std::max(highest, last.integer(0));
  }
  return static_cast<int>(highest) + 1;
}

void insert_session(Database& database, const std::string& id, const SessionStart& start,
                    std::int64_t now_ns) {
  SessionRecord session;
  session.start = start;
  session.sequence_index = enrol(database, start, now_ns);
  session.leased_place = is_leased(database, start, session.sequence_index);
  session.session_index = next_session_index(database, start);
  if (!start.groups.empty())
    session.start.group =
        start.groups[static_cast<std::size_t>(session.sequence_index) % start.groups.size()];
  if (start.calibration_id) keep(database, calibration_table(), session, *start.calibration_id);
  const auto protocol_key = keep_protocol(database, session);
  const auto rig_key = keep_rig(database, session);
  Statement statement(database, insert_sql(session_table()));
  bind_row(statement, session_table(), session, id, protocol_key, rig_key).run();
}

void insert_segment(Database& database, const std::string& id, int index, const SegmentStart& segment) {
  Statement statement(database, insert_sql(segment_table()));
  bind_row(statement, segment_table(), segment, id, index).run();
}

void insert_block(Database& database, const std::string& id, const BlockStart& block) {
  Statement last(database, "SELECT coalesce(max(run_order), -1) + 1 FROM block WHERE session_id = ?");
  last.bind(id).step();
  Statement statement(database, insert_sql(block_table()));
  bind_row(statement, block_table(), block, id, last.integer(0)).run();
}

}  // namespace

struct SessionLog::Impl {
  explicit Impl(Writer opened) : writer(std::move(opened)), rows(writer.database) {}

  /// Writes the events kept in memory, inside the caller's transaction.
  void write_events() {
    auto index = next_event;
    for (const auto& event : events) rows.event(place, index++, event);
  }
  /// Adds a checksum link over everything that the transaction wrote, and commits. The commit also stores the
  /// events that were kept in memory.
  template <class AnyTransaction>
  void commit(AnyTransaction& transaction) {
    auto link = chain->add();
    transaction.commit();
    session.checksum = link.sha256;
    chain->accept(std::move(link));
    next_event += static_cast<std::int64_t>(events.size());
    events.clear();
  }

  Writer writer;
  RowWriter rows;
  std::optional<Chain> chain;  ///< the session's chain of checksums; set when the session's id is known
  TrialPlace place;
  SessionRecord session;
  std::vector<EventRow> events;
  std::int64_t next_event = 0;
  bool in_block = false;
};

SessionLog::SessionLog(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SessionLog::SessionLog(SessionLog&&) noexcept = default;
SessionLog& SessionLog::operator=(SessionLog&&) noexcept = default;
SessionLog::~SessionLog() = default;

SessionLog SessionLog::begin(const std::string& path, const SessionStart& start,
                             const SegmentStart& segment) {
  require_space(path);
  auto impl = std::make_unique<Impl>(open_writer(path, IfMissing::create));
  auto& database = impl->writer.database;
  const auto id = system::new_uuid();
  SealedTransaction transaction(database);
  claim_station(database, start.station_id, segment.machine);
  insert_session(database, id, start, segment.realtime_ns);
  insert_segment(database, id, 1, segment);
  impl->chain.emplace(database, id);
  impl->commit(transaction);
  impl->place = {id, 1, 0, 0};
  impl->session = session_record(database, id);
  return SessionLog(std::move(impl));
}

SessionLog SessionLog::resume(const std::string& path, const std::string& id, const SegmentStart& segment) {
  require_space(path);
  auto impl = std::make_unique<Impl>(open_writer(path, IfMissing::fail));
  auto& database = impl->writer.database;
  const auto stored = read_session(database, id);
  if (stored.session.status != SessionStatus::interrupted)
    refuse(database, ErrorKind::refused,
           fmt::format("session {} is {}; only an interrupted session can be continued", id,
                       name(stored.session.status)));
  const int index = stored.session.segments + 1;
  impl->place = {id, index, 0, 0};
  Statement last(database, "SELECT coalesce(max(event_index), -1) + 1 FROM event WHERE session_id = ?");
  last.bind(id).step();
  impl->next_event = last.integer(0);
  last.reset();
  Statement open(
      database,
      "SELECT max(trial_index) FROM event WHERE session_id = ?1 AND kind = 'presented' AND NOT EXISTS"
      " (SELECT 1 FROM trial t WHERE t.session_id = ?1 AND t.trial_index = event.trial_index)");
  open.bind(id).step();
  if (const auto trial = open.maybe_integer(0))
    impl->events.push_back({segment.monotonic_ns, "aborted",
                            "the trial was presented, but the program ended before the trial was over",
                            static_cast<int>(*trial)});
  open.reset();
  SealedTransaction transaction(database);
  claim_station(database, stored.session.start.station_id, segment.machine);
  insert_segment(database, id, index, segment);
  impl->write_events();
  Statement(database, "UPDATE session SET status = 'running', status_reason = '' WHERE session_id = ?")
      .bind(id)
      .run();
  impl->chain.emplace(database, id);
  impl->commit(transaction);
  impl->session = session_record(database, id);
  return SessionLog(std::move(impl));
}

const SessionRecord& SessionLog::session() const { return impl_->session; }

void SessionLog::begin_block(const BlockStart& block) {
  auto& database = impl_->writer.database;
  const auto& id = impl_->place.session_id;
  Statement known(database,
                  "SELECT name = ? AND instruction = ? AND practice = ? FROM block"
                  " WHERE session_id = ? AND block_index = ? AND attempt = ?");
  known.bind(block.name, block.instruction, block.practice, id, block.block_index, block.attempt);
  const bool exists = known.step();
  if (exists && known.integer(0) == 0)
    refuse(database, ErrorKind::conflict,
           fmt::format("block {} attempt {} of session {} was begun with a different name, instruction or "
                       "practice setting",
                       block.block_index, block.attempt, id));
  known.reset();
  Transaction transaction(database);
  if (!exists) insert_block(database, id, block);
  impl_->write_events();
  impl_->commit(transaction);
  impl_->place.block_index = block.block_index;
  impl_->place.attempt = block.attempt;
  impl_->in_block = true;
}

void SessionLog::event(EventRow event) { impl_->events.push_back(std::move(event)); }

void SessionLog::keep_events() {
  Transaction transaction(impl_->writer.database);
  impl_->write_events();
  impl_->commit(transaction);
}

void SessionLog::presented(int trial_index, std::int64_t time_ns) {
  const EventRow row{time_ns, "presented", "", trial_index, impl_->place.segment_index};
  Transaction transaction(impl_->writer.database);
  impl_->write_events();
  impl_->rows.event(impl_->place, impl_->next_event + static_cast<std::int64_t>(impl_->events.size()), row);
  impl_->commit(transaction);
  ++impl_->next_event;
}

void SessionLog::append(const TrialRow& trial) {
  if (!impl_->in_block)
    refuse(impl_->writer.database, ErrorKind::refused,
           "a trial was added outside a block; call begin_block first");
  const auto now = system::realtime_ns();
  Transaction transaction(impl_->writer.database);
  impl_->rows.trial(impl_->place, trial, now);
  impl_->write_events();
  impl_->commit(transaction);
  ++impl_->session.trials;
  impl_->session.last_activity_realtime_ns = now;
}

void SessionLog::annotate(const std::string& text) {
  SealedTransaction transaction(impl_->writer.database);
  Statement(impl_->writer.database, "INSERT INTO annotation VALUES (?,?,?,?)")
      .bind(system::new_uuid(), impl_->place.session_id, system::realtime_ns(), text)
      .run();
  transaction.commit();
  impl_->session.annotations.push_back(text);
}

void SessionLog::finish(SessionStatus status, const std::string& reason) {
  SealedTransaction transaction(impl_->writer.database);
  impl_->write_events();
  Statement(impl_->writer.database, "UPDATE session SET status = ?, status_reason = ? WHERE session_id = ?")
      .bind(name(status), reason, impl_->place.session_id)
      .run();
  impl_->commit(transaction);
  impl_->session.status = status;
  impl_->session.status_reason = reason;
}

void annotate(const std::string& path, const std::string& session_id, const std::string& text) {
  if (text.empty()) throw core::UsageError("annotate: the note is empty");
  auto writer = open_writer(path, IfMissing::fail);
  const auto session = session_record(writer.database, session_id);
  SealedTransaction transaction(writer.database);
  Statement(writer.database, "INSERT INTO annotation VALUES (?,?,?,?)")
      .bind(system::new_uuid(), session.session_id, system::realtime_ns(), text)
      .run();
  transaction.commit();
}

}  // namespace turnpoint::store

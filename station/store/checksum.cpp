#include "station/store/checksum.hpp"

#include <fmt/format.h>

#include <bit>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "station/core/sha256.hpp"
#include "station/store/fields.hpp"
#include "station/store/schema.hpp"

namespace turnpoint::store {

std::string row_bytes(const Statement& row) {
  std::string bytes;
  for (int i = 0; i < row.columns(); ++i) {
    const auto text = row.is_null(i)   ? std::string()
                      : row.is_real(i) ? std::to_string(std::bit_cast<std::int64_t>(row.real(i)))
                      : row.is_text(i) || row.is_blob(i) ? row.text(i)
                                                         : std::to_string(row.integer(i));
    bytes += row.is_null(i) ? 'n' : row.is_real(i) ? 'r' : row.is_text(i) ? 't' : row.is_blob(i) ? 'b' : 'i';
    bytes += std::to_string(text.size());
    bytes += ':';
    bytes += text;
  }
  return bytes + '\n';
}

/// Turns the rows of one session into the bytes that are hashed. The statements are prepared only once,
/// because each trial of a session adds two links. A link is made of rows that are read back, as each check
/// of it is: so the bytes have one source, and the first link covers texts that an earlier session has
/// stored.
class Encoder {
 public:
  /// `station` takes the place of the session's station if it is not "".
  Encoder(Database& database, std::string schema, std::string session_id, std::string station = "")
      : database_(database),
        schema_(std::move(schema)),
        id_(std::move(session_id)),
        station_(std::move(station)) {}

  /// Hashes the data with which the session started. The session's status is left out: it changes later, and
  /// each link contains it anyway.
  void add_provenance(core::Sha256& hash) const {
    auto session = session_table();
    session.fields.resize(session.fields.size() - 2);
    auto columns = column_list(session, "s.");
    constexpr std::string_view kStation = "s.station_id";
    columns.replace(columns.find(kStation), kStation.size(), "coalesce(nullif(?2, ''), s.station_id)");
    Statement row(database_,
                  fmt::format("SELECT {1}, {2}, {3}, {4} FROM {0}.session s LEFT JOIN {0}.protocol p"
                              " USING (protocol_key) LEFT JOIN {0}.rig r USING (rig_key)"
                              " LEFT JOIN {0}.calibration c USING (calibration_id) WHERE s.session_id = ?1",
                              schema_, columns, column_list(protocol_table(), "p."),
                              column_list(rig_table(), "r."), column_list(calibration_table(), "c.")));
    row.bind(id_, station_);
    while (row.step()) hash.add(row_bytes(row));
  }

  /// Hashes the session's rows after `from`, up to and including `to`, table by table.
  void add_rows(core::Sha256& hash, const Extent& from, const Extent& to) {
    add(hash, segment_, segment_table(), "segment_index", "segment_index", from.segment, to.segment);
    add(hash, block_, block_table(), "run_order", "run_order", from.block, to.block);
    add(hash, trial_, trial_table(), "trial_index", "trial_index", from.trial, to.trial);
    add(hash, tone_, tone_table(), "trial_index", "trial_index, interval_index, scene_index, tone_index",
        from.trial, to.trial);
    add(hash, signal_, signal_table(), "trial_index", "trial_index, stream", from.trial, to.trial);
    add(hash, event_, event_table(), "event_index", "event_index", from.event, to.event);
    add(hash, check_, check_table(), "event_index", "event_index, check_index", from.event, to.event);
    add(hash, answer_, answer_table(), "event_index", "event_index, answer_index", from.event, to.event);
    add(hash, friction_, friction_level_table(), "event_index", "event_index, level_index", from.event,
        to.event);
    add(hash, program_, program_table(), "event_index", "event_index, program_index", from.event, to.event);
    add(hash, estimate_, estimate_table(), "event_index", "event_index, estimate_index", from.event,
        to.event);
  }

  Extent extent() {
    Extent last;
    if (!extent_)
      extent_.emplace(database_,
                      fmt::format("SELECT (SELECT max(segment_index) FROM {0}.segment WHERE session_id = ?1),"
                                  " (SELECT max(run_order) FROM {0}.block WHERE session_id = ?1),"
                                  " (SELECT max(trial_index) FROM {0}.trial WHERE session_id = ?1),"
                                  " (SELECT max(event_index) FROM {0}.event WHERE session_id = ?1)",
                                  schema_));
    auto& row = *extent_;
    row.bind(id_).step();
    last.segment = row.maybe_integer(0).value_or(last.segment);
    last.block = row.maybe_integer(1).value_or(last.block);
    last.trial = row.maybe_integer(2).value_or(last.trial);
    last.event = row.maybe_integer(3).value_or(last.event);
    row.reset();
    return last;
  }

  /// True if the database has a tone or a signal of a trial that is newer than the last link of the checksum
  /// chain.
  bool row_beyond(std::int64_t last_trial) const {
    Statement row(database_,
                  fmt::format("SELECT 1 FROM {0}.tone WHERE session_id = ?1 AND trial_index > ?2 UNION ALL "
                              "SELECT 1 FROM {0}.signal WHERE session_id = ?1 AND trial_index > ?2 LIMIT 1",
                              schema_));
    row.bind(id_, last_trial);
    return row.step();
  }

 private:
  template <class Record>
  void add(core::Sha256& hash, std::optional<Statement>& rows, const Table<Record>& table,
           const std::string& key, const std::string& order, std::int64_t from, std::int64_t to) {
    if (from == to) return;
    if (!rows)
      rows.emplace(database_, fmt::format("SELECT {} FROM {}.{} WHERE session_id = ? AND {} > ? AND {} <= ?"
                                          " ORDER BY {}",
                                          column_list(table), schema_, table.name, key, key, order));
    hash.add(std::string(table.name) + '\n');
    rows->bind(id_, from, to);
    while (rows->step()) hash.add(row_bytes(*rows));
    rows->reset();
  }

  Database& database_;
  std::string schema_, id_, station_;
  std::optional<Statement> segment_, block_, trial_, tone_, signal_, event_, check_, answer_, friction_,
      program_, estimate_, extent_;
};

namespace {

std::string checksum_of(Encoder& encoder, const Link& previous, const Link& link) {
  core::Sha256 hash;
  hash.add(fmt::format("turnpoint/{} {} {}\n{}\n{}:{}\n", kSchema, link.index, previous.sha256, link.status,
                       link.status_reason.size(), link.status_reason));
  if (link.index == 0) encoder.add_provenance(hash);
  encoder.add_rows(hash, previous.last, link.last);
  return hash.hex();
}

constexpr const char* kLinkColumns =
    "link_index, last_segment, last_block, last_trial, last_event, status, status_reason, sha256";

Link link_from(const Statement& row) {
  Link link;
  link.index = row.integer(0);
  link.last = {row.integer(1), row.integer(2), row.integer(3), row.integer(4)};
  link.status = row.text(5);
  link.status_reason = row.text(6);
  link.sha256 = row.text(7);
  return link;
}

/// True if a session whose last link is `last` may have this status. Usually it is the status stored in the
/// link. But when a database is opened, a session whose process died gets a new status without a new link;
/// that is accepted too.
bool follows(const Link& last, const std::string& status, const std::string& reason) {
  if (status == last.status && reason == last.status_reason) return true;
  const std::string running = name(SessionStatus::running), interrupted = name(SessionStatus::interrupted);
  const bool lost = status == interrupted && reason == kLostReason;
  const bool abandoned = status == name(SessionStatus::abandoned) && reason == kAbandonedReason;
  return (last.status == running && (lost || abandoned)) || (last.status == interrupted && abandoned);
}

std::string place(const Link& previous, const Link& link) {
  std::string rows;
  const auto part = [&](const char* what, std::int64_t from, std::int64_t to) {
    if (to > from)
      rows += fmt::format("{}{} {}", rows.empty() ? "" : ", ", what,
                          from + 1 == to ? fmt::format("{}", to) : fmt::format("{} to {}", from + 1, to));
  };
  part("segment", previous.last.segment, link.last.segment);
  part("block", previous.last.block, link.last.block);
  part("trial", previous.last.trial, link.last.trial);
  part("event", previous.last.event, link.last.event);
  if (link.index == 0) rows = "the participant, protocol, rig or calibration of the session, " + rows;
  return rows.empty() ? "the session's status" : rows;
}

/// Checks each link against the rows that it covers, and counts the links. Returns the last link.
Link check_links(Database& database, const std::string& schema, VerifiedSession& verified) {
  Encoder encoder(database, schema, verified.session_id);
  Statement rows(database, fmt::format("SELECT {} FROM {}.link WHERE session_id = ? ORDER BY link_index",
                                       kLinkColumns, schema));
  rows.bind(verified.session_id);
  Link previous;
  for (; rows.step(); ++verified.links) {
    auto link = link_from(rows);
    if (link.index != previous.index + 1)
      verified.problems.push_back(fmt::format("checksum {} is missing", previous.index + 1));
    else if (checksum_of(encoder, previous, link) != link.sha256)
      verified.problems.push_back(
          fmt::format("{} differs from what was recorded (checksum {})", place(previous, link), link.index));
    previous = std::move(link);
  }
  return previous;
}

/// Returns the sessions (all, or only `session_id`) whose sequence index in the counterbalancing agrees with
/// the participant's enrolment. The enrolment must come from a station at which the participant has a
/// session. If the database has tombstones (records of withdrawn sessions), it may come from any station,
/// because the session at that station may have been withdrawn. A single query checks all sessions: a query
/// per session would read all sessions each time.
std::set<std::string> enrolled(Database& database, const std::string& schema,
                               const std::string& session_id = "") {
  std::set<std::string> ids;
  Statement rows(
      database,
      fmt::format("SELECT s.session_id FROM {0}.session s JOIN {0}.protocol p USING (protocol_key)"
                  " WHERE {1} AND (s.participant, p.protocol_id, s.sequence_index) IN"
                  "  (SELECT e.participant, e.protocol_id, e.sequence_index FROM {0}.enrolment e"
                  "   WHERE EXISTS (SELECT 1 FROM {0}.tombstone) OR (e.participant, e.station_id) IN"
                  "    (SELECT x.participant, x.station_id FROM {0}.session x))",
                  schema, session_id.empty() ? "?1 = ''" : "s.session_id = ?1"));
  rows.bind(session_id);
  while (rows.step()) ids.insert(rows.text(0));
  return ids;
}

}  // namespace

Chain::Chain(Database& database, std::string session_id)
    : database_(&database),
      session_id_(std::move(session_id)),
      encoder_(std::make_unique<Encoder>(database, "main", session_id_)) {
  Statement row(
      database,
      fmt::format("SELECT {} FROM link WHERE session_id = ? ORDER BY link_index DESC LIMIT 1", kLinkColumns));
  row.bind(session_id_);
  if (row.step()) last_ = link_from(row);
}

Chain::~Chain() = default;

Link Chain::add() {
  Link link;
  link.index = last_.index + 1;
  link.last = encoder_->extent();
  Statement status(*database_, "SELECT status, status_reason FROM session WHERE session_id = ?");
  status.bind(session_id_).step();
  link.status = status.text(0);
  link.status_reason = status.text(1);
  link.sha256 = checksum_of(*encoder_, last_, link);
  Statement(*database_,
            fmt::format("INSERT INTO link (session_id, {}) VALUES (?,?,?,?,?,?,?,?,?)", kLinkColumns))
      .bind(session_id_, link.index, link.last.segment, link.last.block, link.last.trial, link.last.event,
            link.status, link.status_reason, link.sha256)
      .run();
  return link;
}

namespace {

VerifiedSession verify_one(Database& database, const std::string& session_id, const std::string& schema,
                           const std::set<std::string>& enrolled_ids) {
  VerifiedSession verified;
  verified.session_id = session_id;
  Statement row(
      database,
      fmt::format("SELECT participant, protocol_id, status, status_reason,"
                  " (SELECT count(*) FROM {0}.trial t WHERE t.session_id = s.session_id)"
                  " FROM {0}.session s LEFT JOIN {0}.protocol p USING (protocol_key) WHERE session_id = ?",
                  schema));
  row.bind(session_id);
  if (!row.step()) {
    verified.problems.push_back("there is no session with this id");
    return verified;
  }
  verified.participant = row.text(0);
  verified.protocol_id = row.text(1);
  verified.trials = row.integer(4);
  if (enrolled_ids.count(session_id) == 0)
    verified.problems.push_back(
        "the participant is enrolled with another place in the counterbalancing than this session used");
  const auto last = check_links(database, schema, verified);
  if (verified.links == 0) {
    verified.problems.push_back("the checksums of this session are missing");
    return verified;
  }
  verified.last_sha256 = last.sha256;
  Encoder encoder(database, schema, session_id);
  if (!(encoder.extent() == last.last) || encoder.row_beyond(last.last.trial))
    verified.problems.push_back("rows were added or removed after the last checksum");
  if (!follows(last, row.text(2), row.text(3)))
    verified.problems.push_back("the session's status was changed after the last checksum");
  return verified;
}

}  // namespace

VerifiedSession verify_session(Database& database, const std::string& session_id, const std::string& schema) {
  return verify_one(database, session_id, schema, enrolled(database, schema, session_id));
}

namespace {

std::vector<Link> links_of(Database& database, const std::string& session_id) {
  std::vector<Link> links;
  Statement rows(database,
                 fmt::format("SELECT {} FROM link WHERE session_id = ? ORDER BY link_index", kLinkColumns));
  rows.bind(session_id);
  while (rows.step()) links.push_back(link_from(rows));
  return links;
}

}  // namespace

void renew_links(Database& database, const std::string& session_id) {
  Encoder encoder(database, "main", session_id);
  Statement update(database, "UPDATE link SET sha256 = ? WHERE session_id = ? AND link_index = ?");
  Link previous;
  for (auto& link : links_of(database, session_id)) {
    link.sha256 = checksum_of(encoder, previous, link);
    update.bind(link.sha256, session_id, link.index).run();
    previous = link;
  }
}

bool holds_link(Database& database, const std::string& session_id, const std::string& sha256) {
  Statement row(database, "SELECT 1 FROM link WHERE session_id = ? AND sha256 = ?");
  if (row.bind(session_id, sha256).step()) return true;
  // The rows still give the checksums that they had under an earlier name of the station.
  Statement renamed(database, "SELECT station_id, link_index FROM renamed WHERE session_id = ?");
  renamed.bind(session_id);
  while (renamed.step()) {
    Encoder encoder(database, "main", session_id, renamed.text(0));
    Link previous;
    for (auto& link : links_of(database, session_id)) {
      if (link.index > renamed.integer(1)) break;
      link.sha256 = checksum_of(encoder, previous, link);
      if (link.sha256 == sha256) return true;
      previous = link;
    }
  }
  return false;
}

std::vector<VerifiedSession> verify_database(Database& database, const std::string& schema) {
  std::vector<std::string> ids;
  Statement rows(database, "SELECT session_id FROM " + schema + ".session ORDER BY participant, session_id");
  while (rows.step()) ids.push_back(rows.text(0));
  const auto enrolled_ids = enrolled(database, schema);
  std::vector<VerifiedSession> verified;
  for (const auto& id : ids) verified.push_back(verify_one(database, id, schema, enrolled_ids));
  return verified;
}

std::string annotations_checksum(Database& database, const std::string& session_id) {
  core::Sha256 hash;
  Statement notes(database,
                  "SELECT annotation_id, realtime_ns, text FROM annotation WHERE session_id = ?"
                  " ORDER BY annotation_id");
  notes.bind(session_id);
  while (notes.step()) hash.add(row_bytes(notes));
  return hash.hex();
}

std::optional<Link> link_at(Database& database, const std::string& session_id, std::int64_t index) {
  Statement row(database,
                fmt::format("SELECT {} FROM link WHERE session_id = ? AND link_index = ?", kLinkColumns));
  row.bind(session_id, index);
  return row.step() ? std::optional(link_from(row)) : std::nullopt;
}

std::string session_checksum(Database& database, const std::string& schema, const std::string& session_id) {
  core::Sha256 hash;
  Encoder encoder(database, schema, session_id);
  encoder.add_provenance(hash);
  encoder.add_rows(hash, {}, encoder.extent());
  Statement notes(database,
                  "SELECT * FROM " + schema + ".annotation WHERE session_id = ? ORDER BY annotation_id");
  notes.bind(session_id);
  while (notes.step()) hash.add(row_bytes(notes));
  return hash.hex();
}

}  // namespace turnpoint::store

#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "station/store/names.hpp"

namespace turnpoint::store {

class Database;
struct SessionRecord;

// Places in the counterbalancing of a protocol. No two participants of a station get the same place, but
// places whose difference is a multiple of Assignment::rows have the same group and the same orders: they are
// one row of the design.
//
// Without an Assignment, a new participant gets the lowest free place. With one, the place is the lowest free
// one in the row with the fewest participants who have completed or are still expected. Somebody who has not
// completed is expected for Assignment::dropout_after_h after the last session; then the row is short of one
// participant, and the next one gets it. Participants who come back later keep their place.
//
// If several stations share a design, a collector leases places to each of them, and the station gives out
// only these, so that no place is given twice.

/// How far a participant has come.
enum class Progress {
  completed,   ///< all planned sessions are done
  expected,    ///< not completed, but the last session was not long ago, or is running
  dropped_out  ///< neither
};

/// A participant who has had a session of a protocol.
struct Participation {
  std::int64_t place = 0;  ///< place in the counterbalancing, of the newest session
  Progress progress = Progress::expected;
};

/// Returns the number of the planned session that this session does: 1 if only one is planned. Empty if it is
/// not done: not completed and, if such sessions count, without trials or still running.
std::optional<int> session_done(const SessionRecord& session, const Assignment& assignment);

/// Returns how far each participant of a protocol has come at a time. Only sessions of this run mode count.
/// Several codes of one person count once. The times are those that were recorded: if the clock is behind,
/// the participants stay expected; if it is ahead, they are dropouts too early, and their rows are given
/// again.
std::vector<Participation> participations(Database& database, const std::string& protocol_id, RunMode mode,
                                          const Assignment& assignment, std::int64_t now_ns);

/// Chooses a place that is not in `used` (sorted): one of those that are leased, or any if `leased` is empty.
/// `held` is the number of participants who have completed or are expected in each row. The place is in the
/// row that has the fewest; of several such places, it is the lowest. Empty if all leased places are used.
std::optional<std::int64_t> choose_place(const std::vector<std::int64_t>& used,
                                         const std::optional<std::vector<std::int64_t>>& leased,
                                         const std::map<std::int64_t, std::int64_t>& held, std::int64_t rows);

/// Returns the place of a new participant, whose first session begins now. Throws StoreError (refused) if
/// places are leased for this protocol, but none is left.
std::int64_t next_place(Database& database, const SessionStart& start, std::int64_t now_ns);

/// True if a collector leased this place in the counterbalancing to the station, now or when the participant
/// got it.
bool is_leased(Database& database, const SessionStart& start, std::int64_t place);

/// Replaces the list of the places in a protocol's counterbalancing that a collector has leased to this
/// station.
void set_leased_places(const std::string& database, const std::string& protocol_id,
                       const std::vector<std::int64_t>& places);

/// Returns the places in a protocol's counterbalancing that participants of this database have.
std::vector<std::int64_t> used_places(Database& database, const std::string& protocol_id);

/// Removes the leased places in a protocol's counterbalancing that no participant has, and returns them, so
/// that they can be given back to the collector.
std::vector<std::int64_t> give_up_places(const std::string& database, const std::string& protocol_id);

}  // namespace turnpoint::store

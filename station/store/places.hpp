#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "station/store/names.hpp"

namespace turnpoint::store {

class Database;

// Places in the counterbalancing of a protocol. A station alone gives the lowest free place to each new
// participant. If several stations share a design, a collector leases places to each of them, and the station
// gives out only these, so that no place is given twice.

/// Returns the lowest free place. Throws StoreError (refused) if places are leased for this protocol, but
/// none is left.
std::int64_t next_place(Database& database, const std::string& protocol_id);

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

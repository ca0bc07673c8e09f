#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "station/store/withdraw.hpp"

namespace turnpoint::collector {

/// What the server sent for this station.
struct Received {
  std::vector<store::Tombstone> tombstones;  ///< all that the server has
  /// the places in the counterbalancing of each protocol that this station may give to participants
  std::map<std::string, std::vector<std::int64_t>> places;
};

/// Returns tombstones as a JSON list of rows of table tombstone.
std::string tombstones_json(const std::vector<store::Tombstone>& tombstones);

/// Carries it out on the station's database. Throws StoreError (busy) while a session is running.
store::Withdrawal carry_out(const Received& received, const std::string& database,
                            const std::string& backup_directory);

// On a station, a user without rights to the database talks to the server, and leaves what it received in a
// file for another user who has them.

void write_received(const Received& received, const std::string& path);
/// Throws text::BadInput if the file is not one that write_received() wrote.
Received read_received(const std::string& path);

}  // namespace turnpoint::collector

#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "station/store/people.hpp"
#include "station/store/withdraw.hpp"

namespace turnpoint::collector {

/// What the server sent to this station.
struct Received {
  std::vector<store::Tombstone> tombstones;  ///< all tombstones of the server
  /// the places in the counterbalancing of each protocol that this station may give to participants
  std::map<std::string, std::vector<std::int64_t>> places;
};

/// Return a JSON list of rows of table tombstone, or same_person.
std::string tombstones_json(const std::vector<store::Tombstone>& tombstones);
std::string joins_json(const std::vector<store::Join>& joins);

/// Applies what the server sent to the station's database. Throws StoreError (busy) while a session is
/// running.
store::Withdrawal carry_out(const Received& received, const std::string& database,
                            const std::string& backup_directory);

// On a station, the user who talks to the server has no rights to the database. That user leaves what the
// server sent in a file, and another user, who has the rights, applies it.

void write_received(const Received& received, const std::string& path);
/// Throws text::BadInput if the file was not written by write_received().
Received read_received(const std::string& path);

}  // namespace turnpoint::collector

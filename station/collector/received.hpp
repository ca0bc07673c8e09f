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
  std::vector<store::Tombstone> tombstones;  ///< records of all sessions that were withdrawn
  /// the places in the counterbalancing of each protocol that this station may give to participants
  std::map<std::string, std::vector<std::int64_t>> places;
};

/// Return JSON lists for the server: of tombstones, and of joins (pairs of codes that belong to one person).
std::string tombstones_json(const std::vector<store::Tombstone>& tombstones);
std::string joins_json(const std::vector<store::Join>& joins);

/// Applies to the station's database what the server has sent. Throws StoreError (busy) while a session is
/// running.
store::Withdrawal carry_out(const Received& received, const std::string& database,
                            const std::string& backup_directory);

// On a station, the system user who talks to the server may not write to the database. That user leaves what
// the server sent in a file, and another user, who may write to the database, applies it.

void write_received(const Received& received, const std::string& path);
/// Throws core::BadInput if the file was not written by write_received().
Received read_received(const std::string& path);

}  // namespace turnpoint::collector

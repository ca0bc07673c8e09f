#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "station/store/withdraw.hpp"

namespace turnpoint::collector {

struct PushOptions {
  std::string database;
  std::string to;                ///< connection string of libpq
  std::string backup_directory;  ///< as in store::WithdrawOptions, for withdrawals that come from the server
  /// File for what the server sent (received.hpp); "" carries it out at once on the database.
  std::string received;
  /// for each protocol, how many free places in its counterbalancing this station is to have in hand
  std::map<std::string, std::int64_t> places;
  /// protocols whose leased places are given back; this station then counts alone again
  std::vector<std::string> return_places;
};

struct PushedSession {
  enum class What {
    added,
    extended,   ///< the server had an earlier part of the session
    unchanged,  ///< the server had it all
    refused,    ///< see `problem`; the server stored nothing
  };
  std::string session_id, participant, station_id;
  What what = What::unchanged;
  std::int64_t trials = 0;  ///< trials that were sent
  std::string sha256;       ///< checksum of the last link
  std::string problem;
};

const char* name(PushedSession::What what);

struct PushReport {
  std::vector<PushedSession> sessions;  ///< sessions of the stations for which the server knows this role
  std::int64_t running = 0;             ///< sessions that have not ended; they are sent later
  std::map<std::string, std::int64_t> places;  ///< for each protocol asked for, the free places in hand
  std::vector<std::string> foreign;            ///< stations in the database for which this role may not speak
  store::Withdrawal withdrawn;                 ///< what was withdrawn here because the server says so
  /// why what the server sent could not be carried out here, for example because a session is running; "" if
  /// it was
  std::string waiting;

  bool complete() const;  ///< false if a session was refused, or what the server sent still waits
};

/// Sends the sessions that have ended to a collector, exchanges withdrawals with it, and leases places.
///
/// The sessions are read from a snapshot, so a session may run meanwhile. Each is checked against its
/// checksum chain before it is sent, and sent in a transaction of its own, in which the server calculates the
/// chain again from what it has stored. Only what the server lacks is sent. If anything goes wrong at any
/// time, call it again: a session is on the server completely or not at all.
///
/// Throws ServerError if the server cannot be reached or has another schema, store::StoreError if the
/// database cannot be read. A session that the server refuses does not keep the others back.
PushReport push(const PushOptions& options);

}  // namespace turnpoint::collector

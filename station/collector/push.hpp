#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "station/store/withdraw.hpp"

namespace turnpoint::collector {

struct PushOptions {
  std::string database;
  std::string to;                ///< connection string of libpq
  std::string backup_directory;  ///< as in store::WithdrawOptions, for withdrawals that come from the server
  /// File into which to write what the server sent (received.hpp). If this is "", the withdrawals and places
  /// that it sent are applied to the database at once.
  std::string received;
  /// for each protocol, how many free places in its counterbalancing this station should hold afterwards
  std::map<std::string, std::int64_t> places;
  /// protocols whose leased places are given back; this station then assigns places by itself again
  std::vector<std::string> return_places;
  /// Says how a protocol replaces dropouts, from its sessions at these stations. The server leases the lowest
  /// places if it does not, or without this function. Called after the sessions have been sent; push() passes
  /// on what it throws.
  std::function<std::optional<core::Assignment>(const std::string& protocol_id,
                                                const std::set<std::string>& stations)>
      assignment = {};
};

struct PushedSession {
  enum class What {
    added,
    extended,   ///< the server had an earlier part of the session
    unchanged,  ///< the server already had the whole session
    refused,    ///< see `problem`; the server stored nothing
  };
  std::string session_id, participant, station_id;
  What what = What::unchanged;
  std::int64_t trials = 0;  ///< number of trials that were sent
  std::string sha256;       ///< checksum of the last link in the session's chain
  std::string problem;
};

const char* name(PushedSession::What what);

struct PushReport {
  std::vector<PushedSession> sessions;  ///< one entry for each session that this database role may send
  std::int64_t running = 0;             ///< sessions that have not ended; they are sent later
  /// for each protocol that was asked for: number of free places in its counterbalancing that this station
  /// now holds
  std::map<std::string, std::int64_t> places;
  /// stations in the database whose sessions this database role may not send: `foreign` for sessions that
  /// were merged from the database of another station, which sends them itself, `unsent` for sessions that
  /// were recorded here, which nobody else sends. The usual reason is that the station has another name now.
  std::vector<std::string> foreign, unsent;
  /// sessions that were withdrawn here, but whose withdrawal contradicts what the server knows of them
  std::vector<std::string> disputed;
  store::Withdrawal withdrawn;  ///< what was deleted here, because the server lists it as withdrawn
  /// why the withdrawals and places from the server could not be carried out here, for example because a
  /// session is running; "" if they were
  std::string waiting;

  /// False if a session or a withdrawal was refused, if a session that was recorded here may not be sent, or
  /// if withdrawals or places from the server still wait to be carried out.
  bool complete() const;
};

/// Sends the sessions that have ended to a collector, exchanges withdrawals with it, and leases places in the
/// counterbalancing of protocols.
///
/// The sessions are read from a snapshot, so a session may run meanwhile. Each session is checked against its
/// checksum chain and then sent in a separate transaction, in which the server computes the chain again from
/// the rows that it has stored. Only rows that the server lacks are sent. After any failure, simply call this
/// again: a session is either complete on the server or not there at all.
///
/// Throws ServerError if the server cannot be reached or has another schema, and store::StoreError if the
/// database cannot be read. If the server refuses a session, the others are still sent.
PushReport push(const PushOptions& options);

}  // namespace turnpoint::collector

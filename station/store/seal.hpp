#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// How many rows a table has, and the sum of their SHA-256 modulo 2^256. The order of the rows does not
/// matter.
struct Tally {
  std::int64_t rows = 0;
  std::array<std::uint64_t, 4> sum{};  ///< least significant word first
  bool operator==(const Tally&) const = default;
};

/// A transaction that changes what the chains of checksums (checksum.hpp) do not cover: which sessions there
/// are, their status and last link, and the tables without a chain. The table `seal` has a Tally of each.
///
/// commit() adds to the seal what the transaction has changed, and not what it finds. A change by anybody
/// else therefore stays visible as a difference, however often the program writes to the database afterwards.
/// The cost grows with these tables, not with the number of trials, so a trial does not seal: the last link
/// of a running session is not part of the seal.
class SealedTransaction {
 public:
  explicit SealedTransaction(Database& database);
  void commit();

 private:
  Database& database_;
  Transaction transaction_;
  std::vector<Tally> before_;
};

/// Writes the first seal of a new database.
void create_seal(Database& database);

/// Returns one sentence for each sealed table that differs from the seal; empty if there is none.
std::vector<std::string> seal_problems(Database& database);

}  // namespace turnpoint::store

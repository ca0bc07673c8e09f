#include "station/store/seal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "station/core/sha256.hpp"
#include "station/store/checksum.hpp"

namespace turnpoint::store {

namespace {

/// A sealed table, and the query for what is sealed of it.
struct Sealed {
  const char* table;
  std::string rows;
};

const std::vector<Sealed>& sealed_tables() {
  static const std::vector<Sealed> all = [] {
    std::vector<Sealed> list;
    for (const auto* table : {"meta", "participant", "enrolment", "same_person", "lease", "tombstone",
                              "protocol", "rig", "calibration", "annotation", "merged", "renamed"})
      list.push_back({table, fmt::format("SELECT * FROM {}", table)});
    list.push_back(
        {"session",
         "SELECT session_id, status, status_reason, (SELECT sha256 FROM link WHERE link.session_id ="
         " session.session_id AND status <> 'running' ORDER BY link_index DESC LIMIT 1) FROM session"});
    return list;
  }();
  return all;
}

/// Adds two sums modulo 2^256.
std::array<std::uint64_t, 4> plus(const std::array<std::uint64_t, 4>& a,
                                  const std::array<std::uint64_t, 4>& b) {
  std::array<std::uint64_t, 4> sum{};
  std::uint64_t carry = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto part = a[i] + carry;
    carry = part < carry ? 1 : 0;
    sum[i] = part + b[i];
    carry += sum[i] < part ? 1 : 0;
  }
  return sum;
}

std::array<std::uint64_t, 4> minus(const std::array<std::uint64_t, 4>& a) {
  return plus({~a[0], ~a[1], ~a[2], ~a[3]}, {1, 0, 0, 0});
}

std::string to_hex(const std::array<std::uint64_t, 4>& sum) {
  return fmt::format("{:016x}{:016x}{:016x}{:016x}", sum[3], sum[2], sum[1], sum[0]);
}

/// Returns 0 for a text that is no sum, which then differs from what is stored.
std::array<std::uint64_t, 4> from_hex(const std::string& hex) {
  std::array<std::uint64_t, 4> sum{};
  for (std::size_t i = 0; i < 4 && hex.size() == 64; ++i)
    std::from_chars(hex.data() + 16 * i, hex.data() + 16 * (i + 1), sum[3 - i], 16);
  return sum;
}

std::vector<Tally> tallies_of(Database& database) {
  std::vector<Tally> tallies;
  for (const auto& sealed : sealed_tables()) {
    auto& tally = tallies.emplace_back();
    Statement rows(database, sealed.rows);
    for (; rows.step(); ++tally.rows) tally.sum = plus(tally.sum, from_hex(core::sha256(row_bytes(rows))));
  }
  return tallies;
}

}  // namespace

SealedTransaction::SealedTransaction(Database& database)
    : database_(database), transaction_(database), before_(tallies_of(database)) {}

void SealedTransaction::commit() {
  const auto after = tallies_of(database_);
  Statement seal(database_, "SELECT row_count, row_sum FROM seal WHERE table_name = ?");
  Statement update(database_, "UPDATE seal SET row_count = ?, row_sum = ? WHERE table_name = ?");
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (after[i] == before_[i]) continue;
    const auto* table = sealed_tables()[i].table;
    if (!seal.bind(table).step()) continue;  // somebody has removed the seal, and verify says so
    const auto sum = plus(from_hex(seal.text(1)), plus(after[i].sum, minus(before_[i].sum)));
    const auto rows = seal.integer(0) + after[i].rows - before_[i].rows;
    seal.reset();
    update.bind(rows, to_hex(sum), table).run();
  }
  transaction_.commit();
}

void create_seal(Database& database) {
  Statement insert(database, "INSERT INTO seal VALUES (?,?,?)");
  const auto tallies = tallies_of(database);
  for (std::size_t i = 0; i < tallies.size(); ++i)
    insert.bind(sealed_tables()[i].table, tallies[i].rows, to_hex(tallies[i].sum)).run();
}

std::vector<std::string> seal_problems(Database& database) {
  std::vector<std::string> problems;
  const auto tallies = tallies_of(database);
  Statement seal(database, "SELECT row_count, row_sum FROM seal WHERE table_name = ?");
  for (std::size_t i = 0; i < tallies.size(); ++i) {
    const auto* table = sealed_tables()[i].table;
    if (!seal.bind(table).step())
      problems.push_back(fmt::format("table {}: the seal over its rows is missing", table));
    else if (seal.integer(0) != tallies[i].rows)
      problems.push_back(
          fmt::format("table {} has {} rows, and {} were recorded", table, tallies[i].rows, seal.integer(0)));
    else if (seal.text(1) != to_hex(tallies[i].sum))
      problems.push_back(fmt::format(
          "table {} has a row that differs from what was recorded{}", table,
          std::string_view(table) == "session" ? ": the status of a session, or its last checksum" : ""));
    seal.reset();
  }
  if (database.integer("SELECT count(*) FROM seal") > static_cast<std::int64_t>(tallies.size()))
    problems.emplace_back("table seal has a row of a table that is not sealed");
  return problems;
}

}  // namespace turnpoint::store

#pragma once
#include <cstdint>
#include <string>

#include "station/collector/postgres.hpp"
#include "station/collector/tables.hpp"
#include "station/store/sqlite.hpp"

namespace turnpoint::collector {

// Functions that copy rows between SQLite and PostgreSQL in the binary format of COPY, in which numbers keep
// all their bits. They hold only a few rows in memory, and return the number of rows copied.

/// Sends all rows of a query, whose columns must be those of `table`, with the statement `copy`. Sends
/// nothing if there are no rows.
std::int64_t send_rows(store::Statement& rows, const CollectedTable& table, Connection& server,
                       const std::string& copy);

/// Runs the statement `copy`, whose columns must be those of `table`, and inserts its rows.
std::int64_t receive_rows(Connection& server, const std::string& copy, const CollectedTable& table,
                          store::Database& database);

}  // namespace turnpoint::collector

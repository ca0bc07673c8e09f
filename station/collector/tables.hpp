#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace turnpoint::collector {

/// One column of a collected table, as it is in the station's database.
struct Column {
  std::string name;
  std::string type;  ///< INTEGER, REAL, TEXT or BLOB
  bool nullable = true;
  std::string fallback;                   ///< SQL of the value that older rows get; "" if there is none
  std::string description, unit, values;  ///< of the field, as in store/fields.hpp; "" if it has none
};

struct Reference {
  std::vector<std::string> columns;
  std::string table;
  std::vector<std::string> to;
};

/// How the checksum chain of a session covers a table. Each link of the chain is a hash over, in the order of
/// `order`, the rows whose value in the column `counter` is greater than the value that the previous link
/// stored in its column `last` (of table link).
struct ChainPart {
  std::vector<std::string> columns;
  std::string counter, order, last;
};

/// A table that a station sends to the server.
struct CollectedTable {
  std::string name;
  std::vector<Column> columns;
  std::vector<std::string> key;
  std::vector<std::vector<std::string>> unique;
  std::vector<Reference> references;
  /// how the checksum chain covers the table; empty if it is not hashed row by row
  std::optional<ChainPart> chain;
  std::vector<std::string> provenance;  ///< columns that the first link of a session's checksum chain covers

  const Column& column(std::string_view name) const;
  bool has(std::string_view name) const;
};

/// Returns the collected tables. Each comes after those to which it refers. The list is made from the schema
/// of an empty station database and from the descriptions of its columns, so that the server's tables cannot
/// differ from the station's. The table participant is not collected. Its codes, such as P01, are the same at many
/// stations, so a row that one station has not committed yet would make others wait.
const std::vector<CollectedTable>& collected_tables();

const CollectedTable& collected_table(std::string_view name);

/// Each returns names in double quotes, as PostgreSQL and SQLite both accept them; lists are separated by
/// commas.
std::string quoted(const std::string& name);
std::string quoted_list(const std::vector<std::string>& names);
std::string column_list(const CollectedTable& table);

/// Returns a text as an SQL literal.
std::string literal(const std::string& text);

}  // namespace turnpoint::collector

#pragma once
#include <string>
#include <variant>
#include <vector>

#include "station/report/chart.hpp"

namespace turnpoint::benchmark {

/// A cell of a table: empty (not measured), a text, or a number.
using Cell = std::variant<std::monostate, std::string, double>;

/// A table of results. Each row has as many cells as there are columns.
struct Table {
  std::vector<std::string> columns;  ///< names with the unit, such as "time_us"
  std::vector<std::vector<Cell>> rows;
};

struct Picture {
  std::string name;  ///< file name without extension
  report::Figure figure;
};

/// The result of one benchmark: a table and figures.
struct Report {
  std::string name;   ///< such as "physics"; also the name of the table's file
  std::string title;  ///< one line that says what was measured and on what
  Table table;
  std::vector<Picture> pictures;
};

/// Returns the table as text with aligned columns. Numbers have three digits; a cell that was not measured
/// contains "-".
std::string to_text(const Table& table);

/// Returns the table as CSV (RFC 4180), with quotes where needed. A cell that was not measured is empty.
std::string to_csv(const Table& table);

}  // namespace turnpoint::benchmark

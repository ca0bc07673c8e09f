#pragma once
#include <string>
#include <variant>
#include <vector>

#include "station/plot/chart.hpp"

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
  plot::Figure figure;
};

/// The result of one benchmark: a table and figures.
struct Report {
  std::string name;   ///< such as "physics"; also the name of the table's file
  std::string title;  ///< one line that says what was measured and on what
  Table table;
  std::vector<Picture> pictures;
};

/// The table as text with aligned columns; numbers have three digits, cells that were not measured contain
/// "-".
std::string to_text(const Table& table);

/// The table as CSV (RFC 4180): quotes where needed, an empty cell if nothing was measured.
std::string to_csv(const Table& table);

}  // namespace turnpoint::benchmark

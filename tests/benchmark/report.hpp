#pragma once
#include <string>
#include <variant>
#include <vector>

#include "station/plot/chart.hpp"

namespace turnpoint::benchmark {

/// A cell of a table: nothing measured, a text, or a number.
using Cell = std::variant<std::monostate, std::string, double>;

/// What was measured, one row a measurement; each row has as many cells as there are columns.
struct Table {
  std::vector<std::string> columns;  ///< with the unit: "time_us"
  std::vector<std::vector<Cell>> rows;
};

struct Picture {
  std::string name;  ///< of its file, without ending
  plot::Figure figure;
};

/// The outcome of one benchmark: a table, and pictures of it.
struct Report {
  std::string name;   ///< "physics", ...; also the table's file
  std::string title;  ///< one line: what was measured, on what
  Table table;
  std::vector<Picture> pictures;
};

/// Columns aligned, numbers with three digits, "-" where nothing was measured.
std::string to_text(const Table& table);

/// RFC 4180: quotes where a text needs them, an empty cell where nothing was measured.
std::string to_csv(const Table& table);

}  // namespace turnpoint::benchmark

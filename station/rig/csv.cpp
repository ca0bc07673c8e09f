#include "station/rig/csv.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <system_error>

namespace turnpoint::rig {

using core::phrase, core::plain;

namespace {

/// Returns the separator of a table, which is found in the table's first line. A semicolon is looked for
/// first, because programs that write decimal commas use it.
char separator_of(const std::string& line) {
  for (const char separator : {';', '\t'})
    if (line.find(separator) != std::string::npos) return separator;
  return ',';
}

std::vector<std::string> split(const std::string& line, char separator) {
  std::vector<std::string> cells{""};
  for (const char c : line) {
    if (c == separator)
      cells.emplace_back();
    else if (c != ' ' && c != '\t' && c != '\r' && c != '"')
      cells.back().push_back(c);
  }
  return cells;
}

bool parse_number(std::string cell, char decimal, double& value) {
  if (decimal == ',') {
    if (cell.find('.') != std::string::npos) return false;  // with decimal commas, 1.234 could also mean 1234
    std::replace(cell.begin(), cell.end(), ',', '.');
  }
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc() && end == cell.data() + cell.size() && std::isfinite(value);
}

std::string joined(const std::vector<std::string>& columns) {
  std::string all;
  for (const auto& column : columns) all += (all.empty() ? "" : ",") + column;
  return all;
}

struct Line {
  int number = 0;  ///< number of the line in the file, from 1
  std::string text;
};

/// Returns the lines of a table without comments and empty lines. A line that contains only separators is
/// empty too.
std::vector<Line> lines_of(const std::string& bytes) {
  std::istringstream in{std::string(core::without_byte_order_mark(bytes))};
  std::vector<Line> lines;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number)
    if (line[0] != '#' && line.find_first_not_of(" \t\r,;") != std::string::npos)
      lines.push_back({number, line});
  return lines;
}

}  // namespace

std::vector<std::vector<double>> read_table(const std::string& path, const std::vector<std::string>& columns,
                                            const core::Place& needed_by, core::Findings& findings,
                                            std::size_t least) {
  std::string bytes;
  try {
    bytes = core::read_text_file(path);
  } catch (const std::runtime_error& error) {
    findings.add(needed_by, phrase("cannot read %1", {plain(std::string(error.what()))}),
                 phrase("write a path relative to the rig file"));
    return {};
  }
  const auto lines = lines_of(bytes);
  const char separator = lines.empty() ? ',' : separator_of(lines.front().text);
  const bool comma = separator != ',' && std::any_of(lines.begin(), lines.end(), [](const Line& line) {
                       return line.text.find(',') != std::string::npos;
                     });
  if (!lines.empty() && split(lines.front().text, separator) != columns)
    findings.add({path, lines.front().number, 1},
                 phrase("the first line is \"%1\"", {plain(lines.front().text)}),
                 phrase("the column names must be: %1", {plain(joined(columns))}));
  std::vector<std::vector<double>> rows;
  for (std::size_t n = 1; n < lines.size(); ++n) {
    const auto cells = split(lines[n].text, separator);
    std::vector<double> row(columns.size());
    bool good = cells.size() == columns.size();
    for (std::size_t i = 0; good && i < row.size(); ++i)
      good = parse_number(cells[i], comma ? ',' : '.', row[i]);
    if (good)
      rows.push_back(std::move(row));
    else
      findings.add({path, lines[n].number, 1},
                   phrase("\"%1\" is not a row of numbers", {plain(lines[n].text)}),
                   comma ? phrase("%1 numbers are needed in each row: %2; this file has decimal commas, so "
                                  "its numbers may not have points",
                                  {plain(columns.size()), plain(joined(columns))})
                         : phrase("%1 numbers are needed in each row: %2",
                                  {plain(columns.size()), plain(joined(columns))}));
  }
  if (rows.size() < least)
    findings.add({path, 0, 0},
                 least == 2 ? phrase("the file has fewer than two rows of numbers")
                            : phrase("the file has %1 rows of numbers", {plain(rows.size())}),
                 least == 2 ? phrase("at least two rows are needed")
                            : phrase("at least %1 are needed", {plain(least)}));
  return rows;
}

}  // namespace turnpoint::rig

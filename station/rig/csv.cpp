#include "station/rig/csv.hpp"

#include <charconv>
#include <cmath>
#include <sstream>
#include <system_error>

namespace turnpoint::rig {

namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells{""};
  for (const char c : line) {
    if (c == ',')
      cells.emplace_back();
    else if (c != ' ' && c != '\t' && c != '\r')
      cells.back().push_back(c);
  }
  return cells;
}

bool parse_number(const std::string& cell, double& value) {
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc() && end == cell.data() + cell.size() && std::isfinite(value);
}

std::string joined(const std::vector<std::string>& columns) {
  std::string all;
  for (const auto& column : columns) all += (all.empty() ? "" : ",") + column;
  return all;
}

}  // namespace

std::vector<std::vector<double>> read_table(const std::string& path, const std::vector<std::string>& columns,
                                            const text::Place& needed_by, text::Findings& findings) {
  std::string bytes;
  try {
    bytes = text::read_text_file(path);
  } catch (const std::runtime_error& error) {
    findings.add(needed_by, "cannot read " + std::string(error.what()),
                 "write a path relative to the rig file");
    return {};
  }
  std::istringstream lines(bytes);
  std::string line;
  std::vector<std::vector<double>> rows;
  bool header_seen = false;
  for (int number = 1; std::getline(lines, line); ++number) {
    const auto cells = split(line);
    if ((cells.size() == 1 && cells[0].empty()) || line[0] == '#') continue;
    if (!header_seen) {
      header_seen = true;
      if (cells != columns)
        findings.add({path, number, 1}, "the first line is \"" + line + "\"",
                     "the column names must be: " + joined(columns));
      continue;
    }
    std::vector<double> row(columns.size());
    bool good = cells.size() == columns.size();
    for (std::size_t i = 0; good && i < row.size(); ++i) good = parse_number(cells[i], row[i]);
    if (good)
      rows.push_back(std::move(row));
    else
      findings.add({path, number, 1}, "\"" + line + "\" is not a row of numbers",
                   std::to_string(columns.size()) + " numbers are needed in each row: " + joined(columns));
  }
  if (rows.size() < 2)
    findings.add({path, 0, 0}, "the file has fewer than two rows of numbers", "at least two rows are needed");
  return rows;
}

}  // namespace turnpoint::rig

#include "tests/benchmark/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace turnpoint::benchmark {

namespace {

std::string shown(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* value = std::get_if<double>(&cell))
    return fmt::format(fmt::runtime(std::abs(*value) >= 1000 && std::abs(*value) < 1e7 ? "{:.0f}" : "{:.3g}"),
                       *value);
  return "-";
}

std::string quoted(const Cell& cell) {
  if (const auto* value = std::get_if<double>(&cell)) return fmt::format("{}", *value);
  if (std::holds_alternative<std::monostate>(cell)) return "";
  const auto& text = std::get<std::string>(cell);
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

}  // namespace

std::string to_text(const Table& table) {
  std::vector<std::size_t> widths;
  for (const auto& column : table.columns) widths.push_back(column.size());
  for (const auto& row : table.rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], shown(row[i]).size());
  std::string text;
  const auto add = [&](const std::string& cell, std::size_t i, bool number) {
    text += number ? fmt::format("{:>{}}", cell, widths[i]) : fmt::format("{:<{}}", cell, widths[i]);
    text += i + 1 < widths.size() ? "  " : "\n";
  };
  const auto numeric = [&](std::size_t i) {
    return std::any_of(table.rows.begin(), table.rows.end(),
                       [i](const auto& row) { return std::holds_alternative<double>(row[i]); });
  };
  for (std::size_t i = 0; i < widths.size(); ++i) add(table.columns[i], i, numeric(i));
  for (const auto& row : table.rows)
    for (std::size_t i = 0; i < widths.size(); ++i) add(shown(row[i]), i, numeric(i));
  return text;
}

std::string to_csv(const Table& table) {
  std::string text;
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    text += (i > 0 ? "," : "") + quoted(table.columns[i]);
  text += "\n";
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) text += (i > 0 ? "," : "") + quoted(row[i]);
    text += "\n";
  }
  return text;
}

}  // namespace turnpoint::benchmark

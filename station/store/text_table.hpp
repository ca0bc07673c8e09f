#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace turnpoint::store {

/// One cell of an exported table; monostate is a missing value.
using Cell = std::variant<std::monostate, std::int64_t, double, std::string>;

inline Cell cell(std::int64_t value) { return value; }
inline Cell cell(int value) { return std::int64_t{value}; }
inline Cell cell(double value) { return value; }
inline Cell cell(std::string value) { return value; }
template <class Value>
Cell cell(const std::optional<Value>& value) {
  return value ? cell(*value) : Cell{};
}

/// The format of a table: RFC 4180 (quoted where needed, CRLF) or the tab-separated form of BIDS (never
/// quoted, LF; tabs and line ends in text become spaces).
struct TableStyle {
  enum class Kind { rfc4180, bids } kind = Kind::rfc4180;
  char separator = ',';
  char decimal = '.';
};

/// Builds the text of one table. Missing values and empty texts are `n/a`. Numbers are as short as possible
/// while still reading back the same. A text that a spreadsheet would run as a formula (leading = + - @) gets
/// an apostrophe.
class TextTable {
 public:
  TextTable(const TableStyle& style, const std::vector<std::string>& columns);
  /// Throws std::logic_error unless there are as many cells as columns.
  void row(const std::vector<Cell>& cells);
  const std::string& text() const { return text_; }
  /// Returns the text added since the last call, so that a large table can be written piece by piece.
  std::string take() { return std::exchange(text_, ""); }
  std::size_t rows() const { return rows_; }

 private:
  void field(const std::string& text);
  void end_row();

  TableStyle style_;
  std::size_t columns_;
  std::size_t rows_ = 0;
  std::string text_;
};

/// Reads a table in the RFC 4180 form, line by line. The separator is whichever of , ; | and tab occurs first
/// in its first line.
std::vector<std::vector<std::string>> read_table(const std::string& text);

}  // namespace turnpoint::store

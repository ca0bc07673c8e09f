#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace turnpoint::store {

/// One field of an exported table; monostate is a value that is not there.
using Cell = std::variant<std::monostate, std::int64_t, double, std::string>;

inline Cell cell(std::int64_t value) { return value; }
inline Cell cell(int value) { return std::int64_t{value}; }
inline Cell cell(double value) { return value; }
inline Cell cell(std::string value) { return value; }
template <class Value>
Cell cell(const std::optional<Value>& value) {
  return value ? cell(*value) : Cell{};
}

/// How a table is written: RFC 4180 (quoted where needed, CRLF) or the tab-separated form of BIDS (never
/// quoted, LF, tabs and line ends in text become spaces).
struct TableStyle {
  enum class Kind { rfc4180, bids } kind = Kind::rfc4180;
  char separator = ',';
  char decimal = '.';
};

/// Builds the text of one table. Missing values and empty texts are `n/a`; numbers are the shortest that read
/// back the same; a text that a spreadsheet would run as a formula (leading = + - @) gets an apostrophe.
class TextTable {
 public:
  TextTable(const TableStyle& style, const std::vector<std::string>& columns);
  /// As many cells as there are columns; anything else is a std::logic_error.
  void row(const std::vector<Cell>& cells);
  const std::string& text() const { return text_; }
  /// The text since the last call: a large table is written piece by piece.
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

/// The fields of a table in the RFC 4180 form, line by line. The separator is the first one of , ; | and tab
/// that stands in its first line.
std::vector<std::vector<std::string>> read_table(const std::string& text);

}  // namespace turnpoint::store

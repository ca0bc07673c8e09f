#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace turnpoint::store {

/// One cell of an exported table. monostate means that the value is missing.
using Cell = std::variant<std::monostate, std::int64_t, double, std::string>;

inline Cell cell(std::int64_t value) { return value; }
inline Cell cell(int value) { return std::int64_t{value}; }
inline Cell cell(double value) { return value; }
inline Cell cell(std::string value) { return value; }
template <class Value>
Cell cell(const std::optional<Value>& value) {
  return value ? cell(*value) : Cell{};
}

/// The format of a table: RFC 4180 (quotes where needed, CRLF), or the tab-separated form of BIDS (no quotes,
/// LF; tabs and line ends within a text become spaces).
struct TableStyle {
  enum class Kind { rfc4180, bids } kind = Kind::rfc4180;
  char separator = ',';
  char decimal = '.';
  bool byte_order_mark = false;  ///< true if core::kByteOrderMark comes first
};

/// Builds the text of one table. Missing values and empty texts become `n/a`. Numbers have the shortest form
/// that reads back as the same number. A text that a spreadsheet would run as a formula (it begins with = + -
/// or @) gets an apostrophe in front.
class TextTable {
 public:
  TextTable(const TableStyle& style, const std::vector<std::string>& columns);
  /// Throws std::logic_error unless there are as many cells as columns.
  void row(const std::vector<Cell>& cells);
  const std::string& text() const { return text_; }
  /// Returns the text added since the previous call, so that a large table can be written piece by piece.
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

/// Reads a table in the RFC 4180 form, line by line; a byte order mark is left out. The separator is the
/// first of the characters , ; | and tab in the first line.
std::vector<std::vector<std::string>> read_table(const std::string& bytes);

}  // namespace turnpoint::store

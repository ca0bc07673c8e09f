#include "station/store/text_table.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <string_view>

#include "station/core/number.hpp"
#include "station/core/toml.hpp"

namespace turnpoint::store {

namespace {

/// True if the text is a number. Slider settings are stored as text. A negative setting needs no apostrophe
/// although it begins with "-", because a spreadsheet reads it as a number and not as a formula.
bool is_number(const std::string& text) {
  double value = 0;
  const auto* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  return read.ec == std::errc{} && read.ptr == end;
}

std::string defused(const std::string& text) {
  static const std::string dangerous = "=+-@\t\r";
  const bool harmless = dangerous.find(text.front()) == std::string::npos || is_number(text);
  return harmless ? text : "'" + text;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

struct Formatter {
  const TableStyle& style;

  std::string operator()(std::monostate) const { return "n/a"; }
  std::string operator()(std::int64_t value) const { return std::to_string(value); }
  std::string operator()(double value) const {
    auto text = core::exact(value);
    if (style.decimal != '.') std::replace(text.begin(), text.end(), '.', style.decimal);
    return text;
  }
  std::string operator()(const std::string& text) const { return text.empty() ? "n/a" : defused(text); }
};

}  // namespace

TextTable::TextTable(const TableStyle& style, const std::vector<std::string>& columns)
    : style_(style), columns_(columns.size()) {
  if (style_.byte_order_mark) text_ = core::kByteOrderMark;
  for (const auto& column : columns) field(column);
  end_row();
  rows_ = 0;
}

void TextTable::row(const std::vector<Cell>& cells) {
  if (cells.size() != columns_)
    throw std::logic_error("a table row must have as many cells as the table has columns");
  for (const auto& one : cells) field(std::visit(Formatter{style_}, one));
  end_row();
}

void TextTable::field(const std::string& text) {
  if (style_.kind == TableStyle::Kind::bids) {
    for (const char c : text) text_ += c == '\t' || c == '\n' || c == '\r' ? ' ' : c;
  } else {
    const std::string special = std::string("\"\r\n") + style_.separator;
    text_ += text.find_first_of(special) == std::string::npos ? text : quoted(text);
  }
  text_ += style_.separator;
}

void TextTable::end_row() {
  text_.pop_back();
  text_ += style_.kind == TableStyle::Kind::bids ? "\n" : "\r\n";
  ++rows_;
}

std::vector<std::vector<std::string>> read_table(const std::string& bytes) {
  const auto text = core::without_byte_order_mark(bytes);
  const auto mark = text.find_first_of(",;|\t\n");
  const char separator = mark == std::string_view::npos ? ',' : text[mark];
  std::vector<std::vector<std::string>> lines;
  bool quoted = false, new_line = true;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (new_line) lines.emplace_back(1);
    new_line = false;
    auto& field = lines.back().back();
    const char c = text[i];
    if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"')
      field += text[++i];
    else if (c == '"')
      quoted = !quoted;
    else if (!quoted && c == separator)
      lines.back().emplace_back();
    else if (!quoted && c == '\n')
      new_line = true;
    else if (quoted || c != '\r')
      field += c;
  }
  return lines;
}

}  // namespace turnpoint::store

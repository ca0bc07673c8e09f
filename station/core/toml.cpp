#include "station/core/toml.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <system_error>
#include <utility>

#include "station/core/read_file.hpp"

namespace turnpoint::core {

namespace {

constexpr std::size_t most_items = 10'000;  // of a list, and keys of a table
constexpr std::size_t most_parts = 16;      // of a key
constexpr int most_levels = 100;            // of lists and inline tables inside each other

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_hex(char c) { return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); }
bool is_bare(char c) {
  return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '-';
}

std::string utf8(std::uint32_t code) {
  std::string bytes;
  if (code < 0x80) return {static_cast<char>(code)};
  const int more = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
  const int lead = more == 1 ? 0xC0 : more == 2 ? 0xE0 : 0xF0;
  bytes += static_cast<char>(lead | static_cast<int>(code >> 6 * more));
  for (int k = more - 1; k >= 0; --k) bytes += static_cast<char>(0x80 | (code >> 6 * k & 0x3F));
  return bytes;
}

/// Returns the length of the UTF-8 character that begins with these bytes, or 0 if they are not UTF-8.
std::size_t character_length(std::string_view bytes) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  const auto lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || bytes.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  // no longer form than needed, no surrogates, nothing above U+10FFFF
  const bool wrong = (lead == 0xE0 && byte(1) < 0xA0) || (lead == 0xED && byte(1) > 0x9F) ||
                     (lead == 0xF0 && byte(1) < 0x90) || (lead == 0xF4 && byte(1) > 0x8F);
  return wrong ? 0 : length;
}

/// A key, which may consist of several names separated by dots.
struct DottedKey {
  std::vector<std::string> names;
  std::vector<Span> spans;
  std::vector<Place> places;
};

/// Reads TOML 1.0.
class Reader {
 public:
  Reader(std::string_view text, const std::string& path) : text_(text), path_(path) {}

  Part read() {
    root_.kind = Part::Kind::table;
    root_.scalar.place = {path_, 0, 0};
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = line_begin_ = counted_ = 3;
    root_.key = root_.value = {at_, at_};
    table_ = &root_;
    for (skip_blank_lines(); at_ < text_.size(); skip_blank_lines()) {
      if (here() == '[')
        header();
      else
        entry(*table_, true);
      skip_spaces();
      if (here() == '#') comment();
      if (at_ < text_.size() && !at_line_break())
        fail(phrase("%1 after the end of a key and its value", {character_here()}),
             phrase("one key on each line"));
    }
    return std::move(root_);
  }

 private:
  [[noreturn]] void fail(Phrase what, Phrase allowed = {}) {
    fail_at(place(), std::move(what), std::move(allowed));
  }
  [[noreturn]] static void fail_at(Place where, Phrase what, Phrase allowed = {}) {
    throw BadInput({{std::move(where), phrase("not valid TOML: %1", {std::move(what)}), std::move(allowed)}});
  }

  char here(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
  bool has(std::string_view word) const { return text_.substr(at_).starts_with(word); }
  bool at_line_break() const { return here() == '\n' || (here() == '\r' && here(1) == '\n'); }

  Place place() { return place_at(at_); }
  Place place_at(std::size_t at) {
    // Columns count characters. Places are asked for from left to right, mostly.
    if (at < counted_) counted_ = line_begin_, column_ = 1;
    for (; counted_ < at; ++counted_)
      if ((static_cast<unsigned char>(text_[counted_]) & 0xC0) != 0x80) ++column_;
    return {path_, line_, column_};
  }

  /// Names the character at this place for a message.
  Phrase character_here() const {
    if (at_ >= text_.size()) return phrase("the end of the file");
    if (at_line_break()) return phrase("the end of the line");
    const auto rest = text_.substr(at_);
    const auto length = character_length(rest);
    if (length == 0) return phrase("a byte that is not UTF-8");
    char code[16];
    if (length == 1 && rest[0] > ' ' && rest[0] < 0x7F)
      return phrase("the character %1", {plain(std::string(rest.substr(0, 1)))});
    std::uint32_t value = static_cast<unsigned char>(rest[0]) & (length == 1 ? 0x7F : 0x7F >> length);
    for (std::size_t i = 1; i < length; ++i)
      value = value << 6 | (static_cast<unsigned char>(rest[i]) & 0x3F);
    std::snprintf(code, sizeof code, "U+%04X", static_cast<unsigned>(value));
    return phrase("the character %1", {plain(code)});
  }

  void line_break() {
    at_ += here() == '\r' ? 2 : 1;
    ++line_;
    line_begin_ = counted_ = at_;
    column_ = 1;
  }

  void skip_spaces() {
    while (here() == ' ' || here() == '\t') ++at_;
  }

  /// Moves over one character of a comment or a string.
  void character(const char* where) {
    const auto c = static_cast<unsigned char>(here());
    const auto length = character_length(text_.substr(at_));
    if (length == 0) fail(phrase("a byte that is not UTF-8"), phrase("save the file as UTF-8"));
    if ((c < 0x20 && c != '\t') || c == 0x7F)
      fail(phrase("%1 in a %2", {character_here(), plain(where)}),
           phrase("write it as an escape such as \\n or \\u0000"));
    at_ += length;
  }

  void comment() {
    while (at_ < text_.size() && !at_line_break()) character("comment");
  }

  /// Skips spaces, line breaks and comments.
  void skip_blank_lines() {
    for (;;) {
      skip_spaces();
      if (here() == '#') comment();
      if (!at_line_break()) return;
      line_break();
    }
  }

  DottedKey key() {
    DottedKey key;
    for (;;) {
      skip_spaces();
      const auto begin = at_;
      key.places.push_back(place());
      if (here() == '"' || here() == '\'') {
        if (has("\"\"\"") || has("'''"))
          fail(phrase("a key in three quotes"), phrase("one quote before the key and one after it"));
        key.names.push_back(string());
      } else {
        while (is_bare(here())) ++at_;
        if (at_ == begin)
          fail(phrase("%1 in place of a key", {character_here()}),
               phrase("a key of A-Z a-z 0-9 _ -, or a key in quotes"));
        key.names.emplace_back(text_.substr(begin, at_ - begin));
      }
      key.spans.push_back({begin, at_});
      if (key.names.size() > most_parts)
        throw BadInput(
            {{place(), phrase("a key with more than %1 parts", {plain(most_parts)}), phrase("fewer dots")}});
      skip_spaces();
      if (here() != '.') return key;
      ++at_;
    }
  }

  // ---- values

  std::string string() {
    const char quote = here();
    const bool three = here(1) == quote && here(2) == quote;
    const auto began = place();
    at_ += three ? 3 : 1;
    if (three && at_line_break()) line_break();
    std::string value;
    for (;;) {
      if (at_ >= text_.size() || (!three && at_line_break()))
        fail_at(began, phrase("a text without its closing quote"));
      if (here() == quote && !three) {
        ++at_;
        return value;
      }
      if (here() == quote && here(1) == quote && here(2) == quote) {
        at_ += 3;
        // One or two quotes directly before the closing three quotes belong to the text.
        for (int more = 0; more < 2 && here() == quote; ++more, ++at_) value += quote;
        return value;
      }
      if (at_line_break()) {
        value += '\n';
        line_break();
      } else if (quote == '"' && here() == '\\') {
        escape(value, three);
      } else {
        const auto begin = at_;
        character("text");
        value += text_.substr(begin, at_ - begin);
      }
    }
  }

  void escape(std::string& value, bool three) {
    const auto began = place();
    ++at_;
    if (three) {
      // A backslash at the end of a line takes away all white space up to the next character.
      const auto back = at_;
      skip_spaces();
      if (at_line_break()) {
        while (at_line_break()) {
          line_break();
          skip_spaces();
        }
        return;
      }
      at_ = back;
    }
    const char c = here();
    const std::string_view letters = "btnfr\"\\", meant = "\b\t\n\f\r\"\\";
    if (const auto k = letters.find(c); c != '\0' && k != std::string_view::npos) {
      value += meant[k];
      ++at_;
      return;
    }
    if (c != 'u' && c != 'U')
      fail_at(began, phrase("a backslash before %1", {character_here()}),
              phrase("write \\\\ for a backslash, or end the line directly after it"));
    const std::size_t digits = c == 'u' ? 4 : 8;
    ++at_;
    std::uint32_t code = 0;
    for (std::size_t i = 0; i < digits; ++i, ++at_) {
      if (!is_hex(here()))
        fail_at(began, phrase("\\%1 without its %2 digits", {plain(std::string(1, c)), plain(digits)}));
      code = code << 4 |
             static_cast<std::uint32_t>(is_digit(here()) ? here() - '0' : (here() | 0x20) - 'a' + 10);
    }
    if (code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF))
      fail_at(began, phrase("a code that is no character"), phrase("at most 10FFFF, and not D800 to DFFF"));
    value += utf8(code);
  }

  void value(Part& part, int level) {
    part.value.begin = at_;
    part.scalar.place = place();
    if (level > most_levels) fail(phrase("more than %1 lists inside each other", {plain(most_levels)}));
    if (here() == '"' || here() == '\'') {
      part.scalar.kind = Value::Kind::string;
      part.scalar.string = string();
    } else if (here() == '[') {
      part.kind = Part::Kind::array;
      list(part, level);
    } else if (here() == '{') {
      part.kind = Part::Kind::inline_table;
      inline_table(part, level);
    } else {
      word(part.scalar);
    }
    part.value.end = at_;
  }

  void list(Part& part, int level) {
    ++at_;
    for (skip_blank_lines(); here() != ']'; skip_blank_lines()) {
      auto& item = added(part);
      item.name = std::to_string(part.parts.size() - 1);
      item.line = line_;
      item.key_place = place();
      value(item, level + 1);
      item.key = item.value;
      skip_blank_lines();
      if (here() == ',')
        ++at_;
      else if (here() != ']')
        fail(phrase("%1 in a list", {character_here()}), phrase("a comma, or ] at the end of the list"));
    }
    ++at_;
  }

  void inline_table(Part& part, int level) {
    ++at_;
    skip_spaces();
    if (here() == '}') {
      ++at_;
      return;
    }
    for (;;) {
      entry(part, false, level + 1);
      skip_spaces();
      if (here() == '}') break;
      if (here() != ',')
        fail(phrase("%1 in a table in braces", {character_here()}),
             phrase("a comma, or } at the end, all on one line"));
      ++at_;
    }
    ++at_;
  }

  /// Reads a value without quotes: true, false, a number, a date or a time.
  void word(Value& value) {
    const auto begin = at_;
    const auto began = place();
    while (is_bare(here()) || here() == '+' || here() == '.' || here() == ':') ++at_;
    // a date and a time may have a space between them
    if (at_ - begin == 10 && here() == ' ' && is_digit(here(1)) && is_digit(here(2)) && here(3) == ':' &&
        text_[begin + 4] == '-') {
      ++at_;
      while (is_bare(here()) || here() == '+' || here() == '.' || here() == ':') ++at_;
    }
    const auto written = text_.substr(begin, at_ - begin);
    if (written.empty())
      fail_at(began, phrase("%1 in place of a value", {character_here()}),
              phrase("a text in quotes, a number, true or false, a list or a table"));
    if (here() == '"' || here() == '\'')
      fail(phrase("the quote %1 follows a character directly", {plain(std::string(1, here()))}),
           phrase("put a quote at the start of a key or a value"));
    if (written == "true" || written == "false") {
      value.kind = Value::Kind::boolean;
      value.boolean = written == "true";
    } else if (is_date(written)) {
      value.kind = Value::Kind::date;
    } else if (!read_number(written, value)) {
      fail_at(began, phrase("%1 is no value", {plain("\"" + std::string(written) + "\"")}),
              phrase("a text in quotes, a number, true or false, a list or a table"));
    }
  }

  /// Returns the digits without the underscores between them; "" if an underscore is elsewhere.
  static std::string digits_of(std::string_view written, bool (*allowed)(char)) {
    std::string digits;
    for (std::size_t i = 0; i < written.size(); ++i) {
      if (written[i] == '_') {
        if (i == 0 || i + 1 == written.size() || !allowed(written[i - 1]) || !allowed(written[i + 1]))
          return "";
      } else {
        digits += written[i];
      }
    }
    return digits;
  }

  static bool read_number(std::string_view written, Value& value) {
    const bool sign = written[0] == '+' || written[0] == '-';
    const bool negative = written[0] == '-';
    const auto rest = written.substr(sign ? 1 : 0);
    if (rest == "inf" || rest == "nan") {
      value.kind = Value::Kind::number;
      value.number =
          rest == "inf" ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
      if (negative) value.number = -value.number;
      return true;
    }
    if (rest.size() > 2 && rest[0] == '0' && (rest[1] == 'x' || rest[1] == 'o' || rest[1] == 'b')) {
      if (sign) return false;
      const int base = rest[1] == 'x' ? 16 : rest[1] == 'o' ? 8 : 2;
      const auto digits = digits_of(rest.substr(2), is_hex);
      return whole(digits, base, value);
    }
    const auto digits = digits_of(rest, is_digit);
    if (digits.empty() || !is_digit(digits[0])) return false;
    std::size_t i = 0;
    while (i < digits.size() && is_digit(digits[i])) ++i;
    if (i > 1 && digits[0] == '0') return false;  // a number must not begin with 0
    if (i == digits.size()) return whole((negative ? "-" : "") + digits, 10, value);
    if (digits[i] == '.') {
      const auto point = ++i;
      while (i < digits.size() && is_digit(digits[i])) ++i;
      if (i == point) return false;
    }
    if (i < digits.size() && (digits[i] == 'e' || digits[i] == 'E')) {
      ++i;
      if (i < digits.size() && (digits[i] == '+' || digits[i] == '-')) ++i;
      const auto power = i;
      while (i < digits.size() && is_digit(digits[i])) ++i;
      if (i == power) return false;
    }
    if (i != digits.size()) return false;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value.number);
    if (end != digits.data() + digits.size()) return false;
    if (error != std::errc()) {
      // Too small for a double is 0; too large is no value.
      if (digits[0] != '0' && digits.find('-') == std::string::npos) return false;
      value.number = 0;
    }
    if (negative) value.number = -value.number;
    value.kind = Value::Kind::number;
    return true;
  }

  static bool whole(const std::string& digits, int base, Value& value) {
    const auto [end, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), value.integer, base);
    if (digits.empty() || error != std::errc() || end != digits.data() + digits.size()) return false;
    value.kind = Value::Kind::integer;
    value.number = static_cast<double>(value.integer);
    return true;
  }

  /// True for a date, a time, or both as RFC 3339 writes them. Seconds are needed.
  static bool is_date(std::string_view written) {
    // 0 stands for a digit
    const auto like = [&](std::string_view form) {
      if (written.size() < form.size()) return false;
      for (std::size_t i = 0; i < form.size(); ++i)
        if (form[i] == '0' ? !is_digit(written[i]) : written[i] != form[i]) return false;
      return true;
    };
    const auto two = [&](std::size_t at) { return 10 * (written[at] - '0') + written[at + 1] - '0'; };
    const bool date = like("0000-00-00");
    if (date) {
      const int year = 100 * two(0) + two(2), month = two(5), day = two(8);
      constexpr int lengths[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
      const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
      if (month < 1 || month > 12 || day < 1 || day > lengths[month - 1] + (leap && month == 2 ? 1 : 0))
        return false;
      written.remove_prefix(10);
      if (written.empty()) return true;
      if (written[0] != 'T' && written[0] != 't' && written[0] != ' ') return false;
      written.remove_prefix(1);
    }
    if (!like("00:00:00") || two(0) > 23 || two(3) > 59 || two(6) > 59) return false;
    written.remove_prefix(8);
    if (!written.empty() && written[0] == '.') {
      written.remove_prefix(1);
      if (written.empty() || !is_digit(written[0])) return false;
      while (!written.empty() && is_digit(written[0])) written.remove_prefix(1);
    }
    if (written.empty()) return true;
    if (!date) return false;
    if (written == "Z" || written == "z") return true;
    return written.size() == 6 && (like("+00:00") || like("-00:00")) && two(1) < 24 && two(4) < 60;
  }

  // ---- tables

  void entry(Part& table, bool whole_line, int level = 0) {
    const auto names = key();
    if (here() != '=')
      fail(phrase("%1 after a key", {character_here()}), phrase("= and the value of the key"));
    const int at_line = line_;
    ++at_;
    skip_spaces();
    auto* parent = &table;
    std::string prefix;
    for (std::size_t i = 0; i + 1 < names.names.size(); ++i) {
      prefix += (i == 0 ? "" : ".") +
                std::string(text_.substr(names.spans[i].begin, names.spans[i].end - names.spans[i].begin));
      auto* next = parent->find(names.names[i]);
      if (next == nullptr) {
        next = &dotted(*parent, names.names[i], at_line, names.places[i]);
        next->scalar.place = names.places[i];
        next->prefix = prefix;
        next->key = {names.spans.front().begin, names.spans[i].end};
        next->section = section_;
      } else if (next->kind != Part::Kind::dotted || next->prefix.empty() || next->section != section_) {
        defined_twice(names, i, *next);
      }
      parent = next;
    }
    if (const auto* other = parent->find(names.names.back()))
      defined_twice(names, names.names.size() - 1, *other);
    auto& part = added(*parent);
    part.name = names.names.back(), part.line = at_line;
    part.key = {names.spans.front().begin, names.spans.back().end};
    part.key_place = names.places.back();
    value(part, level);
    // A table that consists of dotted keys extends to the end of the last of these keys.
    auto* above = &table;
    for (std::size_t i = 0; i + 1 < names.names.size(); ++i) {
      above = above->find(names.names[i]);
      above->value = {above->key.begin, part.value.end};
    }
    if (whole_line) table.value.end = line_end(text_, part.value.end);
  }

  [[noreturn]] static void defined_twice(const DottedKey& key, std::size_t i, const Part& other) {
    fail_at(
        key.places[i],
        phrase("\"%1\" is defined twice; line %2 has it already", {plain(key.names[i]), plain(other.line)}),
        phrase("every key and every table once"));
  }

  /// Adds a part to a list or a table. Keys are searched for one after the other, so a table is no longer
  /// than a list may be.
  Part& added(Part& parent) {
    if (parent.parts.size() >= most_items) {
      const bool list = parent.kind == Part::Kind::array || parent.kind == Part::Kind::table_array;
      throw BadInput({{place(),
                       phrase(list ? "a list of more than %1 items" : "a table of more than %1 keys",
                              {plain(most_items)}),
                       phrase("at most %1", {plain(most_items)})}});
    }
    return parent.parts.emplace_back();
  }

  Part& dotted(Part& parent, const std::string& name, int at_line, const Place& key_place) {
    auto& made = added(parent);
    made.kind = Part::Kind::dotted, made.name = name, made.line = at_line, made.key_place = key_place;
    return made;
  }

  void header() {
    const auto begin = at_;
    const auto began = place();
    const int at_line = line_;
    const bool of_list = here(1) == '[';
    at_ += of_list ? 2 : 1;
    const auto names = key();
    if (!has(of_list ? "]]" : "]"))
      fail(phrase("%1 in the header of a table", {character_here()}),
           phrase(of_list ? "]] after its name" : "] after its name"));
    at_ += of_list ? 2 : 1;
    ++section_;
    auto* parent = &root_;
    for (std::size_t i = 0; i + 1 < names.names.size(); ++i) {
      auto* next = parent->find(names.names[i]);
      if (next == nullptr) {
        next = &dotted(*parent, names.names[i], at_line, names.places[i]);
        next->scalar.place = began;
      }
      if (next->kind == Part::Kind::table_array) next = &next->parts.back();
      if (next->kind != Part::Kind::table && next->kind != Part::Kind::dotted) defined_twice(names, i, *next);
      parent = next;
    }
    auto* part = parent->find(names.names.back());
    const bool fresh = part == nullptr;
    const bool open = fresh || (of_list ? part->kind == Part::Kind::table_array
                                        : part->kind == Part::Kind::dotted && part->prefix.empty());
    if (!open) defined_twice(names, names.names.size() - 1, *part);
    if (fresh) {
      part = &added(*parent);
      part->name = names.names.back(), part->line = at_line, part->key_place = names.places.back();
      part->scalar.place = began;
    }
    if (of_list) {
      part->kind = Part::Kind::table_array;
      const auto count = part->parts.size();
      part = &added(*part);
      part->name = std::to_string(count);
    }
    part->kind = Part::Kind::table;
    part->scalar.place = began;
    part->line = at_line, part->key = {begin, at_}, part->header_names = names.spans;
    part->value = {begin, line_end(text_, at_)};
    table_ = part;
  }

  std::string_view text_;
  std::string path_;
  std::size_t at_ = 0, line_begin_ = 0, counted_ = 0;
  int line_ = 1, column_ = 1;
  int section_ = 0;  ///< counts the headers
  Part root_;
  Part* table_ = nullptr;
};

}  // namespace

const Part* Part::find(std::string_view wanted) const {
  const auto found =
      std::find_if(parts.begin(), parts.end(), [&](const Part& p) { return p.name == wanted; });
  return found == parts.end() ? nullptr : &*found;
}

Part* Part::find(std::string_view wanted) {
  return const_cast<Part*>(static_cast<const Part&>(*this).find(wanted));
}

Part parts_of(std::string_view source, const std::string& path) { return Reader(source, path).read(); }

Value value_of(const Part& part) {
  Value value = part.scalar;
  if (part.kind == Part::Kind::scalar) return value;
  if (part.kind == Part::Kind::array || part.kind == Part::Kind::table_array) {
    value.kind = Value::Kind::array;
    for (const auto& item : part.parts) value.items.push_back(value_of(item));
    return value;
  }
  value.kind = Value::Kind::table;
  for (const auto& below : part.parts)
    value.entries.push_back({below.name, below.key_place, value_of(below)});
  // The keys of a table may be written in several places of the file.
  std::stable_sort(value.entries.begin(), value.entries.end(), [](const Entry& a, const Entry& b) {
    return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
  });
  return value;
}

Value parse_toml(std::string_view source, const std::string& path) {
  return value_of(parts_of(source, path));
}

std::size_t line_end(std::string_view text, std::size_t at) {
  const auto end = std::min(text.find('\n', at), text.size());
  return end > at && text[end - 1] == '\r' ? end - 1 : end;
}

const Entry* Value::find(const std::string& key) const {
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.key == key; });
  return found == entries.end() ? nullptr : &*found;
}

Phrase describe(const Value& value) {
  switch (value.kind) {
    case Value::Kind::boolean:
      return plain(value.boolean ? "true" : "false");
    case Value::Kind::integer:
    case Value::Kind::number:
      return phrase("a number");
    case Value::Kind::string:
      return phrase("the text \"%1\"", {plain(value.string)});
    case Value::Kind::date:
      return phrase("a date or time");
    case Value::Kind::array:
      return phrase("a list");
    case Value::Kind::table:
      break;
  }
  return phrase("a table");
}

std::string read_text_file(const std::string& path) try {
  return core::read_file(path, most_text_bytes);
} catch (const std::system_error& error) {
  if (error.code() == std::errc::no_such_file_or_directory)
    throw BadInput({{{path, 0, 0}, phrase("there is no such file"), phrase("check the path")}});
  if (error.code() == std::errc::is_a_directory)
    throw BadInput({{{path, 0, 0}, phrase("this is a folder"), phrase("name a file")}});
  if (error.code() != std::errc::file_too_large) throw;
  throw BadInput(
      {{{path, 0, 0}, phrase("the file has more than 4 MiB"), phrase("at most %1", {plain("4 MiB")})}});
}

std::string_view without_byte_order_mark(std::string_view text) {
  return text.starts_with(kByteOrderMark) ? text.substr(kByteOrderMark.size()) : text;
}

}  // namespace turnpoint::core

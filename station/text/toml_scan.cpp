#include "station/text/toml_scan.hpp"

#include <cstdint>
#include <cstdio>
#include <string_view>

#include "station/text/problem.hpp"

namespace turnpoint::text {

using texts::phrase, texts::plain;

namespace {

struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 1;
};

// Decodes the UTF-8 character at `at`. An invalid byte counts as a character of its own; the parser reports
// it.
Character character_at(std::string_view text, std::size_t at) {
  const auto lead = static_cast<unsigned char>(text[at]);
  const std::size_t bytes = lead < 0x80 ? 1 : lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC0 ? 2 : 1;
  if (bytes == 1 || at + bytes > text.size()) return {lead, 1};
  std::uint32_t code = lead & (0x7F >> bytes);
  for (std::size_t i = 1; i < bytes; ++i)
    code = code << 6 | (static_cast<unsigned char>(text[at + i]) & 0x3F);
  return {code, bytes};
}

std::string printed(const char* format, std::uint32_t code) {
  char buffer[16];
  std::snprintf(buffer, sizeof buffer, format, static_cast<unsigned>(code));
  return buffer;
}

// Reads through the source and keeps track of whether it is inside a string or a comment. It ignores errors
// that the parser reports anyway, such as strings that are not closed.
class Scanner {
 public:
  Scanner(std::string_view source, const std::string& path) : source_(source), path_(path) {}

  std::string scan() {
    // A byte-order mark at the very beginning is allowed.
    if (source_.starts_with("\xEF\xBB\xBF")) copy(3);
    while (at_ < source_.size()) step();
    return std::move(out_);
  }

 private:
  void step() {
    const auto character = character_at(source_, at_);
    if (source_[at_] == '\n') {
      if (quote_.size() < 3) quote_ = {};
      comment_ = false;
      parts_ = 1;
      trimming_ = quote_.size() == 3 && (trimming_ || escaped_);
      escaped_ = false;
      copy(1);
      ++line_;
      column_ = 1;
    } else if (comment_) {
      copy(character.bytes);
    } else if (quote_.empty()) {
      outside(character);
    } else {
      inside(character);
    }
  }

  void outside(const Character& character) {
    if (character.code >= 0x80)
      throw BadInput({{{path_, line_, column_},
                       phrase("not valid TOML: the character %1 outside of quotes",
                              {plain(printed("U+%04X", character.code))}),
                       phrase("keys without quotes may contain only A-Z a-z 0-9 _ -")}});
    const char c = source_[at_];
    if (c == '#') comment_ = true;
    count_parts(c);
    if (c == '"' || c == '\'') {
      check_before_quote(c);
      const bool three = source_.substr(at_, 3) == std::string_view(c == '"' ? "\"\"\"" : "'''");
      quote_ = source_.substr(at_, three ? 3 : 1);
      copy(quote_.size());
    } else {
      copy(1);
    }
  }

  // After a number or another bare word, the parser also reads the characters of a quoted text that follows
  // directly. It is not made for those beyond ASCII. No valid file has such a quote.
  void check_before_quote(char quote) const {
    if (at_ == 0 || std::string_view(" \t\r\n=,.[{").find(source_[at_ - 1]) != std::string_view::npos) return;
    if (at_ == 3 && source_.starts_with("\xEF\xBB\xBF")) return;
    throw BadInput(
        {{{path_, line_, column_},
          phrase("not valid TOML: the quote %1 follows a character directly", {plain(std::string(1, quote))}),
          phrase("put a quote at the start of a key or a value")}});
  }

  // Counts the dotted parts of a key. The parser recurses for each part, so a key with very many parts would
  // exhaust the stack.
  void count_parts(char c) {
    if (c == '.')
      ++parts_;
    else if (std::string_view("=,[]{}#").find(c) != std::string_view::npos)
      parts_ = 1;
    if (parts_ > most_parts)
      throw BadInput({{{path_, line_, column_},
                       phrase("a key with more than %1 parts", {plain(most_parts)}),
                       phrase("fewer dots")}});
  }

  void inside(const Character& character) {
    if (!escaped_ && source_.substr(at_).starts_with(quote_)) {
      copy(quote_.size());
      // A multi-line string may end with one or two quotes as part of its text, directly before the three
      // that close it.
      while (quote_.size() == 3 && at_ < source_.size() && source_[at_] == quote_[0]) copy(1);
      quote_ = {};
      trimming_ = false;
      return;
    }
    const bool blank = character.code == ' ' || character.code == '\t' || character.code == '\r';
    const bool was_escaped = escaped_;
    // A backslash that ends a line may be followed by white space on that line, but by nothing else.
    escaped_ = quote_[0] == '"' && ((!was_escaped && character.code == '\\') || (was_escaped && blank));
    if (was_escaped && character.code >= 0x80)
      throw BadInput({{{path_, line_, column_},
                       phrase("not valid TOML: a backslash before the character %1",
                              {plain(printed("U+%04X", character.code))}),
                       phrase("write \\\\ for a backslash, or end the line directly after it")}});
    if (trimming_ && character.code >= 0x80) {
      out_ += printed("\\U%08X", character.code);
      at_ += character.bytes;
      ++column_;
    } else {
      copy(character.bytes);
    }
    if (!blank) trimming_ = false;
  }

  void copy(std::size_t bytes) {
    out_ += source_.substr(at_, bytes);
    at_ += bytes;
    ++column_;
  }

  static constexpr int most_parts = 16;

  std::string_view source_;
  int parts_ = 1;  ///< parts of the current key
  std::string path_, out_;
  std::string_view quote_;  // the quotes that will close the current string; empty outside strings
  std::size_t at_ = 0;
  int line_ = 1, column_ = 1;
  bool comment_ = false, escaped_ = false, trimming_ = false;
};

}  // namespace

std::string safe_for_parser(const std::string& source, const std::string& path) {
  return Scanner(source, path).scan();
}

}  // namespace turnpoint::text

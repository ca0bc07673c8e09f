#include "station/design/parts.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "station/text/toml.hpp"

namespace turnpoint::design {

namespace {

/// A key, which may consist of several names separated by dots, and the place of each name in the text.
struct Key {
  std::vector<std::string> names;
  std::vector<Span> spans;
};

/// Reads a text that toml++ has already accepted, so it need not report syntax errors.
class Reader {
 public:
  explicit Reader(const std::string& text) : text_(text) {}

  Part read() {
    root_.kind = Part::Kind::table;
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
    root_.key = root_.value = {at_, at_};
    table_ = &root_;
    for (skip_blank_lines(); at_ < text_.size(); skip_blank_lines()) {
      if (text_[at_] == '[')
        header();
      else
        entry(*table_, true);
    }
    return std::move(root_);
  }

 private:
  char here(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }

  void skip_spaces() {
    while (here() == ' ' || here() == '\t') ++at_;
  }
  /// Skips spaces, line breaks and comments.
  void skip_blank_lines() {
    for (;;) {
      if (here() == '#')
        at_ = line_end(text_, at_);
      else if (at_ < text_.size() && std::string_view(" \t\r\n").find(here()) != std::string_view::npos)
        ++at_;
      else
        return;
    }
  }

  int line() {
    line_ += static_cast<int>(std::count(text_.begin() + static_cast<long>(counted_),
                                         text_.begin() + static_cast<long>(at_), '\n'));
    counted_ = at_;
    return line_;
  }

  Key key() {
    Key key;
    for (;;) {
      skip_spaces();
      const auto begin = at_;
      if (here() == '"' || here() == '\'') {
        string();
        const auto written = text_.substr(begin, at_ - begin);
        key.names.push_back(text::parse_toml("k = " + written, "").entries.front().value.string);
      } else {
        while (at_ < text_.size() && std::string_view(" \t.=]").find(here()) == std::string_view::npos) ++at_;
        key.names.push_back(text_.substr(begin, at_ - begin));
      }
      key.spans.push_back({begin, at_});
      skip_spaces();
      if (here() != '.') return key;
      ++at_;
    }
  }

  void string() {
    const char quote = here();
    const bool three = here(1) == quote && here(2) == quote;
    at_ += three ? 3 : 1;
    for (;;) {
      if (at_ >= text_.size()) throw std::logic_error("a string without an end in TOML that was accepted");
      if (quote == '"' && here() == '\\') {
        at_ += 2;
      } else if (here() != quote) {
        ++at_;
      } else if (!three) {
        ++at_;
        return;
      } else if (here(1) == quote && here(2) == quote) {
        at_ += 3;
        // One or two quotes directly before the closing three quotes still belong to the string.
        while (here() == quote) ++at_;
        return;
      } else {
        ++at_;
      }
    }
  }

  void value(Part& part) {
    part.value.begin = at_;
    if (here() == '"' || here() == '\'') {
      string();
    } else if (here() == '[') {
      part.kind = Part::Kind::array;
      items(part, ']');
    } else if (here() == '{') {
      part.kind = Part::Kind::inline_table;
      items(part, '}');
    } else {
      while (at_ < text_.size() && std::string_view(",]}#\r\n").find(here()) == std::string_view::npos) ++at_;
      while (text_[at_ - 1] == ' ' || text_[at_ - 1] == '\t') --at_;
    }
    part.value.end = at_;
  }

  void items(Part& part, char close) {
    ++at_;
    for (skip_blank_lines(); here() != close; skip_blank_lines()) {
      if (here() == ',') {
        ++at_;
        continue;
      }
      if (close == '}') {
        entry(part, false);
        continue;
      }
      auto& item = part.parts.emplace_back();
      item.name = std::to_string(part.parts.size() - 1);
      item.line = line();
      value(item);
      item.key = item.value;
    }
    ++at_;
  }

  void entry(Part& table, bool whole_line) {
    const int at_line = line();
    const auto names = key();
    ++at_;  // skip the equals sign
    skip_spaces();
    auto* parent = &table;
    std::string prefix;
    for (std::size_t i = 0; i + 1 < names.names.size(); ++i) {
      prefix +=
          (i == 0 ? "" : ".") + text_.substr(names.spans[i].begin, names.spans[i].end - names.spans[i].begin);
      parent = &dotted(*parent, names.names[i], at_line);
      parent->prefix = prefix;
      if (parent->key.end == 0) parent->key = {names.spans.front().begin, names.spans[i].end};
    }
    auto& part = parent->parts.emplace_back();
    part.name = names.names.back(), part.line = at_line;
    part.key = {names.spans.front().begin, names.spans.back().end};
    value(part);
    // A table that consists of dotted keys extends to the end of the last of these keys.
    auto* above = &table;
    for (std::size_t i = 0; i + 1 < names.names.size(); ++i) {
      above = above->find(names.names[i]);
      above->value = {above->key.begin, part.value.end};
    }
    if (whole_line) table.value.end = line_end(text_, part.value.end);
  }

  Part& dotted(Part& parent, const std::string& name, int at_line) {
    if (auto* found = parent.find(name)) return *found;
    auto& made = parent.parts.emplace_back();
    made.kind = Part::Kind::dotted, made.name = name, made.line = at_line;
    return made;
  }

  void header() {
    const auto begin = at_;
    const int at_line = line();
    const bool of_list = here(1) == '[';
    at_ += of_list ? 2 : 1;
    const auto names = key();
    at_ += of_list ? 2 : 1;
    auto* parent = &root_;
    for (std::size_t i = 0; i + 1 < names.names.size(); ++i) {
      parent = &dotted(*parent, names.names[i], at_line);
      if (parent->kind == Part::Kind::table_array) parent = &parent->parts.back();
    }
    auto* part = parent->find(names.names.back());
    if (part == nullptr) {
      part = &parent->parts.emplace_back();
      part->name = names.names.back(), part->line = at_line;
    }
    if (of_list) {
      part->kind = Part::Kind::table_array;
      const auto count = part->parts.size();
      part = &part->parts.emplace_back();
      part->name = std::to_string(count);
    }
    part->kind = Part::Kind::table;
    part->line = at_line, part->key = {begin, at_}, part->header_names = names.spans;
    part->value = {begin, line_end(text_, at_)};
    table_ = part;
  }

  const std::string& text_;
  std::size_t at_ = 0, counted_ = 0;
  int line_ = 1;
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

Part parts_of(const std::string& text) { return Reader(text).read(); }

std::size_t line_end(std::string_view text, std::size_t at) {
  const auto end = std::min(text.find('\n', at), text.size());
  return end > at && text[end - 1] == '\r' ? end - 1 : end;
}

}  // namespace turnpoint::design

#include "station/design/completion.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <utility>

#include "station/design/form.hpp"

namespace turnpoint::design {

namespace {

/// A table, an inline table or an array that has begun and not ended.
struct Frame {
  char opened = 't';  ///< t: a table with a header, or the file itself
  Path path;          ///< of the table or array
  std::string key;    ///< the key whose value comes next; "" while a key is written
  std::vector<std::string> keys = {};
};

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

std::string unquoted(std::string_view name) {
  name = trimmed(name);
  if (name.size() >= 2 && (name.front() == '"' || name.front() == '\''))
    name = name.substr(1, name.size() - 2);
  return std::string(name);
}

Path dotted(std::string_view names) {
  Path path;
  while (true) {
    const auto dot = names.find('.');
    path.push_back(unquoted(names.substr(0, dot)));
    if (dot == std::string_view::npos) return path;
    names.remove_prefix(dot + 1);
  }
}

/// Reads a text up to the cursor, and remembers where it is. Understands unfinished TOML.
class CursorReader {
 public:
  CursorReader(std::string_view text, std::size_t at) : text_(text), end_(std::min(at, text.size())) {
    frames_.push_back({});
    while (at_ < end_) step();
  }

  /// What is being written at the cursor.
  enum class Writing { nothing, header, list_header, key, value, string };
  Writing writing() const {
    if (inside_string_) return in_value() ? Writing::string : Writing::nothing;
    if (nothing_ || over_) return Writing::nothing;
    if (header_) return *header_ ? Writing::list_header : Writing::header;
    return in_value() ? Writing::value : Writing::key;
  }
  std::size_t from() const {
    auto from = word_;
    while (from < end_ && (is_space(text_[from]) || text_[from] == '\n')) ++from;
    return from;
  }
  const Frame& now() const { return frames_.back(); }
  const std::map<std::string, std::vector<std::string>>& names() const { return names_; }
  const std::vector<std::string>& languages() const { return languages_; }

 private:
  bool in_value() const { return now().opened == '[' || !now().key.empty(); }
  std::string_view word() const { return trimmed(text_.substr(word_, at_ - word_)); }

  void step() {
    const char c = text_[at_];
    if (c == '#') return skip_comment();
    if (c == '"' || c == '\'') return skip_string(c);
    if (header_ && c == ']') return end_header();
    if (c == '\n' && (now().opened != '[' || header_follows())) return new_line();
    if (!header_ && c == '=' && !in_value()) {
      frames_.back().keys.push_back(unquoted(word()));
      frames_.back().key = frames_.back().keys.back();
      return next_word();
    }
    if (c == '[' && now().opened == 't' && now().key.empty() && word().empty()) return begin_header();
    if ((c == '{' || c == '[') && in_value()) {
      auto path = now().path;
      if (!now().key.empty()) path.push_back(now().key);
      frames_.push_back({c, path, "", {}});
      return next_word();
    }
    if ((c == '}' || c == ']') && now().opened != 't') {
      frames_.pop_back();
      next_word();
      over_ = true;
      return;
    }
    if (c == ',' && now().opened != 't') {
      if (now().opened == '{') frames_.back().key.clear();
      return next_word();
    }
    ++at_;
  }

  void next_word() {
    word_ = ++at_;
    over_ = false;
  }

  void skip_comment() {
    while (at_ < end_ && text_[at_] != '\n') ++at_;
    nothing_ = at_ >= end_;
  }

  void skip_string(char quote) {
    const std::string three(3, quote);
    const bool lines = text_.substr(at_, 3) == three;
    const auto begin = at_ + (lines ? 3 : 1);
    auto end = begin;
    while (end < text_.size() && (lines ? text_.substr(end, 3) != three : text_[end] != quote)) {
      if (!lines && text_[end] == '\n') break;
      end += quote == '"' && text_[end] == '\\' ? 2 : 1;
    }
    inside_string_ = end >= end_;
    if (inside_string_) {
      word_ = begin;
      at_ = end_;
      return;
    }
    if (in_value()) keep_name(std::string(text_.substr(begin, end - begin)));
    at_ = text_[end] == quote ? end + (lines ? 3 : 1) : end;
  }

  /// Remembers what other keys can refer to: the names of blocks and factors, and the languages.
  void keep_name(std::string value) {
    const auto& path = now().path;
    if (now().opened == 't' && now().key == "name" && path.size() == 1)
      names_[path.front()].push_back(std::move(value));
    else if (path == Path{"protocol", "languages"})
      languages_.push_back(std::move(value));
  }

  void begin_header() {
    const bool list = text_.substr(at_, 2) == "[[";
    header_ = list;
    at_ += list ? 1 : 0;
    next_word();
  }

  void end_header() {
    auto path = dotted(word());
    if (path.size() == 2) names_[path[0]].push_back(path[1]);
    frames_ = {{'t', std::move(path), "", {}}};
    header_.reset();
    next_word();
    over_ = true;
  }

  /// True if the next line can only be the header of a table, so that an array before it was not finished.
  bool header_follows() const {
    static const std::regex header(R"(\s*\[\[?[A-Za-z_][\w.-]*\]\]?\s*(#.*)?)");
    const auto end = text_.find('\n', at_ + 1);
    const std::string line(text_.substr(at_ + 1, end == std::string_view::npos ? end : end - at_ - 1));
    return std::regex_match(line, header);
  }

  /// An inline table ends with its line, also if its bracket is missing.
  void new_line() {
    while (now().opened == '{' || (now().opened == '[' && header_follows())) frames_.pop_back();
    if (now().opened == 't') frames_.back().key.clear();
    header_.reset();
    next_word();
  }

  std::string_view text_;
  std::size_t end_, at_ = 0, word_ = 0;
  std::vector<Frame> frames_;
  std::optional<bool> header_;  ///< in a header: whether it is one of a list, [[...]]
  bool inside_string_ = false, nothing_ = false;
  bool over_ = false;  ///< after a closing bracket, where only a comma or a new line can follow
  std::map<std::string, std::vector<std::string>> names_;
  std::vector<std::string> languages_;
};

/// The keys of the table after the cursor, up to the next header.
void add_later_keys(std::string_view text, std::size_t at, std::set<std::string>& keys) {
  auto line = text.find('\n', at);
  while (line != std::string_view::npos) {
    const auto end = text.find('\n', line + 1);
    const auto now = trimmed(text.substr(line + 1, end == std::string_view::npos ? end : end - line - 1));
    if (now.starts_with('[')) return;
    if (const auto equals = now.find('='); equals != std::string_view::npos)
      keys.insert(unquoted(now.substr(0, equals)));
    line = end;
  }
}

/// All forms that the schema allows at this path.
std::vector<Rule> forms_at(const Schema& schema, const Path& path) {
  std::vector<Rule> forms{schema.root()};
  for (const auto& name : path) {
    std::vector<Rule> below;
    for (const auto& form : forms)
      for (const auto& key : form.keys)
        if (key.name == name || key.name.empty())
          for (auto& next : schema.forms(*key.schema)) below.push_back(std::move(next));
    forms = std::move(below);
  }
  return forms;
}

class Suggester {
 public:
  Suggester(const Schema& schema, std::string_view text, std::size_t at)
      : schema_(schema),
        text_(text),
        at_(std::min(at, text.size())),
        reader_(text, at_),
        whole_(text, text.size()) {}

  Completion make() {
    using Writing = CursorReader::Writing;
    const auto writing = reader_.writing();
    if (writing == Writing::nothing) return {};
    made_.from = reader_.from();
    if (writing == Writing::header || writing == Writing::list_header)
      tables(writing == Writing::list_header);
    else if (writing == Writing::key)
      keys();
    else
      values(writing == Writing::string);
    return std::move(made_);
  }

 private:
  void add(const std::string& word, const std::string& insert, const std::string& help) {
    const auto begun = text_.substr(made_.from, at_ - made_.from);
    const bool fits = insert.starts_with(begun) || word.starts_with(begun);
    const auto same = [&](const Suggestion& one) { return one.word == word; };
    if (fits && insert != begun && std::none_of(made_.suggestions.begin(), made_.suggestions.end(), same))
      made_.suggestions.push_back({word, insert, help});
  }

  void tables(bool list) {
    for (const auto& key : schema_.root().keys) {
      const auto rule = schema_.rule(*key.schema);
      if (rule.kind != (list ? Rule::Kind::tables : Rule::Kind::table)) continue;
      add(key.name, key.name + (rule.any_key ? "." : list ? "]]" : "]"), rule.help);
    }
  }

  void keys() {
    const auto& now = reader_.now();
    std::set<std::string> there(now.keys.begin(), now.keys.end());
    if (now.opened == 't') add_later_keys(text_, at_, there);
    for (const auto& form : forms_at(schema_, now.path))
      for (const auto& key : form.keys) {
        const auto rule = schema_.rule(*key.schema);
        // at the beginning of the file there are only keys; its tables have headers
        if (now.path.empty() && (rule.kind == Rule::Kind::table || rule.kind == Rule::Kind::tables)) continue;
        if (key.name.empty()) {
          for (const auto& language : whole_.languages())
            if (!there.contains(language)) add(language, language + " = ", "");
        } else if (!there.contains(key.name)) {
          add(key.name, key.name + " = ", rule.help);
        }
      }
  }

  void values(bool inside_string) {
    const auto& now = reader_.now();
    auto path = now.path;
    if (!now.key.empty()) path.push_back(now.key);
    const bool closed = at_ < text_.size() && text_[at_] == '"';
    const auto word = [&](const std::string& name, const std::string& help) {
      add(name, inside_string ? name + (closed ? "" : "\"") : toml_string(name), help);
    };
    const auto referred = path.empty() ? std::string() : referred_table(path.back());
    const auto names = whole_.names().find(referred);
    for (const auto& form : forms_at(schema_, path)) {
      for (const auto& name : form.allowed) word(name, form.help);
      if (form.kind == Rule::Kind::boolean && !inside_string)
        for (const char* value : {"true", "false"}) add(value, value, form.help);
      const bool names_one = form.kind == Rule::Kind::text || form.kind == Rule::Kind::names;
      if (names_one && form.allowed.empty() && names != whole_.names().end())
        for (const auto& name : names->second) word(name, form.help);
    }
  }

  const Schema& schema_;
  std::string_view text_;
  std::size_t at_;
  CursorReader reader_;
  CursorReader whole_;  ///< names can be defined after the cursor
  Completion made_;
};

}  // namespace

Completion complete(const Schema& schema, std::string_view text, std::size_t at) {
  return Suggester(schema, text, at).make();
}

}  // namespace turnpoint::design

#include "station/view/document.hpp"

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <utility>

namespace turnpoint::view {

namespace {

std::string joined(const Path& path) {
  std::string all;
  for (const auto& name : path) all += (all.empty() ? "" : ".") + name;
  return all;
}

[[noreturn]] void no_such(const Path& path) { throw std::logic_error("the text has no key " + joined(path)); }

[[noreturn]] void no_place(const Path& path) {
  throw std::logic_error("the key " + joined(path) + " can only be added in the text of the file");
}

/// Collects this part and the parts below it, as far as they are tables with headers, in the order of the
/// file.
void collect_tables(const Part& part, std::vector<const Part*>& tables) {
  if (part.kind == Part::Kind::table) tables.push_back(&part);
  for (const auto& below : part.parts)
    if (below.kind != Part::Kind::scalar) collect_tables(below, tables);
}

std::vector<const Part*> tables_of(const Part& part) {
  std::vector<const Part*> tables;
  collect_tables(part, tables);
  std::sort(tables.begin(), tables.end(),
            [](const Part* a, const Part* b) { return a->value.begin < b->value.begin; });
  return tables;
}

/// Collects the lines of all keys below a table that consists of dotted keys.
void collect_entries(const Part& part, std::vector<Span>& lines) {
  if (part.kind != Part::Kind::dotted) return lines.push_back({part.key.begin, part.value.end});
  for (const auto& below : part.parts) collect_entries(below, lines);
}

/// Finds the innermost part below this one whose text contains the offset `at`, and appends the names on the
/// way to it to `way`. Returns false if there is none.
bool way_to(const Part& part, std::size_t at, Path& way) {
  const Part* own = nullptr;
  for (const auto& below : part.parts) {
    way.push_back(below.name);
    if (way_to(below, at, way)) return true;
    way.pop_back();
    const bool spans = below.kind != Part::Kind::table_array && below.kind != Part::Kind::dotted;
    if (spans && below.key.begin <= at && at < below.value.end) own = &below;
  }
  if (own != nullptr) way.push_back(own->name);
  return own != nullptr;
}

}  // namespace

std::string toml_string(const std::string& text) {
  std::string all = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      all += std::string("\\") + c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04X", static_cast<unsigned>(c));
      all += c == '\n' ? "\\n" : c == '\t' ? "\\t" : code;
    } else {
      all += c;
    }
  }
  return all + "\"";
}

std::string key_of(const std::string& name) {
  const bool bare = !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  return bare ? name : toml_string(name);
}

namespace {

/// Collects all single values below a part that do not belong to the key at `path`, as text of path and
/// value.
void collect_others(const Part& part, const std::string& text, const Path& path, Path& way,
                    std::vector<std::string>& others) {
  if (!path.empty() && way == path) return;
  if (part.kind == Part::Kind::scalar) {
    std::string all;
    for (const auto& name : way) all += name + '\n';
    others.push_back(all + text.substr(part.value.begin, part.value.end - part.value.begin));
  }
  for (const auto& below : part.parts) {
    way.push_back(below.name);
    collect_others(below, text, path, way, others);
    way.pop_back();
  }
}

}  // namespace

Document::Document(std::string text, std::string file) : text_(std::move(text)), file_(std::move(file)) {
  root_ = core::parts_of(text_, file_);
  const auto first = text_.find('\n');
  if (first != std::string::npos && first > 0 && text_[first - 1] == '\r') line_break_ = "\r\n";
}

const Part* Document::find(const Path& path) const {
  const auto* part = &root_;
  for (const auto& name : path)
    if (part = part->find(name); part == nullptr) return nullptr;
  return part;
}

std::string Document::written(const Path& path) const {
  const auto* part = find(path);
  return part == nullptr ? "" : text_.substr(part->value.begin, part->value.end - part->value.begin);
}

Path Document::at(int line, int column) const {
  std::size_t at = text_.starts_with("\xEF\xBB\xBF") ? 3 : 0;
  for (int i = 1; i < line && at < text_.size(); ++i)
    at = std::min(text_.find('\n', at), text_.size() - 1) + 1;
  if (column <= 0) at = std::min(text_.find_first_not_of(" \t", at), text_.size());
  for (int i = 1; i < column && at < text_.size(); ++i) do
      ++at;
    while (at < text_.size() && (static_cast<unsigned char>(text_[at]) & 0xC0) == 0x80);
  Path path;
  way_to(root_, at, path);
  return path;
}

std::string Document::checked(std::string text) const {
  core::parse_toml(text, file_);
  return text;
}

/// The text after the key at `path` got a value. Where a text is written decides what it means, so it is read
/// again: the key must be at its path, and every other value must be as it was.
std::string Document::checked(std::string text, const Path& path) const {
  const Document now(std::move(text), file_);
  const auto others = [&path](const Document& document) {
    std::vector<std::string> all;
    Path way;
    collect_others(document.root(), document.text(), path, way, all);
    std::sort(all.begin(), all.end());
    return all;
  };
  if (now.find(path) == nullptr || others(now) != others(*this)) no_place(path);
  return now.text();
}

std::string Document::with(const Path& path, const std::string& value) const {
  // The text must be exactly one value. A line break in it could begin another key.
  if (path.empty() || core::parse_toml("v = " + value, file_).entries.size() != 1) no_such(path);
  const auto* part = find(path);
  if (part == nullptr) return checked(inserted(path, value), path);
  if (part->kind == Part::Kind::table || part->kind == Part::Kind::dotted ||
      part->kind == Part::Kind::table_array)
    throw std::logic_error("a table with a header cannot become a value");
  auto text = text_;
  return checked(text.replace(part->value.begin, part->value.end - part->value.begin, value), path);
}

std::string Document::new_line_at(std::size_t at, const std::string& line) const {
  auto text = text_;
  const bool at_start = at == 0 || (at == 3 && text.starts_with("\xEF\xBB\xBF"));
  return text.insert(at, at_start ? line + line_break_ : line_break_ + line);
}

std::string Document::inside_braces(const Part& table, const std::string& entry) const {
  auto text = text_;
  if (table.parts.empty())
    return text.replace(table.value.begin, table.value.end - table.value.begin, "{ " + entry + " }");
  std::size_t end = 0;
  for (const auto& part : table.parts) end = std::max(end, part.value.end);
  return text.insert(end, ", " + entry);
}

Document::Item Document::item_at(const Span& value) const {
  const auto begins = [this](std::size_t at) { return at == 0 ? 0 : text_.rfind('\n', at - 1) + 1; };
  const auto after_blanks = [this](std::size_t at) {
    return std::min(text_.find_first_not_of(" \t", at), text_.size());
  };
  Item item;
  item.value = value;
  item.line.begin = begins(value.begin);
  auto at = after_blanks(value.end);
  item.comma = at < text_.size() && text_[at] == ',';
  item.comment.begin = item.comma ? at + 1 : value.end;
  at = after_blanks(item.comment.begin);
  if (at < text_.size() && text_[at] == '#') at = core::line_end(text_, at);
  item.comment.end = item.line.end = at;
  item.alone = after_blanks(item.line.begin) == value.begin && at == core::line_end(text_, at);
  item.above = {item.line.begin, item.line.begin};
  while (item.above.begin > 0) {
    const auto line = begins(item.above.begin - 1);
    if (text_[after_blanks(line)] != '#') break;
    item.above.begin = line;
  }
  return item;
}

std::string Document::inserted(const Path& path, const std::string& value) const {
  std::size_t known = 0;
  const auto* table = &root_;
  const Part* header = &root_;  // the innermost table with a header on the way to the key
  std::size_t below_header = 0;
  const Part* braces = nullptr;  // the innermost inline table on the way to the key
  std::size_t below_braces = 0;
  while (known < path.size()) {
    const auto* next = table->find(path[known]);
    if (next == nullptr) break;
    table = next;
    ++known;
    if (table->kind == Part::Kind::table) header = table, below_header = known, braces = nullptr;
    if (table->kind == Part::Kind::inline_table) braces = table, below_braces = known;
    if (table->kind == Part::Kind::array) braces = nullptr;
  }
  const auto names = [&path](std::size_t from) {
    std::string all;
    for (auto i = from; i < path.size(); ++i) all += (i == from ? "" : ".") + key_of(path[i]);
    return all;
  };
  if (braces != nullptr && table->is_table())
    return inside_braces(*braces, names(below_braces) + " = " + value);
  if (table->kind == Part::Kind::array) {
    auto text = text_;
    if (known + 1 != path.size() || path[known] != std::to_string(table->parts.size())) no_such(path);
    if (table->parts.empty())
      return text.replace(table->value.begin, table->value.end - table->value.begin, "[" + value + "]");
    const auto last = item_at(table->parts.back().value);
    if (!last.alone) return text.insert(last.value.end, ", " + value);
    const auto indentation = text.substr(last.line.begin, last.value.begin - last.line.begin);
    text.insert(last.line.end, line_break_ + indentation + value);
    return last.comma ? text : text.insert(last.value.end, ",");
  }
  if (!table->is_table()) no_such(path);
  const bool by_headers = table->kind == Part::Kind::dotted && table->prefix.empty();
  // A new table gets a header. It is added after the other tables of its list or, if there are none, at the
  // end of the file.
  if ((table == &root_ && path.size() > 1) || by_headers) {
    // A header has no indices: it belongs to the item of a list that is the last one before it.
    std::string title;
    const auto* above = &root_;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      const bool item = above != nullptr && above->kind == Part::Kind::table_array;
      if (!item) title += (title.empty() ? "" : ".") + key_of(path[i]);
      above = above == nullptr ? nullptr : above->find(path[i]);
    }
    const auto tables = tables_of(*table);
    const auto at = by_headers && !tables.empty() ? tables.back()->value.end : text_.size();
    const bool after_break = at == text_.size() && text_.ends_with('\n');
    auto text = text_;
    return text.insert(at, (after_break ? line_break_ : line_break_ + line_break_) + "[" + title + "]" +
                               line_break_ + key_of(path.back()) + " = " + value +
                               (after_break ? line_break_ : ""));
  }
  auto at = header->value.end;
  if (table->kind == Part::Kind::dotted) {
    std::vector<Span> lines;
    collect_entries(*table, lines);
    at = core::line_end(text_, lines.back().end);
  }
  return new_line_at(at, names(below_header) + " = " + value);
}

std::string Document::without(const Path& path) const {
  const auto* part = find(path);
  if (part == nullptr || path.empty()) no_such(path);
  const auto* parent = find({path.begin(), path.end() - 1});
  auto text = text_;
  if (parent->kind == Part::Kind::array || parent->kind == Part::Kind::inline_table) {
    // An item that has lines for itself goes with the comment behind it.
    if (const auto item = item_at(part->value); parent->kind == Part::Kind::array && item.alone)
      return checked(text.erase(item.line.begin, text.find('\n', item.line.end) + 1 - item.line.begin));
    // Remove the item with the comma after it or, for the last item, with the comma before it.
    std::vector<Span> items;
    for (const auto& item : parent->parts) items.push_back({item.key.begin, item.value.end});
    const auto index = static_cast<std::size_t>(std::distance(
        parent->parts.begin(),
        std::find_if(parent->parts.begin(), parent->parts.end(), [&](const Part& p) { return &p == part; })));
    const bool last = index + 1 == items.size();
    const auto begin = last && index > 0 ? items[index - 1].end : items[index].begin;
    const auto end = !last ? items[index + 1].begin : index > 0 ? items[index].end : parent->value.end - 1;
    return checked(text.erase(begin, end - begin));
  }
  std::vector<Span> pieces;
  for (const auto* table : tables_of(*part)) pieces.push_back(table->value);
  if (part->kind != Part::Kind::table && pieces.empty()) collect_entries(*part, pieces);
  for (auto piece = pieces.rbegin(); piece != pieces.rend(); ++piece) {
    const auto before = text.rfind('\n', piece->begin == 0 ? std::string::npos : piece->begin - 1);
    const auto begin = piece->begin == 0 || before == std::string::npos
                           ? (text.starts_with("\xEF\xBB\xBF") ? 3 : 0)
                           : before + 1;
    auto end = std::min(text.find('\n', piece->end), text.size() - 1) + 1;
    // After a table was removed, keep only one of the empty lines that were before and after it.
    const auto empty_before = begin == 0 || text.substr(0, begin).ends_with("\n" + line_break_);
    if (part->is_table() && empty_before && text.compare(end, line_break_.size(), line_break_) == 0)
      end += line_break_.size();
    text.erase(begin, end - begin);
  }
  return checked(text);
}

std::string Document::with_copy(const Path& path, const std::string& name) const {
  const auto* part = find(path);
  if (part == nullptr || part->kind != Part::Kind::table) no_such(path);
  const auto* parent = find({path.begin(), path.end() - 1});
  const bool of_list = parent->kind == Part::Kind::table_array;
  const auto depth = part->header_names.size() - 1;
  const auto tables = tables_of(*part);
  std::string copy;
  for (const auto* table : tables) {
    auto own = text_.substr(table->value.begin, table->value.end - table->value.begin);
    const auto* named = table == part ? part->find("name") : nullptr;
    const auto replace = [&](const Span& span, const std::string& by) {
      own.replace(span.begin - table->value.begin, span.end - span.begin, by);
    };
    if (!of_list) replace(table->header_names[depth], key_of(name));
    if (of_list && named != nullptr) replace(named->value, toml_string(name));
    copy += line_break_ + line_break_ + own;
  }
  auto text = text_;
  return checked(text.insert(tables.back()->value.end, copy));
}

std::string Document::with_name(const Path& path, const std::string& name) const {
  const auto* part = find(path);
  if (part == nullptr || part->kind != Part::Kind::table) no_such(path);
  const auto depth = part->header_names.size() - 1;
  auto text = text_;
  const auto tables = tables_of(*part);
  for (auto table = tables.rbegin(); table != tables.rend(); ++table) {
    const auto& old = (*table)->header_names[depth];
    text.replace(old.begin, old.end - old.begin, key_of(name));
  }
  return checked(text);
}

/// The text of a table with the tables below it, with the comments in the lines directly above it, and with
/// those directly below its last key that an empty line ends.
Span Document::with_comments(const Path& path) const {
  const auto* part = find(path);
  if (part == nullptr || part->kind != Part::Kind::table) no_such(path);
  const auto tables = tables_of(*part);
  const auto begin = item_at(tables.front()->value).above.begin;
  auto end = tables.back()->value.end;
  for (auto last = core::line_end(text_, end);;) {
    const auto line = text_.find_first_not_of(" \t\r", last);  // the line break, then what follows it
    const auto next = line == std::string::npos ? line : text_.find_first_not_of(" \t", line + 1);
    if (next == std::string::npos || text_[next] == '\n' || text_[next] == '\r') return {begin, last};
    if (text_[next] != '#') return {begin, end};
    last = core::line_end(text_, next);
  }
}

std::string Document::exchanged(const Path& first, const Path& second) const {
  // The pieces of the text that change places, in their order.
  const auto pieces_of = [this](const Path& path) -> std::vector<Span> {
    const auto* part = find(path);
    if (part == nullptr || part->kind == Part::Kind::table) return {with_comments(path)};
    const auto item = item_at(part->value);
    return item.alone ? std::vector{item.above, item.value, item.comment} : std::vector{item.value};
  };
  auto a = pieces_of(first), b = pieces_of(second);
  if (b.front().begin < a.front().begin) std::swap(a, b);
  if (a.size() != b.size() || a.back().end > b.front().begin) no_such(second);
  auto text = text_;
  const auto replace_all = [&](const std::vector<Span>& spans, const std::vector<Span>& by) {
    for (auto i = spans.size(); i-- > 0;)
      text.replace(spans[i].begin, spans[i].end - spans[i].begin, text_, by[i].begin,
                   by[i].end - by[i].begin);
  };
  replace_all(b, a);
  replace_all(a, b);
  return checked(text);
}

std::string Document::with_tables(const std::string& tables) const {
  std::string own;
  for (const char c : tables) own += c == '\n' ? line_break_ : std::string(1, c);
  const auto gap = text_.empty() || text_.ends_with("\n") ? line_break_ : line_break_ + line_break_;
  return checked(text_ + gap + own);
}

}  // namespace turnpoint::view

#include "station/view/form.hpp"

#include <algorithm>
#include <map>

namespace turnpoint::view {

namespace {

using RuleKind = Rule::Kind;

constexpr const char* section_names[] = {"study",  "question", "scenes", "levels",
                                         "blocks", "timing",   "other"};

std::string section_of(const std::string& table) {
  static const std::map<std::string, std::string> sections{
      {"protocol", "study"},  {"random", "study"},  {"task", "question"},    {"instructions", "question"},
      {"scene", "scenes"},    {"factor", "levels"}, {"procedure", "levels"}, {"block", "blocks"},
      {"sequence", "blocks"}, {"timing", "timing"},
      // the parts of a session, in the order in which they come
      {"consent", "blocks"},  {"explanation", "blocks"}, {"questionnaire", "blocks"}, {"screening", "blocks"}};
  const auto found = sections.find(table);
  return found == sections.end() ? "other" : found->second;
}

std::string name_in(const Part& table) {
  const auto* name = table.find("name");
  if (name == nullptr || name->kind != Part::Kind::scalar) return "";
  return name->scalar.string;
}

std::vector<std::string> names_of(const Document& document, const std::string& table) {
  std::vector<std::string> names;
  const auto* part = document.find({table});
  if (part == nullptr) return names;
  for (const auto& below : part->parts)
    names.push_back(part->kind == Part::Kind::table_array ? name_in(below) : below.name);
  return names;
}

std::vector<std::string> languages_of(const Document& document) {
  std::vector<std::string> languages;
  if (const auto* part = document.find({"protocol", "languages"}); part != nullptr)
    for (const auto& item : core::value_of(*part).items) languages.push_back(item.string);
  return languages;
}

/// Returns a value as a person writes it: without quotes and brackets.
std::string shown(const Document& document, const Part& part) {
  if (part.kind == Part::Kind::array) {
    std::string all;
    for (const auto& item : part.parts) all += (all.empty() ? "" : ", ") + shown(document, item);
    return all;
  }
  const auto written = document.text().substr(part.value.begin, part.value.end - part.value.begin);
  const bool text = written.starts_with('"') || written.starts_with('\'');
  return text ? part.scalar.string : written;
}

bool is_flat(const Part& part) {
  return std::all_of(part.parts.begin(), part.parts.end(),
                     [](const Part& item) { return item.kind == Part::Kind::scalar; });
}

bool is_interlude(const std::string& table) {
  return std::any_of(std::begin(kAddedTables), std::end(kAddedTables),
                     [&](const char* kind) { return table == kind; });
}

class Maker {
 public:
  Maker(const Document& document, const Schema& schema) : document_(document), schema_(schema) {}

  std::vector<Section> make() {
    std::vector<Section> sections;
    for (const auto* name : section_names) sections.push_back({name, {}, 0});
    for (const auto& key : schema_.root().keys) {
      const auto rule = schema_.rule(*key.schema);
      if (rule.kind != RuleKind::table && rule.kind != RuleKind::tables) continue;
      const auto section = section_of(key.name);
      auto& groups = std::find_if(sections.begin(), sections.end(), [&](const auto& s) {
                       return s.name == section;
                     })->groups;
      if (rule.kind == RuleKind::table && !rule.any_key)
        groups.push_back(group({key.name}, rule, document_.find({key.name})));
      else
        add_tables(key.name, rule, groups);
    }
    for (auto& section : sections)
      if (section.name == "blocks") put_in_order(section.groups);
    return sections;
  }

 private:
  /// The parts of a session in the order of the file, which is that of the session.
  void put_in_order(std::vector<Group>& groups) const {
    const auto begin = [this](const Group& group) {
      const auto* part = document_.find(group.path);
      return part == nullptr ? std::string::npos : part->value.begin;
    };
    std::stable_sort(groups.begin(), groups.end(),
                     [&](const Group& a, const Group& b) { return begin(a) < begin(b); });
    for (std::size_t i = 1; i < groups.size(); ++i)
      if (groups[i - 1].copied && groups[i].copied)
        groups[i].earlier = groups[i - 1].path, groups[i - 1].later = groups[i].path;
  }

  /// Adds a group for each table [[block]], or [scene.NAME], that the file has.
  void add_tables(const std::string& name, const Rule& rule, std::vector<Group>& groups) {
    const auto* list = document_.find({name});
    if (list == nullptr) return;
    const bool of_list = rule.kind == RuleKind::tables;
    for (const auto& table : list->parts) {
      if (!table.is_table()) continue;
      auto made = group({name, table.name}, of_list ? rule : schema_.rule(*rule.keys.back().schema), &table);
      made.name = of_list ? name_in(table) : table.name;
      made.copied = table.kind == Part::Kind::table;
      // a protocol needs a block, a scene, a factor, ..., but no interlude
      made.removable = made.copied && (list->parts.size() > 1 || is_interlude(name));
      for (const char* below : {"page", "item"})
        if (const auto* tables = table.find(below); tables != nullptr && tables->kind == Part::Kind::table_array)
          made.below = below, made.below_count = tables->parts.size();
      groups.push_back(std::move(made));
    }
  }

  Group group(const Path& path, const Rule& rule, const Part* part) {
    Group group{path, "", part != nullptr};
    group.removable = part != nullptr && part->kind == Part::Kind::table && path.size() == 1 &&
                      section_of(path[0]) == "other";
    add_fields(path, rule, part, group.fields, 0, part != nullptr);
    return group;
  }

  void add_fields(const Path& path, const Rule& rule, const Part* part, std::vector<Field>& fields,
                  int absent, bool needed = true) {
    for (const auto& key : rule.keys) {
      if (rule.any_key) break;
      auto below = path;
      below.push_back(key.name);
      add_field(below, key, part == nullptr ? nullptr : part->find(key.name), fields, absent, needed);
    }
    if (!rule.any_key || part == nullptr) return;
    for (const auto& named : part->parts) {
      const auto known = std::find_if(rule.keys.begin(), rule.keys.end(),
                                      [&](const auto& key) { return key.name == named.name; });
      auto below = path;
      below.push_back(named.name);
      add_field(below, known == rule.keys.end() ? rule.keys.back() : *known, &named, fields, absent);
    }
  }

  void add_field(const Path& path, const Rule::Key& key, const Part* part, std::vector<Field>& fields,
                 int absent, bool needed = true) {
    const auto value = part == nullptr ? std::nullopt : value_of(*part);
    const auto rule = schema_.rule(*key.schema, value ? &*value : nullptr);
    if (rule.kind == RuleKind::texts) {
      for (const auto& language : languages_of(document_)) {
        auto below = path;
        below.push_back(language);
        Rule text;
        text.kind = RuleKind::text, text.help = rule.help;
        fields.push_back(field(below, text, part == nullptr ? nullptr : part->find(language),
                               needed && (part != nullptr || key.required)));
      }
    } else if (rule.kind == RuleKind::table) {
      // If the file does not have this table, offer its keys, but not the tables below it.
      if (part != nullptr || absent == 0)
        add_fields(path, rule, part, fields, part == nullptr ? absent + 1 : absent, needed && key.required);
    } else if (rule.kind == RuleKind::tables) {
      if (part == nullptr) return;
      for (const auto& item : part->parts) {
        auto below = path;
        below.push_back(item.name);
        add_fields(below, rule, &item, fields, absent);
      }
    } else {
      fields.push_back(field(path, rule, part, needed && key.required));
    }
  }

  Field field(const Path& path, const Rule& rule, const Part* part, bool required) {
    Field field{path,         rule.kind, part != nullptr, required,  "",
                rule.allowed, rule.low,  rule.high,       rule.help, {}};
    if (part != nullptr && (part->is_table() || part->kind == Part::Kind::table_array || !is_flat(*part)))
      field.kind = RuleKind::other;
    if (part != nullptr)
      field.value = field.kind == RuleKind::other ? document_.written(path) : shown(document_, *part);
    if (const auto table = referred_table(path.back()); !table.empty() && rule.allowed.empty())
      field.allowed = names_of(document_, table);
    return field;
  }

  std::optional<core::Value> value_of(const Part& part) const {
    if (part.kind == Part::Kind::scalar || part.kind == Part::Kind::array ||
        part.kind == Part::Kind::inline_table)
      return core::value_of(part);
    core::Value value;
    if (part.kind == Part::Kind::table_array) value.kind = core::Value::Kind::array;
    for (const auto& below : part.parts) value.entries.push_back({below.name, {}, {}});
    return value;
  }

  const Document& document_;
  const Schema& schema_;
};

bool begins_with(const Path& path, const Path& start) {
  return start.size() <= path.size() && std::equal(start.begin(), start.end(), path.begin());
}

/// Returns the form field that a remark is about: the field with the longest path that begins the path of the
/// remark. If the remark says that a table lacks a key, returns the field of this missing key.
Field* field_for(Group& group, const Path& place, const std::string& what) {
  Field* best = nullptr;
  for (auto& field : group.fields) {
    const bool exact = field.present && begins_with(place, field.path);
    if (exact && (best == nullptr || field.path.size() > best->path.size())) best = &field;
  }
  if (best != nullptr) return best;
  for (auto& field : group.fields)
    if (begins_with(field.path, place) && what.find("\"" + field.path.back() + "\"") != std::string::npos &&
        (best == nullptr || field.path.size() < best->path.size()))
      best = &field;
  if (best != nullptr || place.size() <= group.path.size()) return best;
  for (auto& field : group.fields)
    if (begins_with(field.path, place)) return &field;
  return nullptr;
}

void give_out(const std::vector<core::Problem>& remarks, const Document& document,
              std::vector<Section>& sections) {
  for (std::size_t i = 0; i < remarks.size(); ++i) {
    const auto& place = remarks[i].place;
    if (place.file != document.file()) continue;
    const auto path = place.line <= 0 ? Path() : document.at(place.line, place.column);
    if (path.empty()) continue;
    for (auto& section : sections)
      for (auto& group : section.groups) {
        if (!begins_with(path, group.path)) continue;
        auto* field = field_for(group, path, core::say(remarks[i].what, "en"));
        (field == nullptr ? group.remarks : field->remarks).push_back(i);
        ++section.remarks;
      }
  }
}

[[noreturn]] void refuse(const Field& field, const std::string& typed, const char* allowed) {
  using core::phrase, core::plain;
  throw core::BadInput({{{},
                         phrase("%1: \"%2\" is not possible", {plain(field.path.back()), plain(typed)}),
                         phrase(allowed)}});
}

std::vector<std::string> items_of(const std::string& typed, const char* separators) {
  std::vector<std::string> items;
  for (std::size_t at = 0; at < typed.size();) {
    const auto end = std::min(typed.find_first_of(separators, at), typed.size());
    auto item = typed.substr(at, end - at);
    item.erase(0,
               item.find_first_not_of(' ') == std::string::npos ? item.size() : item.find_first_not_of(' '));
    item.erase(item.find_last_not_of(' ') + 1);
    if (!item.empty()) items.push_back(item);
    at = end + 1;
  }
  return items;
}

bool is_number(const std::string& typed, bool whole) {
  try {
    const auto document = core::parse_toml("v = " + typed, "");
    const auto& value = document.entries.front().value;
    return document.entries.size() == 1 &&
           (value.kind == core::Value::Kind::integer || (value.kind == core::Value::Kind::number && !whole));
  } catch (const core::BadInput&) {
    return false;
  }
}

std::string toml_lines(const std::string& text) {
  if (text.find('\n') == std::string::npos) return toml_string(text);
  std::string lines = "\"\"\"\n", line;
  for (std::size_t at = 0; at <= text.size(); ++at) {
    if (at < text.size() && text[at] != '\n') {
      line += text[at];
      continue;
    }
    const auto one = toml_string(line);
    lines += one.substr(1, one.size() - 2) + (at < text.size() ? "\n" : "");
    line.clear();
  }
  return lines + "\"\"\"";
}

}  // namespace

namespace {

/// A text in all languages of the file.
std::string in_all_languages(const Document& document, const std::string& text) {
  std::string all;
  for (const auto& language : languages_of(document))
    all += (all.empty() ? "" : ", ") + key_of(language) + " = " + toml_string(text);
  return "{ " + all + " }";
}

std::string new_item(const Document& document, int number) {
  const auto text = [&](const char* english) { return in_all_languages(document, english); };
  return "id = \"question-" + std::to_string(number) + "\"\nquestion = " + text("Question") +
         "\nchoices = [ { id = \"yes\", label = " + text("Yes") + " }, { id = \"no\", label = " + text("No") +
         " } ]\n";
}

}  // namespace

std::string new_table(const Document& document, const std::string& kind) {
  const auto names = names_of(document, kind);
  int number = 1;
  const auto taken = [&] {
    return std::find(names.begin(), names.end(), kind + "-" + std::to_string(number)) != names.end();
  };
  while (taken()) ++number;
  const auto text = [&](const char* english) { return in_all_languages(document, english); };
  auto table = "[[" + kind + "]]\nname = \"" + kind + "-" + std::to_string(number) + "\"\n";
  if (kind == "consent")
    table += "text = " + text("Do you want to take part?") + "\nagree = " + text("Yes") + "\nrefuse = " + text("No") +
             "\nfarewell = " + text("Thank you.") + "\n";
  if (kind == "explanation") table += "\n[[explanation.page]]\ntext = " + text("Explanation") + "\n";
  if (kind == "questionnaire") table += "\n[[questionnaire.item]]\n" + new_item(document, 1);
  if (kind == "screening") table += "pass = []\nfarewell = " + text("Thank you. We stop here.") + "\n";
  return table;
}

std::string with_one_more(const Document& document, const Group& group) {
  auto last = group.path;
  last.push_back(group.below), last.push_back(std::to_string(group.below_count - 1));
  const auto number = std::to_string(group.below_count + 1);
  const Document more(document.with_copy(last, ""), document.file());
  if (group.below != "item") return more.text();
  last.back() = std::to_string(group.below_count);
  last.push_back("id");
  return more.with(last, toml_string("question-" + number));
}

std::string with_one_less(const Document& document, const Group& group) {
  if (group.below_count < 2) return document.text();
  auto last = group.path;
  last.push_back(group.below), last.push_back(std::to_string(group.below_count - 1));
  return document.without(last);
}

std::string referred_table(const std::string& key) {
  static const std::map<std::string, std::string> tables{{"base", "scene"},
                                                         {"intervals", "scene"},
                                                         {"standard", "scene"},
                                                         {"target", "scene"},
                                                         {"scene", "scene"},
                                                         {"level", "factor"},
                                                         {"adjusts", "factor"},
                                                         {"over", "factor"},
                                                         {"balance", "factor"},
                                                         {"by", "factor"},
                                                         {"procedures", "procedure"},
                                                         {"copy", "procedure"},
                                                         {"instruction", "instructions"}};
  const auto found = tables.find(key);
  return found == tables.end() ? "" : found->second;
}

std::vector<Section> form_of(const Document& document, const Schema& schema,
                             const std::vector<core::Problem>& remarks) {
  auto sections = Maker(document, schema).make();
  give_out(remarks, document, sections);
  return sections;
}

std::string encoded(const Field& field, const std::string& typed) {
  const auto list = [&](const char* separators, const auto& write) {
    std::string all;
    for (const auto& item : items_of(typed, separators)) all += (all.empty() ? "" : ", ") + write(item);
    return "[" + all + "]";
  };
  switch (field.kind) {
    case RuleKind::number:
    case RuleKind::integer:
      if (!is_number(typed, field.kind == RuleKind::integer))
        refuse(field, typed, field.kind == RuleKind::integer ? "a whole number" : "a number");
      return typed;
    case RuleKind::boolean:
      if (typed != "true" && typed != "false") refuse(field, typed, "true or false");
      return typed;
    case RuleKind::expression:
      return is_number(typed, false) ? typed : toml_string(typed);
    case RuleKind::numbers:
      return list(", ", [&](const std::string& item) {
        if (!is_number(item, false)) refuse(field, item, "numbers, separated by commas");
        return item;
      });
    case RuleKind::names:
      return list(",", [](const std::string& item) { return toml_string(item); });
    case RuleKind::word:
    case RuleKind::text:
      return toml_lines(typed);
    default:
      return typed;
  }
}

std::string changed(const Document& document, const Field& field, const std::string& typed) {
  if (field.present && typed == field.value) return document.text();
  if (typed.empty()) return field.present && !field.required ? document.without(field.path) : document.text();
  return document.with(field.path, encoded(field, typed));
}

}  // namespace turnpoint::view

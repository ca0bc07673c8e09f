#include "station/view/form.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "station/core/texts.hpp"
#include "station/protocol/protocol_keys.hpp"

namespace turnpoint::view {

namespace {

using core::Key, core::Keys;
using Input = Field::Input;

/// How two scenes of one interval, or two values in a row, are joined when a person reads and writes them.
constexpr const char* kThen = " → ";

struct Page {
  const char* name;
  std::vector<std::string> tables, added;
};
/// The pages of the form, each with its tables. What is in no other one is on the last.
const std::vector<Page>& pages() {
  static const std::vector<Page> all{
      {"study", {"protocol", "random"}, {}},
      {"question", {"task", "tasks", "instructions"}, {"instructions"}},
      {"scenes", {"scene"}, {"scene"}},
      {"levels", {"factor", "procedure"}, {"factor", "procedure"}},
      // the parts of a session, in the order in which they come
      {"blocks",
       {"block", "sequence", "consent", "explanation", "questionnaire", "screening"},
       {"block", "sequence", "consent", "explanation", "questionnaire", "screening"}},
      {"timing", {"timing"}, {}},
      {"other", {}, {}}};
  return all;
}

std::size_t page_of(const std::string& table) {
  for (std::size_t i = 0; i < pages().size(); ++i)
    if (std::count(pages()[i].tables.begin(), pages()[i].tables.end(), table) > 0) return i;
  return pages().size() - 1;
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

std::vector<std::string> strings_at(const Document& document, const Path& path) {
  std::vector<std::string> strings;
  if (const auto* part = document.find(path); part != nullptr)
    for (const auto& item : core::value_of(*part).items) strings.push_back(item.string);
  return strings;
}

std::vector<std::string> languages_of(const Document& document) {
  return strings_at(document, {"protocol", "languages"});
}

/// The table of the task, or those of several tasks.
std::vector<const Part*> tasks_of(const Document& document) {
  std::vector<const Part*> tasks;
  if (const auto* task = document.find({"task"}); task != nullptr) tasks.push_back(task);
  if (const auto* several = document.find({"tasks"}); several != nullptr)
    for (const auto& task : several->parts) tasks.push_back(&task);
  return tasks;
}

std::vector<std::string> choices_of(const Document& document) {
  std::vector<std::string> ids;
  for (const auto& task : tasks_of(document))
    if (const auto* part = task->find("choices"); part != nullptr)
      for (const auto& choice : part->parts)
        if (const auto* id = choice.find("id"); id != nullptr) ids.push_back(id->scalar.string);
  return ids;
}

/// The names that the keys of a table can have which the user names: those of all factors for FACTOR, ...
std::vector<std::string> names_for(const Document& document, const Key& named) {
  if (named.name == "FACTOR") return names_of(document, "factor");
  if (named.name == "SCENE") return names_of(document, "scene");
  if (named.name == "CHOICE") return choices_of(document);
  return {};
}

/// Returns a value as a person writes it: without quotes and brackets.
std::string shown(const Document& document, const Part& part, const char* between = ", ") {
  if (part.kind == Part::Kind::array) {
    std::string all;
    for (const auto& item : part.parts) all += (all.empty() ? "" : between) + shown(document, item, kThen);
    return all;
  }
  const auto written = document.text().substr(part.value.begin, part.value.end - part.value.begin);
  const bool text = written.starts_with('"') || written.starts_with('\'');
  return text ? part.scalar.string : written;
}

/// Whether a value is one scalar, or a list of scalars or of short lists of them.
bool is_simple(const Part& part, int depth = 0) {
  if (part.kind == Part::Kind::scalar) return true;
  return part.kind == Part::Kind::array && depth < 2 &&
         std::all_of(part.parts.begin(), part.parts.end(),
                     [depth](const Part& item) { return is_simple(item, depth + 1); });
}

/// Whether the first of a list's items, or the value itself, is a text.
bool is_text(const Part& part) {
  if (part.kind == Part::Kind::array) return !part.parts.empty() && is_text(part.parts.front());
  return part.kind == Part::Kind::scalar && part.scalar.kind == core::Value::Kind::string;
}

/// Whether a text in a list has a comma, which would separate two texts where a person types the list.
bool has_comma(const Part& list) {
  return std::any_of(list.parts.begin(), list.parts.end(), [](const Part& item) {
    return has_comma(item) || (is_text(item) && item.scalar.string.find(',') != std::string::npos);
  });
}

/// The forms of a key that are no tables.
std::vector<const Key*> simple_forms(const Key& key) {
  if (key.kind == Key::Kind::table || key.kind == Key::Kind::tables) return {};
  if (key.kind != Key::Kind::several) return {&key};
  std::vector<const Key*> all;
  for (const auto& form : key.forms)
    for (const auto* simple : simple_forms(form)) all.push_back(simple);
  return all;
}

/// The forms of a key that are tables.
std::vector<const Keys*> table_forms(const Key& key) {
  if (key.kind == Key::Kind::table) return {key.keys.get()};
  std::vector<const Keys*> all;
  if (key.kind == Key::Kind::several)
    for (const auto& form : key.forms)
      for (const auto* table : table_forms(form)) all.push_back(table);
  return all;
}

bool is_list_of_texts(const Key& key) {
  return key.kind == Key::Kind::list && key.forms.front().kind == Key::Kind::localised;
}

/// The number of values in a table, if all of them are simple; many if not.
std::size_t size_of(const std::vector<const Keys*>& forms) {
  constexpr std::size_t many = 100;
  std::size_t count = 0;
  std::set<std::string> done;
  for (const auto* keys : forms) {
    for (const auto& key : keys->list) {
      if (!done.insert(key.name).second) continue;
      const bool lists =
          key.kind == Key::Kind::tables || key.kind == Key::Kind::localised || is_list_of_texts(key);
      count += lists ? many : simple_forms(key).empty() ? 0 : 1;
      if (const auto below = table_forms(key); !below.empty()) count += size_of(below);
    }
    if (keys->named) ++count;
  }
  return count;
}
/// The fields of an absent table of this size stand on the page without a button that adds it first.
constexpr std::size_t kSmall = 3;

/// The form of a table that has all keys of the file; the first one if there is none.
const Keys* form_for(const std::vector<const Keys*>& forms, const core::Value& table) {
  const auto has_all = [&](const Keys* keys) {
    return keys->named ||
           std::all_of(table.entries.begin(), table.entries.end(), [&](const core::Entry& entry) {
             return std::any_of(keys->list.begin(), keys->list.end(),
                                [&](const Key& key) { return key.name == entry.key; });
           });
  };
  const auto found = std::find_if(forms.begin(), forms.end(), has_all);
  return found == forms.end() ? forms.front() : *found;
}

bool is_kind(const Key& key, std::initializer_list<Key::Kind> kinds) {
  return std::find(kinds.begin(), kinds.end(), key.kind) != kinds.end();
}

bool is_numeric(const Key& form) {
  return is_kind(form, {Key::Kind::number, Key::Kind::integer, Key::Kind::numbers, Key::Kind::integers,
                        Key::Kind::interval});
}

Input input_for(const std::vector<const Key*>& forms) {
  const auto any = [&](auto kind) { return std::any_of(forms.begin(), forms.end(), kind); };
  const auto of = [](std::initializer_list<Key::Kind> kinds) {
    return [kinds](const Key* form) { return is_kind(*form, kinds); };
  };
  if (any(of({Key::Kind::any}))) return Input::written;
  if (any(of({Key::Kind::texts, Key::Kind::list}))) return Input::names;
  if (!any([](const Key* form) { return !is_numeric(*form); })) return Input::number;
  if (any(of({Key::Kind::expression, Key::Kind::number, Key::Kind::integer}))) return Input::expression;
  if (any(of({Key::Kind::boolean}))) return Input::boolean;
  if (any(of({Key::Kind::word}))) return Input::word;
  return Input::text;
}

class Maker {
 public:
  explicit Maker(const Document& document) : document_(document) {}

  std::vector<Section> make() {
    std::vector<Section> sections;
    for (const auto& page : pages()) sections.push_back({page.name, page.added, {}, 0});
    for (const auto& key : protocol::protocol_keys().list) {
      if (is_replaced(key)) continue;
      auto& groups = sections[page_of(key.name)].groups;
      if (key.kind == Key::Kind::table && !key.keys->named)
        groups.push_back(group({key.name}, *key.keys, document_.find({key.name}), key.needed));
      else if (key.kind == Key::Kind::table || key.kind == Key::Kind::tables)
        add_tables(key, groups);
    }
    for (auto& section : sections)
      if (section.name == "blocks") put_in_order(section.groups);
    return sections;
  }

 private:
  /// Whether the file has another table instead, such as [tasks] instead of [task].
  bool is_replaced(const Key& key) const {
    return document_.find({key.name}) == nullptr &&
           std::ranges::any_of(key.conditions, [&](const auto& with) {
             return with.absent && document_.find({with.key}) != nullptr;
           });
  }

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
  void add_tables(const Key& key, std::vector<Group>& groups) {
    const auto* list = document_.find({key.name});
    if (list == nullptr) return;
    const bool of_list = key.kind == Key::Kind::tables;
    for (const auto& table : list->parts) {
      if (!table.is_table()) continue;
      const Path path{key.name, table.name};
      auto made = group(path, of_list ? *key.keys : *key.keys->named->keys, &table, true);
      made.name = of_list ? name_in(table) : table.name;
      made.copied = table.kind == Part::Kind::table;
      // a protocol needs a scene, and [tasks] two
      const std::size_t fewest = std::max<std::size_t>(key.needed ? 1 : 0, of_list ? 0 : key.keys->fewest);
      made.removable = made.copied && list->parts.size() > fewest;
      if (!of_list && made.copied) {
        Field name{path, Input::name};
        name.present = name.required = true, name.value = table.name;
        made.fields.insert(made.fields.begin(), std::move(name));
      }
      groups.push_back(std::move(made));
    }
  }

  Group group(const Path& path, const Keys& keys, const Part* part, bool needed) {
    Group group{path, "", part != nullptr};
    group.removable = part != nullptr && part->kind == Part::Kind::table && path.size() == 1 &&
                      page_of(path[0]) + 1 == pages().size();
    fields_ = &group.fields;
    add_table({path, path.size()}, {&keys}, part, needed || part != nullptr);
    const auto* inherits = path.front() == "procedure" ? "copy" : path.front() == "scene" ? "base" : "";
    if (part != nullptr && part->find(inherits) != nullptr)
      for (auto& field : group.fields) field.inherited = true;
    return group;
  }

  /// Where a table or a key is, and how much of this is said by the heading above it on the page.
  struct At {
    Path path;
    std::size_t heading = 0;
    At below(const std::string& name) const {
      auto longer = *this;
      longer.path.push_back(name);
      return longer;
    }
    At as_heading() const { return {path, path.size()}; }
  };

  /// What the table says, as far as it decides which keys it can have.
  core::Value value_of(const Path& path, const Part* part, int copies = 0) const {
    if (part == nullptr) return {};
    auto value = core::value_of(*part);
    const auto* copied = path.front() == "procedure" && path.size() == 2 ? value.find("copy") : nullptr;
    const auto* list = document_.find({path.front()});
    if (copied == nullptr || copies > 8) return value;
    for (const auto& other : list->parts) {
      if (&other == part || name_in(other) != copied->value.string) continue;
      for (auto& entry : value_of(path, &other, copies + 1).entries)
        if (value.find(entry.key) == nullptr) value.entries.push_back(std::move(entry));
      break;
    }
    return value;
  }

  void add_table(const At& at, const std::vector<const Keys*>& forms, const Part* part, bool needed) {
    const auto value = value_of(at.path, part);
    const auto* own_form = form_for(forms, value);
    std::set<std::string> done;
    for (const auto* keys : forms)
      for (const auto& declared : keys->list) {
        if (!done.insert(declared.name).second) continue;
        const auto found = core::find(*keys, declared.name, value);
        const auto* own = part == nullptr ? nullptr : part->find(declared.name);
        if (!found.fits && own == nullptr && !go_together(*keys, *found.key)) continue;
        add_key(at.below(declared.name), *found.key, own,
                needed && keys == own_form && found.fits &&
                    (found.key->needed || is_one_of(*keys, declared.name, value)));
      }
    for (const auto* keys : forms)
      if (keys->named) add_named(at, *keys->named, done, part);
  }

  /// Whether a key has an effect only with another one that has an effect only with it, so that one must come
  /// first.
  static bool go_together(const Keys& keys, const Key& key) {
    const auto needs = [](const Key& one, const std::string& name) {
      return std::any_of(one.conditions.begin(), one.conditions.end(), [&](const core::With& with) {
        return with.key == name && with.words.empty() && !with.absent;
      });
    };
    return std::any_of(keys.list.begin(), keys.list.end(),
                       [&](const Key& other) { return needs(key, other.name) && needs(other, key.name); });
  }

  /// Whether the table needs one of several keys, of which this is one, and has none of them.
  static bool is_one_of(const Keys& keys, const std::string& name, const core::Value& table) {
    for (const auto* lists : {&keys.exactly_one, &keys.at_least_one})
      for (const auto& names : *lists)
        if (std::count(names.begin(), names.end(), name) > 0 &&
            std::none_of(names.begin(), names.end(),
                         [&](const std::string& one) { return table.find(one) != nullptr; }))
          return true;
    return false;
  }

  /// Adds the keys that the user names: those of the file, and those that could be in it.
  void add_named(const At& at, const Key& named, const std::set<std::string>& others, const Part* part) {
    std::set<std::string> done = others;
    if (part != nullptr)
      for (const auto& entry : part->parts)
        if (done.insert(entry.name).second) add_key(at.below(entry.name), named, &entry, false);
    for (const auto& name : names_for(document_, named))
      if (done.insert(name).second) add_key(at.below(name), named, nullptr, false);
    const bool lists = named.kind == Key::Kind::tables;
    if (named.kind != Key::Kind::any && !lists) return;
    Field entry{at.path, lists ? Input::list_name : Input::entry};
    entry.key = &named, entry.heading = at.heading;
    fields_->push_back(std::move(entry));
  }

  void add_key(const At& at, const Key& key, const Part* part, bool required) {
    if (key.kind == Key::Kind::localised) return add_texts(at, key, part, required);
    if (key.kind == Key::Kind::tables || is_list_of_texts(key)) return add_list(at, key, part, required);
    const bool is_table = part != nullptr && part->is_table();
    const auto tables = table_forms(key);
    if (auto simple = simple_forms(key); !simple.empty())
      add_value(at, key, std::move(simple), is_table && !tables.empty() ? nullptr : part,
                required && !is_table);
    if (tables.empty()) return;
    const auto size = size_of(tables);
    if (is_table || size <= kSmall) {
      const bool headed = is_table && size > 1;
      if (headed) add_heading(at, key, required || key.needed);
      const bool needed = headed || (required && simple_forms(key).empty());
      return add_table(headed ? at.as_heading() : at, tables, is_table ? part : nullptr, needed);
    }
    if (part == nullptr || simple_forms(key).empty()) add_heading(at, key, required, false);
  }

  void add_heading(const At& at, const Key& key, bool required, bool present = true) {
    Field field{at.path, Input::table};
    field.key = &key, field.present = present, field.required = required, field.heading = at.heading;
    field.removable = present && !key.needed;
    fields_->push_back(std::move(field));
  }

  void add_texts(const At& at, const Key& key, const Part* part, bool required) {
    auto languages = languages_of(document_);
    if (part != nullptr)
      for (const auto& text : part->parts)
        if (std::count(languages.begin(), languages.end(), text.name) == 0) languages.push_back(text.name);
    for (const auto& language : languages) {
      const auto* own = part == nullptr ? nullptr : part->find(language);
      add_value(at.below(language), key, {&key}, own, required || (part != nullptr && own == nullptr));
    }
  }

  void add_list(const At& at, const Key& key, const Part* part, bool required) {
    const auto count = part == nullptr ? 0 : part->parts.size();
    Field list{at.path, Input::list};
    list.key = &key, list.present = count > 0, list.required = required, list.heading = at.heading;
    list.value = std::to_string(count);
    fields_->push_back(std::move(list));
    if (part == nullptr) return;
    for (const auto& item : part->parts) {
      const auto place = at.below(item.name);
      add_heading(place, key, true);
      fields_->back().removable = count > 1 || !key.needed;
      fields_->back().movable = &item != &part->parts.front();
      if (is_list_of_texts(key))
        add_texts(place.as_heading(), key.forms.front(), &item, true);
      else
        add_table(place.as_heading(), {key.keys.get()}, &item, true);
    }
  }

  void add_value(const At& at, const Key& key, std::vector<const Key*> forms, const Part* part,
                 bool required) {
    Field field{at.path, input_for(forms)};
    field.key = &key, field.forms = std::move(forms);
    field.present = part != nullptr, field.required = required, field.heading = at.heading;
    if (part != nullptr && (!is_simple(*part) || has_comma(*part))) field.input = Input::written;
    field.of_texts = has_texts(field, part);
    if (part != nullptr)
      field.value = field.input == Input::written ? document_.written(at.path) : shown(document_, *part);
    allow(field);
    fields_->push_back(std::move(field));
  }

  /// For a key that can have numbers or texts: whether it has texts.
  bool has_texts(const Field& field, const Part* part) const {
    if (std::any_of(field.forms.begin(), field.forms.end(),
                    [](const Key* form) { return is_kind(*form, {Key::Kind::expression}); }))
      return false;
    if (field.key->name == "FACTOR")
      if (const auto* factors = document_.find({"factor"}); factors != nullptr)
        for (const auto& factor : factors->parts)
          if (name_in(factor) == field.path.back())
            if (const auto* levels = factor.find("levels"); levels != nullptr) return is_text(*levels);
    auto beside = field.path;
    beside.back() = "choices";
    if (field.key->name == "simulated" && document_.find(beside) != nullptr) return true;
    return part != nullptr && is_text(*part);
  }

  void allow(Field& field) const {
    if (field.input == Input::boolean) field.allowed = {"true", "false"};
    for (const auto* form : field.forms)
      field.allowed.insert(field.allowed.end(), form->words.begin(), form->words.end());
    field.closed = !field.allowed.empty() && field.input != Input::expression;
    const auto& name = field.key->name.empty() ? field.path.back() : field.key->name;
    if (name == "languages") field.allowed = core::languages(), field.closed = true;
    if (name == "tracks") field.allowed = choices_of(document_);
    const auto table = referred_table(name);
    if (table.empty() || field.closed) return;
    field.allowed = names_of(document_, table);
    if (name == "intervals" || name == "standard" || name == "target")
      for (const auto* task : tasks_of(document_))
        if (const auto* parts = task->find("parts"); parts != nullptr)
          for (const auto& interval : parts->parts) field.allowed.push_back(interval.name);
    if (name == "after_each")
      for (const auto& sequence : names_of(document_, "sequence")) field.allowed.push_back(sequence);
    // A name refers to something that the file has. Until it has it, the name can be typed.
    if (field.input == Input::text && !field.allowed.empty()) field.input = Input::word;
    if (name == "intervals" && field.allowed.size() <= 5) add_pairs(field.allowed);
  }

  static void add_pairs(std::vector<std::string>& names) {
    const auto single = names;
    for (const auto& first : single)
      for (const auto& second : single)
        if (first != second) names.push_back(first + kThen + second);
  }

  const Document& document_;
  std::vector<Field>* fields_ = nullptr;
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
  const auto key = "design.keys." + (field.key == nullptr ? "name" : field.key->name);
  const bool has_word = core::catalogue("en").count(key) > 0;
  throw core::BadInput({{{},
                         phrase("%1: \"%2\" is not possible",
                                {has_word ? phrase(key) : plain(field.path.back()), plain(typed)}),
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

/// A text in all languages of the file.
std::string in_all_languages(const Document& document, const std::string& text) {
  std::string all;
  for (const auto& language : languages_of(document))
    all += (all.empty() ? "" : ", ") + key_of(language) + " = " + toml_string(text);
  return "{ " + all + " }";
}

std::string new_item(const Document& document) {
  const auto text = [&](const char* english) { return in_all_languages(document, english); };
  return "id = \"question-1\"\nquestion = " + text("Question") +
         "\nchoices = [ { id = \"yes\", label = " + text("Yes") + " }, { id = \"no\", label = " + text("No") +
         " } ]\n";
}

/// The first of `stem-1`, `stem-2`, ... that is not taken.
std::string free_name(const std::string& stem, const std::vector<std::string>& taken,
                      const char* mark = "-") {
  for (int number = 1;; ++number)
    if (auto name = stem + mark + std::to_string(number);
        std::find(taken.begin(), taken.end(), name) == taken.end())
      return name;
}

std::string list_of(const std::vector<std::string>& items) {
  std::string all;
  for (const auto& item : items) all += (all.empty() ? "" : ", ") + item;
  return "[" + all + "]";
}

std::string one_or_pair(const Key& list, const std::string& typed, bool of_texts) {
  const auto has = [&](std::initializer_list<Key::Kind> kinds) {
    return std::any_of(list.forms.begin(), list.forms.end(),
                       [&](const Key& form) { return is_kind(form, kinds); });
  };
  const bool numbers = !of_texts && has({Key::Kind::number, Key::Kind::numbers});
  std::vector<std::string> pieces;
  auto rest = typed;
  for (auto at = rest.find("→"); at != std::string::npos; at = rest.find("→"))
    rest.replace(at, std::string("→").size(), ">");
  for (auto& piece : items_of(rest, ">"))
    pieces.push_back(numbers && is_number(piece, false) ? piece : toml_string(piece));
  return pieces.size() == 1 && has({Key::Kind::text, Key::Kind::number}) ? pieces.front() : list_of(pieces);
}

/// What was typed as a value of this form; nothing if it cannot be one. `alone` is false if the key can also
/// be a list of texts.
std::optional<std::string> as(const Key& form, const std::string& typed, bool alone, bool of_texts) {
  const auto list = [&](const char* separators, const auto& write) {
    std::vector<std::string> all;
    for (const auto& item : items_of(typed, separators)) all.push_back(write(item));
    return list_of(all);
  };
  switch (form.kind) {
    case Key::Kind::number:
    case Key::Kind::integer:
      return is_number(typed, form.kind == Key::Kind::integer) ? std::optional(typed) : std::nullopt;
    case Key::Kind::boolean:
      return typed == "true" || typed == "false" ? std::optional(typed) : std::nullopt;
    case Key::Kind::expression:
      return is_number(typed, false) ? typed : toml_string(typed);
    case Key::Kind::numbers:
    case Key::Kind::integers:
    case Key::Kind::interval: {
      const auto items = items_of(typed, ", ");
      const bool all =
          std::all_of(items.begin(), items.end(), [](const auto& item) { return is_number(item, false); });
      return all ? std::optional(list_of(items)) : std::nullopt;
    }
    case Key::Kind::texts:
      return list(",", toml_string);
    case Key::Kind::list:
      return list(",", [&](const std::string& item) { return one_or_pair(form, item, of_texts); });
    default:
      if (!alone && items_of(typed, ",").size() > 1) return std::nullopt;
      return toml_lines(typed);
  }
}

const char* in_words(const Key& form) {
  return form.kind == Key::Kind::integer   ? "a whole number"
         : form.kind == Key::Kind::number  ? "a number"
         : form.kind == Key::Kind::boolean ? "true or false"
                                           : "numbers, separated by commas";
}

/// Numbers are tried first: a number is a text, too.
int rank(const Key& form) {
  if (is_kind(form, {Key::Kind::number, Key::Kind::integer, Key::Kind::boolean})) return 0;
  if (is_numeric(form)) return 1;
  return is_kind(form, {Key::Kind::texts, Key::Kind::list}) ? 3 : 2;
}

/// Whether there is a comma between two digits where several numbers can be typed. Where 1,5 is the way to
/// write 1.5, two numbers would be read without any remark.
bool has_decimal_comma(const Field& field, const std::string& typed) {
  const auto several = [](const Key& form) {
    return is_kind(form, {Key::Kind::numbers, Key::Kind::integers, Key::Kind::interval, Key::Kind::list});
  };
  const auto items = items_of(typed, ", ");
  if (field.of_texts ||
      std::none_of(field.forms.begin(), field.forms.end(), [&](const Key* form) { return several(*form); }) ||
      !std::all_of(items.begin(), items.end(), [](const auto& item) { return is_number(item, false); }))
    return false;
  const auto digit = [&typed](std::size_t at) {
    return at < typed.size() && typed[at] >= '0' && typed[at] <= '9';
  };
  for (std::size_t at = 1; at < typed.size(); ++at)
    if (typed[at] == ',' && digit(at - 1) && digit(at + 1)) return true;
  return false;
}

/// The text without the values on the way to a path that are no tables, and without a table that is there
/// instead of a value: a key can have several forms, and one gives way to another.
std::string cleared(const Document& document, const Path& path) {
  for (std::size_t size = 1; size <= path.size(); ++size) {
    const Path way(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(size));
    const auto* part = document.find(way);
    if (part == nullptr) break;
    const bool in_the_way = size == path.size()
                                ? part->is_table() || part->kind == Part::Kind::table_array
                                : part->kind == Part::Kind::scalar ||
                                      (part->kind == Part::Kind::array && document.find(path) == nullptr &&
                                       part->find(path[size]) == nullptr);
    if (in_the_way) return document.without(way);
  }
  return document.text();
}

std::string with_entry(const Document& document, const Field& field, const std::string& typed) {
  const auto entries = core::parse_toml(typed, document.file()).entries;
  const auto parts = core::parts_of(typed, document.file());
  if (entries.size() != 1 || parts.parts.front().kind == Part::Kind::dotted)
    refuse(field, typed, "a name, = and a value, such as start = 5");
  const auto& part = parts.parts.front();
  auto path = field.path;
  path.push_back(part.name);
  return document.with(path, typed.substr(part.value.begin, part.value.end - part.value.begin));
}

/// The text with one more list of tables, which begins with a table of the first scene, if there is one.
std::string with_list(const Document& document, const Field& field, const std::string& name) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  };
  if (!std::all_of(name.begin(), name.end(), is_plain)) refuse(field, name, "letters, digits, - and _");
  auto path = field.path;
  path.push_back(name);
  if (document.find(path) != nullptr) refuse(field, name, "a name that is not there yet");
  const auto scenes = names_of(document, "scene");
  return document.with(path, scenes.empty() ? "[{}]" : "[{ scene = " + toml_string(scenes.front()) + " }]");
}

/// A value as a person writes it, with another name in place of one of its names, also before a dot.
std::string with_other_name(const std::string& value, const std::string& name, const std::string& other) {
  std::string all;
  for (std::size_t at = 0; at <= value.size();) {
    const auto comma = std::min(value.find(", ", at), value.size());
    const auto end = std::min(value.find(kThen, at), comma);
    const auto one = value.substr(at, end - at);
    const auto next = end == value.size() ? end + 1 : end + (end == comma ? 2 : std::string(kThen).size());
    all += (one == name || one.starts_with(name + ".") ? other + one.substr(name.size()) : one) +
           value.substr(end, next - end);
    at = next;
  }
  return all;
}

/// Whether the value of a field can be or begin with the name of a table of this kind.
bool refers(const Group& group, const Field& field, const std::string& kind) {
  const auto& key = field.key->name.empty() ? field.path.back() : field.key->name;
  const bool at_levels = group.path.front() == "factor" && group.name == "instruction" && key == "levels";
  return referred_table(key) == kind || (kind == "sequence" && key == "after_each") ||
         (kind == "scene" && key == "correct") || (kind == "instructions" && at_levels) ||
         (group.path.front() == "screening" && key == "pass");
}

/// The file's text with another name for a table, also in the keys and values that refer to it.
std::string renamed(const Document& document, const Field& field, const std::string& name) {
  const auto& kind = field.path.front();
  auto text = document.text();
  for (const auto& section : Maker(document).make())
    for (const auto& group : section.groups)
      for (const auto& other : group.fields) {
        if (!other.present || other.key == nullptr) continue;
        const Document now(text, document.file());
        auto path = other.path;
        const auto typed =
            refers(group, other, kind) ? with_other_name(other.value, field.value, name) : other.value;
        if (typed != other.value)
          text = now.with(path, encoded(other, typed));
        else if (other.key->name == "SCENE" && kind == "scene" && path.back() == field.value) {
          path.back() = name;
          text = Document(now.with(path, now.written(other.path)), now.file()).without(other.path);
        }
      }
  const Document now(text, document.file());
  return field.input == Input::name ? now.with_name(field.path, name)
                                    : now.with(field.path, encoded(field, name));
}

}  // namespace

std::string empty_study(const std::string& id) {
  return "format = \"friction-protocol/1\"\n\n[protocol]\nid = " + toml_string(id) +
         "\nversion = \"0.1.0\"\ntitle = " + toml_string(id) + "\nlanguages = [\"en\"]\n";
}

std::string new_table(const Document& document, const std::string& kind) {
  const bool named_in_header = kind == "scene" || kind == "instructions";
  const auto name = free_name(kind == "instructions" ? "instruction" : kind, names_of(document, kind),
                              kind == "factor" ? "_" : "-");
  if (named_in_header) {
    const auto text = kind == "scene" ? "" : "text = " + in_all_languages(document, "Ready?") + "\n";
    return "[" + kind + "." + name + "]\n" + text;
  }
  const auto text = [&](const char* english) { return in_all_languages(document, english); };
  auto table = "[[" + kind + "]]\nname = \"" + name + "\"\n";
  if (kind == "consent")
    table += "text = " + text("Do you want to take part?") + "\nagree = " + text("Yes") +
             "\nrefuse = " + text("No") + "\nfarewell = " + text("Thank you.") + "\n";
  if (kind == "explanation") table += "\n[[explanation.page]]\ntext = " + text("Explanation") + "\n";
  if (kind == "questionnaire") table += "\n[[questionnaire.item]]\n" + new_item(document);
  if (kind == "screening") table += "farewell = " + text("Thank you. We stop here.") + "\n";
  if (kind == "sequence") table += "design = \"latin-square\"\n";
  return table;
}

std::string referred_table(const std::string& key) {
  static const std::map<std::string, std::string> tables{{"base", "scene"},
                                                         {"task", "tasks"},
                                                         {"intervals", "scene"},
                                                         {"standard", "scene"},
                                                         {"target", "scene"},
                                                         {"scene", "scene"},
                                                         {"level", "factor"},
                                                         {"adjusts", "factor"},
                                                         {"over", "factor"},
                                                         {"balance", "factor"},
                                                         {"against", "factor"},
                                                         {"by", "factor"},
                                                         {"for_each", "factor"},
                                                         {"question_shows", "factor"},
                                                         {"copy", "procedure"},
                                                         {"after_each_other", "factor"},
                                                         {"procedures", "procedure"},
                                                         {"after_each", "block"},
                                                         {"instruction", "instructions"}};
  const auto found = tables.find(key);
  return found == tables.end() ? "" : found->second;
}

std::vector<Section> form_of(const Document& document, const std::vector<core::Problem>& remarks) {
  auto sections = Maker(document).make();
  give_out(remarks, document, sections);
  return sections;
}

std::string encoded(const Field& field, const std::string& typed) {
  if (field.input == Input::written || field.forms.empty()) return typed;
  auto forms = field.forms;
  if (has_decimal_comma(field, typed))
    refuse(field, typed, "a decimal point, as in 1.5, or a space after a comma between two numbers: 1, 5");
  const auto order = [&field](const Key* form) {
    return field.of_texts && is_numeric(*form) ? 4 : rank(*form);
  };
  std::stable_sort(forms.begin(), forms.end(),
                   [&](const Key* a, const Key* b) { return order(a) < order(b); });
  const bool alone =
      std::none_of(forms.begin(), forms.end(), [](const Key* form) { return rank(*form) == 3; });
  for (const auto* form : forms)
    if (const auto written = as(*form, typed, alone, field.of_texts)) return *written;
  refuse(field, typed, in_words(*forms.back()));
}

std::string changed(const Document& document, const Field& field, const std::string& typed) {
  if (field.present && typed == field.value) return document.text();
  if (field.input == Input::entry)
    return typed.empty() ? document.text() : with_entry(document, field, typed);
  if (field.input == Input::list_name)
    return typed.empty() ? document.text() : with_list(document, field, typed);
  if (field.input == Input::name) return typed.empty() ? document.text() : renamed(document, field, typed);
  if (typed.empty()) {
    if (!field.present || field.required) return document.text();
    // A table that has no heading of its own on the page goes with its last key.
    const Path above(field.path.begin(), field.path.end() - 1);
    const bool goes_with = above.size() > field.heading && document.find(above)->parts.size() == 1;
    return document.without(goes_with ? above : field.path);
  }
  // In expressions, the names of factors are not replaced, so that those stay everywhere.
  if (field.present && field.path.size() == 3 && field.path.back() == "name" &&
      field.path.front() != "factor")
    return renamed(document, field, typed);
  const auto value = encoded(field, typed);
  return Document(cleared(document, field.path), document.file()).with(field.path, value);
}

std::string extended(const Document& document, const Field& field) {
  const auto* part = document.find(field.path);
  const bool is_list = field.input == Input::list;
  if (part == nullptr || part->parts.empty() || !is_list) {
    if (part != nullptr && part->is_table()) return document.text();
    return Document(cleared(document, field.path), document.file()).with(field.path, is_list ? "[{}]" : "{}");
  }
  auto path = field.path;
  path.push_back(std::to_string(part->parts.size() - 1));
  const auto last = document.written(path);
  const bool by_header = part->kind == Part::Kind::table_array;
  if (!by_header) path.back() = std::to_string(part->parts.size());
  const Document more(by_header ? document.with_copy(path, "") : document.with(path, last), document.file());
  path.back() = std::to_string(part->parts.size());
  path.push_back("id");
  const auto* id = more.find(path);
  if (id == nullptr) return more.text();
  std::vector<std::string> taken;
  for (const auto& item : part->parts)
    if (const auto* one = item.find("id"); one != nullptr) taken.push_back(one->scalar.string);
  auto stem = id->scalar.string;
  if (const auto end = stem.find_last_not_of("0123456789");
      end != std::string::npos && end + 1 < stem.size() && stem[end] == '-')
    stem.erase(end);
  return more.with(path, toml_string(free_name(stem, taken)));
}

std::string reduced(const Document& document, const Field& field) {
  const auto* part = document.find(field.path);
  if (part == nullptr || !field.removable) return document.text();
  Path list(field.path.begin(), field.path.end() - 1);
  const auto* above = document.find(list);
  const bool last = (above->kind == Part::Kind::array || above->kind == Part::Kind::table_array) &&
                    above->parts.size() == 1;
  return document.without(last ? list : field.path);
}

std::string with_part_at(const Document& document, std::size_t from, std::size_t to) {
  auto text = document.text();
  for (auto at = from; at != to; at += to > from ? 1 : -1) {
    const Document now(text, document.file());
    for (const auto& section : Maker(now).make()) {
      if (section.name != "blocks" || at >= section.groups.size()) continue;
      const auto& part = section.groups[at];
      const auto& other = to > from ? part.later : part.earlier;
      if (other.empty()) return text;
      text = now.exchanged(part.path, other);
    }
  }
  return text;
}

std::string moved_up(const Document& document, const Field& field) {
  if (!field.movable) return document.text();
  auto before = field.path;
  before.back() = std::to_string(std::stoul(before.back()) - 1);
  return document.exchanged(before, field.path);
}

}  // namespace turnpoint::view

// What people and their editors read about the keys of a format: the JSON schema and the reference tables.
#include <algorithm>
#include <cmath>

#include "station/core/keys.hpp"
#include "station/core/number.hpp"

namespace turnpoint::core {

namespace {

using Kind = Key::Kind;

/// A value of a JSON document. Its members stay in the order in which they were added.
struct Json {
  std::string scalar;  ///< as it is written; "" for an object or a list
  bool is_list = false;
  std::string name = {};  ///< of a member of an object
  std::vector<Json> members = {};

  Json& add(const std::string& key, Json value) {
    value.name = key;
    members.push_back(std::move(value));
    return *this;
  }
};

void capitalise(std::string& text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
}

std::string in_quotes(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

Json word(const std::string& text) { return {in_quotes(text)}; }
Json written(const std::string& scalar) { return {scalar}; }
Json amount(double value) {
  return written(value == std::floor(value) && std::fabs(value) < 1e15
                     ? std::to_string(static_cast<long long>(value))
                     : exact(value));
}
Json list_of(std::vector<Json> items) {
  Json list;
  list.is_list = true;
  for (auto& item : items) list.add("", std::move(item));
  return list;
}
Json list_of_words(const std::vector<std::string>& words) {
  std::vector<Json> items;
  for (const auto& one : words) items.push_back(word(one));
  return list_of(std::move(items));
}

std::string on_one_line(const Json& json) {
  if (!json.scalar.empty()) return json.scalar;
  std::string line;
  for (const auto& member : json.members)
    line += (line.empty() ? "" : ", ") + (json.is_list ? "" : in_quotes(member.name) + ": ") +
            on_one_line(member);
  return json.is_list ? "[" + line + "]" : "{" + line + "}";
}

std::string rendered(const Json& json, std::size_t indent, std::size_t before = 0) {
  constexpr std::size_t width = 110;
  auto line = on_one_line(json);
  if (!json.scalar.empty() || indent + before + line.size() <= width) return line;
  std::string lines = json.is_list ? "[" : "{";
  for (std::size_t i = 0; i < json.members.size(); ++i) {
    const auto& member = json.members[i];
    const auto start = json.is_list ? "" : in_quotes(member.name) + ": ";
    lines += (i == 0 ? "\n" : ",\n") + std::string(indent + 1, ' ') + start +
             rendered(member, indent + 1, start.size());
  }
  return lines + "\n" + std::string(indent, ' ') + (json.is_list ? "]" : "}");
}

class SchemaWriter {
 public:
  std::string write(const Keys& keys, const std::string& title) {
    Json root;
    root.add("$schema", word("https://json-schema.org/draft/2020-12/schema")).add("title", word(title));
    auto object = table(keys);
    for (auto& member : object.members) root.members.push_back(std::move(member));
    if (localised_ || expression_) {
      Json definitions;
      if (localised_)
        definitions.add("texts", Json{}
                                     .add("description", word("A text in each of the protocol's languages"))
                                     .add("type", word("object"))
                                     .add("minProperties", amount(1))
                                     .add("additionalProperties", text_of("")));
      if (expression_)
        definitions.add("linear",
                        Json{}
                            .add("description", word("A number, or linear arithmetic on factors in quotes"))
                            .add("oneOf", list_of({Json{}.add("type", word("number")), text_of("")})));
      root.add("$defs", std::move(definitions));
    }
    return rendered(root, 0) + "\n";
  }

 private:
  static Json text_of(const std::string& pattern) {
    Json json;
    json.add("type", word("string"));
    return pattern.empty() ? json.add("minLength", amount(1)) : json.add("pattern", word(pattern));
  }

  static void limits(Json& json, const Key& key) {
    using Ends = Range::Ends;
    const auto& range = key.range;
    const bool low_open = range.ends == Ends::open_low || range.ends == Ends::open;
    const bool high_open = range.ends == Ends::open_high || range.ends == Ends::open;
    if (std::isfinite(range.low)) json.add(low_open ? "exclusiveMinimum" : "minimum", amount(range.low));
    if (std::isfinite(range.high) && !key.infinite)
      json.add(high_open ? "exclusiveMaximum" : "maximum", amount(range.high));
  }

  static void sizes(Json& json, const Key& key) {
    if (key.fewest > 0) json.add("minItems", amount(static_cast<double>(key.fewest)));
    if (key.most > 0) json.add("maxItems", amount(static_cast<double>(key.most)));
  }

  static std::string uri_pattern(const Key& key) {
    std::string all;
    for (const auto& form : key.words) {
      const auto scheme = form.substr(0, form.find(':') + 1);
      all += (all.empty() ? "" : "|") + scheme + (scheme == form ? "$" : ".");
    }
    return "^(" + all + ")";
  }

  Json array(const Key& key, Json items) {
    Json json;
    json.add("type", word("array")).add("items", std::move(items));
    sizes(json, key);
    return json;
  }

  Json forms(const std::vector<Key>& list) {
    std::vector<Json> items;
    for (const auto& form : list) items.push_back(value(form));
    return items.size() == 1 ? std::move(items.front()) : Json{}.add("anyOf", list_of(std::move(items)));
  }

  Json value(const Key& key) {
    Json json;
    switch (key.kind) {
      case Kind::number:
      case Kind::integer:
        json.add("type", word(key.kind == Kind::number ? "number" : "integer"));
        limits(json, key);
        return json;
      case Kind::boolean:
        return json.add("type", word("boolean"));
      case Kind::text:
        return text_of(key.pattern);
      case Kind::word:
        return key.words.size() == 1 && key.name == "format" ? json.add("const", word(key.words.front()))
                                                             : json.add("enum", list_of_words(key.words));
      case Kind::uri:
        return text_of(uri_pattern(key));
      case Kind::numbers:
      case Kind::integers:
      case Kind::interval: {
        Json item;
        item.add("type", word(key.kind == Kind::integers ? "integer" : "number"));
        limits(item, key);
        if (key.kind != Kind::interval) json = array(key, std::move(item));
        if (key.kind == Kind::integers) json.add("uniqueItems", written("true"));
        if (key.kind == Kind::interval)
          json.add("type", word("array"))
              .add("items", std::move(item))
              .add("minItems", amount(2))
              .add("maxItems", amount(2));
        return json;
      }
      case Kind::texts:
        return array(key,
                     key.words.empty() ? text_of(key.pattern) : Json{}.add("enum", list_of_words(key.words)));
      case Kind::expression:
        expression_ = true;
        return json.add("$ref", word("#/$defs/linear"));
      case Kind::localised:
        localised_ = true;
        return json.add("$ref", word("#/$defs/texts"));
      case Kind::table:
        return table(*key.keys);
      case Kind::tables:
        return array(key, table(*key.keys));
      case Kind::list:
        return array(key, forms(key.forms));
      case Kind::several:
        return forms(key.forms);
      case Kind::any:
        return json;
    }
    return json;
  }

  /// What a key is, with all declarations that it has.
  Json property(const std::vector<const Key*>& same) {
    std::vector<std::string> sentences;
    std::vector<Json> values;
    for (const auto* key : same) {
      auto sentence = key->help;
      if (const auto condition = condition_of(*key); !condition.empty()) sentence += "; " + condition;
      if (std::find(sentences.begin(), sentences.end(), sentence) == sentences.end())
        sentences.push_back(std::move(sentence));
      const auto add = [&](Json one) {
        const auto is = [&](const Json& other) { return on_one_line(other) == on_one_line(one); };
        if (std::none_of(values.begin(), values.end(), is)) values.push_back(std::move(one));
      };
      if (key->kind != Kind::several) add(value(*key));
      for (const auto& form : key->kind == Kind::several ? key->forms : std::vector<Key>{}) add(value(form));
    }
    std::string description;
    for (const auto& sentence : sentences) description += (description.empty() ? "" : " / ") + sentence;
    capitalise(description);
    Json json;
    json.add("description", word(description));
    const auto& fallback = same.front()->fallback;
    if (same.size() == 1 && !fallback.empty()) json.add("default", written(fallback));
    if (values.size() > 1) return json.add("anyOf", list_of(std::move(values)));
    for (auto& member : values.front().members) json.members.push_back(std::move(member));
    return json;
  }

  static std::vector<Json> each_required(const std::vector<std::string>& names) {
    std::vector<Json> items;
    for (const auto& name : names) items.push_back(Json{}.add("required", list_of_words({name})));
    return items;
  }

  Json table(const Keys& keys) {
    Json json, properties;
    json.add("type", word("object"));
    std::vector<std::string> needed, done;
    for (const auto& key : keys.list) {
      if (std::find(done.begin(), done.end(), key.name) != done.end()) continue;
      done.push_back(key.name);
      std::vector<const Key*> same;
      for (const auto& other : keys.list)
        if (other.name == key.name) same.push_back(&other);
      if (std::all_of(same.begin(), same.end(),
                      [](const Key* one) { return one->needed && one->conditions.empty(); }))
        needed.push_back(key.name);
      properties.add(key.name, property(same));
    }
    if (!properties.members.empty()) json.add("properties", std::move(properties));
    json.add("additionalProperties", keys.named ? value(*keys.named) : written("false"));
    if (!needed.empty()) json.add("required", list_of_words(needed));
    if (keys.fewest > 0) json.add("minProperties", amount(static_cast<double>(keys.fewest)));
    std::vector<Json> all;
    for (const auto& names : keys.exactly_one)
      all.push_back(Json{}.add("oneOf", list_of(each_required(names))));
    for (const auto& names : keys.at_least_one)
      all.push_back(Json{}.add("anyOf", list_of(each_required(names))));
    if (!all.empty()) json.add("allOf", list_of(std::move(all)));
    return json;
  }

  bool localised_ = false, expression_ = false;
};

std::string in_range(const Key& key) {
  const bool open = !std::isfinite(key.range.low) && !std::isfinite(key.range.high);
  return open ? "" : " " + core::say(describe(key.range), "en");
}

std::string words_in_code(const std::vector<std::string>& words) {
  std::string all;
  for (const auto& one : words) all += (all.empty() ? "`\"" : ", `\"") + one + "\"`";
  return all;
}

std::string type_of(const Key& key) {
  switch (key.kind) {
    case Kind::number:
      return "number" + in_range(key);
    case Kind::integer:
      return "whole number" + in_range(key);
    case Kind::boolean:
      return "`true` or `false`";
    case Kind::text:
      return "text";
    case Kind::word:
    case Kind::uri:
      return words_in_code(key.words);
    case Kind::numbers:
      return "list of numbers" + in_range(key);
    case Kind::integers:
      return "list of whole numbers" + in_range(key);
    case Kind::interval:
      return "`[low, high]`" + in_range(key);
    case Kind::texts:
      return key.words.empty() ? "list of texts" : "list of " + words_in_code(key.words);
    case Kind::expression:
      return "number or expression" + in_range(key);
    case Kind::localised:
      return "text in each language";
    case Kind::table:
      return "table";
    case Kind::tables:
      return "list of tables";
    case Kind::list:
    case Kind::several: {
      std::string all;
      for (const auto& form : key.forms) {
        auto one = type_of(form);
        if (form.kind == Kind::table && !form.keys->list.empty()) {
          one = "`{ ";
          for (std::size_t i = 0; i < form.keys->list.size(); ++i)
            one += (i == 0 ? "" : ", ") + form.keys->list[i].name + " = ...";
          one += " }`";
        }
        all += (all.empty() ? "" : ", or ") + one;
      }
      return key.kind == Kind::list ? "list of: " + all : all;
    }
    case Kind::any:
      return "any value";
  }
  return "";
}

std::string default_of(const Key& key) {
  if (!key.fallback.empty()) return "`" + key.fallback + "`";
  return key.needed ? "**required**" : key.otherwise;
}

/// Tables of a file that have the same keys, and what the reference says about them.
struct Section {
  std::vector<std::string> titles;
  std::string condition, tables;
};

/// The table of the keys that stand directly in a table of a file; "" if it has none of its own.
std::string rows_of(const Keys& keys) {
  std::string rows;
  const auto row = [&](const Key& key) {
    const auto condition = condition_of(key);
    rows += "| `" + key.name + "` | " + type_of(key) + " | " + default_of(key) + " | " + key.help +
            (condition.empty() ? "" : "; " + condition) + " |\n";
  };
  for (const auto& key : keys.list) row(key);
  if (keys.named && !keys.named->keys) row(*keys.named);
  if (rows.empty()) return "";
  rows = "| key | value | default | meaning |\n|---|---|---|---|\n" + rows;
  for (const auto& names : keys.exactly_one)
    rows += "\nExactly one of " + words_in_code(names) + " is needed.\n";
  for (const auto& names : keys.at_least_one)
    rows += "\nAt least one of " + words_in_code(names) + " is needed.\n";
  return rows;
}

/// Adds a section, or its title to the section that says the same.
void add(Section section, std::vector<Section>& sections) {
  if (section.tables.empty()) return;
  const auto same = std::ranges::find_if(sections, [&](const Section& one) {
    return one.tables == section.tables && one.condition == section.condition;
  });
  if (same == sections.end()) return sections.push_back(std::move(section));
  same->titles.push_back(section.titles.front());
}

/// Adds the sections of the tables below these keys.
void add_below(const Keys& keys, const std::string& path, std::vector<Section>& sections) {
  const auto of_key = [&](const Key& key) {
    const auto full = path.empty() ? key.name : path + "." + key.name;
    const auto title = key.kind == Kind::tables ? "`[[" + full + "]]`" : "`[" + full + "]`";
    const bool several = std::ranges::count(keys.list, key.name, &Key::name) > 1;
    Section section{{title}, several ? condition_of(key) : "", ""};
    if (key.keys) section.tables = rows_of(*key.keys);
    for (const auto& form : key.forms)
      if (form.keys && !form.keys->list.empty())
        section.tables += (section.tables.empty() ? "" : "\nor\n\n") + rows_of(*form.keys);
    add(std::move(section), sections);
    if (key.keys) add_below(*key.keys, full, sections);
    for (const auto& form : key.forms)
      if (form.keys && !form.keys->list.empty()) add_below(*form.keys, full, sections);
  };
  for (const auto& key : keys.list) of_key(key);
  if (keys.named) of_key(*keys.named);
}

}  // namespace

std::string values_of(const Key& key) {
  auto words = type_of(key);
  std::erase(words, '`');
  return words;
}

std::string json_schema(const Keys& keys, const std::string& title) {
  return SchemaWriter().write(keys, title);
}

std::string reference(const Keys& keys) {
  std::vector<Section> sections{{{"The file"}, "", rows_of(keys)}};
  add_below(keys, "", sections);
  std::string page;
  for (const auto& section : sections) {
    page += "\n## " + section.titles.front() + "\n\n";
    std::string also = section.condition;
    for (std::size_t i = 1; i < section.titles.size(); ++i)
      also += (i > 1 ? ", " : also.empty() ? "The same in " : "; the same in ") + section.titles[i];
    if (!also.empty()) {
      capitalise(also);
      page += also + ":\n\n";
    }
    page += section.tables;
  }
  return page;
}

}  // namespace turnpoint::core

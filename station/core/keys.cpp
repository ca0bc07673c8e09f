#include "station/core/keys.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <tuple>

namespace turnpoint::core {

namespace key {

namespace {
Key made(std::string name, Key::Kind kind, std::string help) {
  Key key;
  key.name = std::move(name), key.kind = kind, key.help = std::move(help);
  return key;
}
Key ranged(std::string name, Key::Kind kind, const Range& range, std::string help) {
  auto key = made(std::move(name), kind, std::move(help));
  key.range = range;
  return key;
}
Key worded(std::string name, Key::Kind kind, std::vector<std::string> words, std::string help) {
  auto key = made(std::move(name), kind, std::move(help));
  key.words = std::move(words);
  return key;
}
Key nested(std::string name, Key::Kind kind, Keys keys, std::string help) {
  auto key = made(std::move(name), kind, std::move(help));
  key.keys = std::make_shared<const Keys>(std::move(keys));
  return key;
}
Key formed(std::string name, Key::Kind kind, std::vector<Key> forms, std::string help) {
  auto key = made(std::move(name), kind, std::move(help));
  key.forms = std::move(forms);
  return key;
}
}  // namespace

using Kind = Key::Kind;

Key number(std::string name, const Range& range, std::string help) {
  return ranged(std::move(name), Kind::number, range, std::move(help));
}
Key integer(std::string name, int low, int high, std::string help) {
  return ranged(std::move(name), Kind::integer, {double(low), double(high)}, std::move(help));
}
Key boolean(std::string name, std::string help) {
  return made(std::move(name), Kind::boolean, std::move(help)).by_default("false");
}
Key string(std::string name, std::string help) { return made(std::move(name), Kind::text, std::move(help)); }
Key word(std::string name, std::vector<std::string> words, std::string help) {
  return worded(std::move(name), Kind::word, std::move(words), std::move(help));
}
Key uri(std::vector<std::string> forms, std::string help) {
  return worded("uri", Kind::uri, std::move(forms), std::move(help)).required();
}
Key numbers(std::string name, const Range& range, std::string help) {
  return ranged(std::move(name), Kind::numbers, range, std::move(help)).holding(1);
}
Key integers(std::string name, int low, int high, std::string help) {
  return ranged(std::move(name), Kind::integers, {double(low), double(high)}, std::move(help)).holding(1);
}
Key interval(std::string name, const Range& range, std::string help) {
  return ranged(std::move(name), Kind::interval, range, std::move(help));
}
Key strings(std::string name, std::string help) {
  return made(std::move(name), Kind::texts, std::move(help)).holding(1);
}
Key words(std::string name, std::vector<std::string> words, std::string help) {
  return worded(std::move(name), Kind::texts, std::move(words), std::move(help));
}
Key expression(std::string name, const Range& range, std::string help) {
  return ranged(std::move(name), Kind::expression, range, std::move(help));
}
Key localised(std::string name, std::string help) {
  return made(std::move(name), Kind::localised, std::move(help));
}
Key table(std::string name, Keys keys, std::string help) {
  return nested(std::move(name), Kind::table, std::move(keys), std::move(help));
}
Key tables(std::string name, Keys keys, std::string help) {
  return nested(std::move(name), Kind::tables, std::move(keys), std::move(help)).holding(1);
}
Key list(std::string name, std::vector<Key> forms, std::string help) {
  return formed(std::move(name), Kind::list, std::move(forms), std::move(help)).holding(1);
}
Key several(std::string name, std::vector<Key> forms, std::string help) {
  return formed(std::move(name), Kind::several, std::move(forms), std::move(help));
}
Key any(std::string name, std::string help) { return made(std::move(name), Kind::any, std::move(help)); }

}  // namespace key

namespace {

const Keys* one_below(const Keys& keys, const std::string& name) {
  for (const auto& key : keys.list)
    if (key.name == name)
      if (const auto* found = tables_of(key)) return found;
  return keys.named ? tables_of(*keys.named) : nullptr;
}

/// What a key is, if the table does not say it: its default without quotes.
std::string default_word(const Keys& keys, const std::string& name) {
  for (const auto& key : keys.list)
    if (key.name == name && !key.fallback.empty())
      return key.fallback.front() == '"' ? key.fallback.substr(1, key.fallback.size() - 2) : key.fallback;
  return "";
}

bool is_word(const std::string& value, const std::vector<std::string>& words) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return value == word || (word.ends_with(':') && value.starts_with(word));
  });
}

bool holds(const With& with, const Keys& keys, const Value& table) {
  const auto* entry = table.find(with.key);
  if (with.words.empty()) return (entry == nullptr) == with.absent;
  if (entry == nullptr) return is_word(default_word(keys, with.key), with.words);
  if (entry->value.kind == Value::Kind::boolean)
    return is_word(entry->value.boolean ? "true" : "false", with.words);
  // A value that is not allowed has been reported. What goes with it is not known.
  if (with.words.front() == "true") return true;
  for (const auto& key : keys.list)
    if (key.name == with.key && key.kind == Key::Kind::word && !is_word(entry->value.string, key.words))
      return true;
  return is_word(entry->value.string, with.words);
}

bool alike(const Keys& one, const Keys& other) {
  const auto also_in_conditions = [](const Key& a, const Key& b) {
    return core::alike(a, b) &&
           std::ranges::equal(a.conditions, b.conditions, [](const With& x, const With& y) {
             return x.key == y.key && x.words == y.words && x.absent == y.absent;
           });
  };
  return std::ranges::equal(one.list, other.list, also_in_conditions) &&
         one.exactly_one == other.exactly_one && one.at_least_one == other.at_least_one &&
         one.fewest == other.fewest && !one.named == !other.named &&
         (!one.named || also_in_conditions(*one.named, *other.named));
}

}  // namespace

bool alike(const Key& one, const Key& other) {
  const auto said = [](const Key& key) {
    return std::tuple(key.name, key.kind, key.help, key.range.low, key.range.high, key.range.ends,
                      std::string(key.range.unit), key.infinite, key.words, key.pattern, key.form,
                      key.fallback, key.otherwise, key.needed, key.fewest, key.most);
  };
  return said(one) == said(other) && !one.keys == !other.keys &&
         (!one.keys || alike(*one.keys, *other.keys)) &&
         std::ranges::equal(one.forms, other.forms, [](const Key& a, const Key& b) { return alike(a, b); });
}

const Keys* tables_of(const Key& key) {
  if (key.keys) return key.keys.get();
  for (const auto& form : key.forms)
    if (form.keys) return form.keys.get();
  return nullptr;
}

const Keys& below(const Keys& keys, const std::string& path) {
  const auto dot = path.find('.');
  const auto* found = one_below(keys, path.substr(0, dot));
  if (found == nullptr) throw std::logic_error("no table \"" + path + "\" is declared");
  return dot == std::string::npos ? *found : below(*found, path.substr(dot + 1));
}

Found find(const Keys& keys, const std::string& name, const Value& table) {
  Found found;
  for (const auto& key : keys.list) {
    if (key.name != name) continue;
    const auto& with = key.conditions;
    const bool fits = with.empty() || std::any_of(with.begin(), with.end(),
                                                  [&](const With& one) { return holds(one, keys, table); });
    if (fits) return {&key, true};
    if (found.key == nullptr) found.key = &key;
  }
  if (found.key == nullptr && keys.named) return {keys.named.get(), true};
  return found;
}

std::vector<std::string> names_for(const Keys& keys, const Value& table) {
  std::set<std::string> names;
  for (const auto& key : keys.list)
    if (find(keys, key.name, table).fits) names.insert(key.name);
  return {names.begin(), names.end()};
}

std::string condition_of(const Key& key) {
  std::string all;
  for (const auto& with : key.conditions) {
    all += all.empty() ? "only " : ", or ";
    all += with.absent ? "without " : "with ";
    if (with.words.empty()) {
      all += with.key;
    } else {
      all += with.key + " = ";
      const std::string quote = with.words.front() == "true" ? "" : "\"";
      for (std::size_t i = 0; i < with.words.size(); ++i)
        all += std::string(i == 0                       ? ""
                           : i + 1 == with.words.size() ? " or "
                                                        : ", ") +
               quote + with.words[i] + quote;
    }
  }
  return all;
}

}  // namespace turnpoint::core

#include "station/core/reader.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <stdexcept>
#include <tuple>

#include "station/core/number.hpp"

namespace turnpoint::core {

Phrase describe(const Range& range) {
  using Ends = Range::Ends;
  const bool low_open = range.ends == Ends::open_low || range.ends == Ends::open;
  const bool high_open = range.ends == Ends::open_high || range.ends == Ends::open;
  const std::string unit = *range.unit ? std::string(" ") + range.unit : "";
  const auto low = plain(number(range.low)), high = plain(number(range.high) + unit);
  if (!std::isfinite(range.low) && !std::isfinite(range.high))
    return {"", "", {phrase("a finite number"), plain(unit)}};
  if (!std::isfinite(range.high))
    return phrase(low_open ? "above %1" : "at least %1", {plain(number(range.low) + unit)});
  if (!std::isfinite(range.low)) return phrase(high_open ? "below %1" : "at most %1", {high});
  if (range.ends == Ends::closed) return phrase("from %1 to %2", {low, high});
  if (low_open) return phrase(high_open ? "above %1 and below %2" : "above %1 and at most %2", {low, high});
  return phrase("at least %1 and below %2", {low, high});
}

bool inside_range(double value, const Range& range) {
  using Ends = Range::Ends;
  const bool low_open = range.ends == Ends::open_low || range.ends == Ends::open;
  const bool high_open = range.ends == Ends::open_high || range.ends == Ends::open;
  return std::isfinite(value) && (low_open ? value > range.low : value >= range.low) &&
         (high_open ? value < range.high : value <= range.high);
}

void Findings::add(const Place& place, Phrase what, Phrase allowed) {
  problems.push_back({place, std::move(what), std::move(allowed)});
}

void Findings::throw_if_any() {
  if (problems.empty()) return;
  std::stable_sort(problems.begin(), problems.end(), [](const Problem& a, const Problem& b) {
    return std::tie(a.place.line, a.place.column) < std::tie(b.place.line, b.place.column);
  });
  throw BadInput(std::move(problems));
}

std::string titled(const std::string& list, const Value& table) {
  const auto* name = table.find("name");
  return name && name->value.kind == Value::Kind::string ? list + "." + name->value.string : list;
}

Phrase quoted_list(const std::vector<std::string>& words) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto word = "\"" + words[i] + "\"";
    if (i > 0 && i + 1 == words.size()) return phrase("%1 or %2", {plain(list), plain(word)});
    list += (i > 0 ? ", " : "") + word;
  }
  return plain(list);
}

Phrase suggestion(const std::string& word, const std::vector<std::string>& known) {
  if (known.empty()) return phrase("nothing of this kind is defined in this file");
  std::string all;
  for (const auto& name : known) all += (all.empty() ? "" : ", ") + name;
  auto list = phrase("known: %1", {plain(all)});
  const auto near = nearest(word, known);
  return near.empty() ? list : phrase("did you mean \"%1\"? %2", {plain(near), std::move(list)});
}

TableReader::TableReader(const Value& table, std::string name, Findings& findings)
    : table_(&table), name_(std::move(name)), findings_(&findings) {}

TableReader::TableReader(const Value& table, std::string name, Findings& findings, const Keys& keys)
    : table_(&table), name_(std::move(name)), findings_(&findings), keys_(&keys) {}

const Key& TableReader::declared(const std::string& key) const {
  const auto found = keys_ != nullptr ? find(*keys_, key, *table_) : Found{};
  if (found.key == nullptr) throw std::logic_error("the key \"" + path(key) + "\" is not declared");
  return *found.key;
}

const Key& TableReader::declared(const std::string& key, Key::Kind kind) const {
  const auto& found = declared(key);
  if (found.kind == kind) return found;
  for (const auto& form : found.forms)
    if (form.kind == kind) return form;
  throw std::logic_error("the key \"" + path(key) + "\" is declared as another kind of value");
}

const Range& TableReader::range(const std::string& key) const {
  const auto& known = declared(key);
  for (const auto& form : known.forms)
    if (form.kind == Key::Kind::expression) return form.range;
  return known.range;
}
const std::vector<std::string>& TableReader::words(const std::string& key) const {
  return declared(key).words;
}
const Keys& TableReader::keys(const std::string& key) const {
  const auto* found = tables_of(declared(key));
  if (found == nullptr) throw std::logic_error("the key \"" + path(key) + "\" is declared as no table");
  return *found;
}

Phrase TableReader::needed(const Key& key) const {
  using Kind = Key::Kind;
  switch (key.kind) {
    case Kind::number:
      return phrase("a number %1", {describe(key.range)});
    case Kind::integer:
      return phrase("a whole number %1", {describe(key.range)});
    case Kind::word:
    case Kind::uri:
      return phrase("allowed: %1", {quoted_list(key.words)});
    case Kind::numbers:
    case Kind::integers:
      return phrase("a list of numbers %1", {describe(key.range)});
    case Kind::interval:
      return phrase("%1, %2: %3", {plain("[low, high]"), describe(key.range), plain(key.help)});
    case Kind::localised:
      return phrase("write a text in each language: %1", {plain("{ en = \"...\" }")});
    case Kind::texts:
      return phrase("a list of texts: %1", {plain(key.help)});
    case Kind::tables:
      return phrase("add tables %1: %2", {plain("[[" + path(key.name) + "]]"), plain(key.help)});
    case Kind::table:
      return phrase("add a table %1: %2", {plain("[" + path(key.name) + "]"), plain(key.help)});
    case Kind::several:
      return plain(key.help + ": " + values_of(key));
    default:
      return plain(key.help);
  }
}

Phrase TableReader::title() const { return name_.empty() ? phrase("the file") : plain("[" + name_ + "]"); }

std::string TableReader::path(const std::string& key) const {
  return name_.empty() ? key : name_ + "." + key;
}

Place TableReader::place(const std::string& key) const {
  const auto* entry = table_->find(key);
  return entry ? entry->value.place : table_->place;
}

void TableReader::problem(const std::string& key, const Phrase& what, const Phrase& allowed) {
  findings_->add(place(key), what, allowed);
}

void TableReader::defaulted(const std::string& key, const std::string& value) {
  findings_->defaults_used.push_back(path(key) + " = " + value);
}

const Value* TableReader::take(const std::string& key) {
  if (keys_ != nullptr) declared(key);  // throws if it is not declared
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
  const auto* entry = table_->find(key);
  return entry ? &entry->value : nullptr;
}

const Value* TableReader::require(const std::string& key, const Phrase& what) {
  const auto* value = take(key);
  if (!value) findings_->add(table_->place, phrase("%1 needs the key \"%2\"", {title(), plain(key)}), what);
  return value;
}

const Value* TableReader::require(const std::string& key) { return require(key, needed(declared(key))); }

bool TableReader::check_number(const Value& value, const std::string& key, const Range& range) {
  if (value.kind != Value::Kind::integer && value.kind != Value::Kind::number) {
    findings_->add(value.place, phrase("\"%1\" is %2", {plain(key), describe(value)}),
                   phrase("a number %1 is needed", {describe(range)}));
    return false;
  }
  const double x = value.number;
  if (inside_range(x, range)) return true;
  if (std::isinf(x) && x > 0 && keys_ != nullptr && declared(key).infinite) return true;
  const std::string shown = std::isnan(x)   ? "nan"
                            : std::isinf(x) ? (x < 0 ? "-inf" : "inf")
                                            : core::number(x);
  findings_->add(value.place, phrase("\"%1\" is %2", {plain(key), plain(shown)}),
                 phrase("allowed: %1", {describe(range)}));
  return false;
}

std::optional<double> TableReader::number_from(const Value* value, const std::string& key,
                                               const Range& range) {
  if (!value || !check_number(*value, key, range)) return std::nullopt;
  return value->number;
}

namespace {
// Returns a valid value to use instead of a wrong one that was reported, so that reading can continue. No
// session ever uses it.
double harmless(const Range& range) {
  if (std::isfinite(range.low) && std::isfinite(range.high)) return 0.5 * (range.low + range.high);
  if (std::isfinite(range.low)) return range.low + 1;
  return std::isfinite(range.high) ? range.high - 1 : 0;
}
}  // namespace

std::optional<double> TableReader::maybe_number(const std::string& key) {
  return maybe_number(key, declared(key, Key::Kind::number).range);
}

double TableReader::number(const std::string& key) {
  const auto& known = declared(key, Key::Kind::number);
  return known.fallback.empty() ? number(key, known.range)
                                : number(key, known.range, read_number(known.fallback).value());
}

double TableReader::number_or(const std::string& key, double fallback) {
  return number(key, declared(key, Key::Kind::number).range, fallback);
}

std::optional<int> TableReader::maybe_integer(const std::string& key) {
  const auto& range = declared(key, Key::Kind::integer).range;
  return maybe_integer(key, static_cast<int>(range.low), static_cast<int>(range.high));
}

int TableReader::integer(const std::string& key) {
  const auto& known = declared(key, Key::Kind::integer);
  const int low = static_cast<int>(known.range.low), high = static_cast<int>(known.range.high);
  return known.fallback.empty() ? integer(key, low, high)
                                : integer(key, low, high, std::stoi(known.fallback));
}

bool TableReader::boolean(const std::string& key) {
  return boolean(key, declared(key, Key::Kind::boolean).fallback.c_str());
}

std::string TableReader::string(const std::string& key) {
  const auto& known = declared(key);
  return string(key, needed(known));
}

std::optional<std::string> TableReader::maybe_word(const std::string& key) {
  return maybe_word(key, declared(key, Key::Kind::word).words);
}

std::string TableReader::word(const std::string& key) {
  const auto& known = declared(key, Key::Kind::word);
  return known.fallback.empty() ? word(key, known.words)
                                : word(key, known.words, known.fallback.substr(1, known.fallback.size() - 2));
}

namespace {
const Key& list_among(const Key& key) {
  for (const auto& form : key.forms)
    if (form.kind == Key::Kind::numbers) return form;
  return key;
}
}  // namespace

std::vector<double> TableReader::maybe_numbers(const std::string& key) {
  const auto& known = list_among(declared(key));
  return maybe_numbers(key, known.range, known.fewest);
}

std::vector<double> TableReader::numbers(const std::string& key) {
  const auto& known = list_among(declared(key));
  return numbers(key, known.range, known.fewest);
}

std::optional<std::pair<double, double>> TableReader::maybe_interval(const std::string& key) {
  return maybe_interval(key, declared(key, Key::Kind::interval).range);
}

std::vector<std::string> TableReader::strings(const std::string& key) {
  return strings(key, needed(declared(key)));
}

const Value* TableReader::table(const std::string& key) { return table(key, needed(declared(key))); }

std::optional<double> TableReader::maybe_number(const std::string& key, const Range& range) {
  return number_from(take(key), key, range);
}

double TableReader::number(const std::string& key, const Range& range) {
  const auto* value = require(key, phrase("a number %1", {describe(range)}));
  return number_from(value, key, range).value_or(harmless(range));
}

double TableReader::number(const std::string& key, const Range& range, double fallback) {
  const auto* value = take(key);
  if (!value) defaulted(key, core::number(fallback));
  return number_from(value, key, range).value_or(fallback);
}

std::optional<int> TableReader::maybe_integer(const std::string& key, int low, int high) {
  const auto* value = take(key);
  if (!value) return std::nullopt;
  const Range range{static_cast<double>(low), static_cast<double>(high)};
  if (value->kind != Value::Kind::integer) {
    findings_->add(value->place,
                   phrase("\"%1\" is %2",
                          {plain(key), value->kind == Value::Kind::number ? plain(core::number(value->number))
                                                                          : describe(*value)}),
                   phrase("a whole number %1 is needed", {describe(range)}));
    return std::nullopt;
  }
  if (!check_number(*value, key, range)) return std::nullopt;
  return static_cast<int>(value->integer);
}

int TableReader::integer(const std::string& key, int low, int high) {
  if (!has(key)) require(key, phrase("a whole number %1", {describe(Range{double(low), double(high)})}));
  return maybe_integer(key, low, high).value_or(low);
}

int TableReader::integer(const std::string& key, int low, int high, int fallback) {
  if (!has(key)) defaulted(key, std::to_string(fallback));
  return maybe_integer(key, low, high).value_or(fallback);
}

bool TableReader::boolean(const std::string& key, const char* fallback) {
  const auto* value = take(key);
  if (!value) {
    defaulted(key, fallback);
    return std::string(fallback) == "true";
  }
  if (value->kind == Value::Kind::boolean) return value->boolean;
  findings_->add(value->place, phrase("\"%1\" is %2", {plain(key), describe(*value)}),
                 phrase("allowed: true or false, without quotes"));
  return false;
}

namespace {

/// A pattern of a key is compiled once: compiling takes longer than reading the rest of a file.
const std::regex& compiled(const std::string& pattern) {
  thread_local std::map<std::string, std::regex> known;
  return known.try_emplace(pattern, pattern).first->second;
}

}  // namespace

std::optional<std::string> TableReader::maybe_string(const std::string& key) {
  const auto* value = take(key);
  if (!value) return std::nullopt;
  if (value->kind == Value::Kind::string && !value->string.empty()) {
    if (keys_ == nullptr) return value->string;
    const auto& known = declared(key);
    if (!known.pattern.empty() && !std::regex_match(value->string, compiled(known.pattern)))
      findings_->add(value->place, phrase("\"%1\" is \"%2\"", {plain(key), plain(value->string)}),
                     phrase("allowed: %1", {plain(known.form)}));
    return value->string;
  }
  findings_->add(value->place,
                 phrase("\"%1\" is %2",
                        {plain(key), value->kind == Value::Kind::string ? plain("empty") : describe(*value)}),
                 phrase("a text in quotes is needed"));
  return std::nullopt;
}

std::string TableReader::string(const std::string& key, const Phrase& what) {
  if (!has(key)) require(key, what);
  return maybe_string(key).value_or("");
}

std::optional<std::string> TableReader::maybe_word(const std::string& key,
                                                   const std::vector<std::string>& words) {
  const auto* value = take(key);
  if (!value) return std::nullopt;
  if (value->kind == Value::Kind::string &&
      std::find(words.begin(), words.end(), value->string) != words.end())
    return value->string;
  auto allowed = phrase("allowed: %1", {quoted_list(words)});
  const auto near = value->kind == Value::Kind::string ? nearest(value->string, words) : "";
  if (!near.empty()) allowed = phrase("did you mean \"%1\"? %2", {plain(near), std::move(allowed)});
  findings_->add(value->place, phrase("\"%1\" is %2", {plain(key), describe(*value)}), allowed);
  return std::nullopt;
}

std::string TableReader::word(const std::string& key, const std::vector<std::string>& words) {
  if (!has(key)) require(key, phrase("allowed: %1", {quoted_list(words)}));
  return maybe_word(key, words).value_or(words.front());
}

std::string TableReader::word(const std::string& key, const std::vector<std::string>& words,
                              const std::string& fallback) {
  if (!has(key)) defaulted(key, "\"" + fallback + "\"");
  return maybe_word(key, words).value_or(fallback);
}

std::vector<double> TableReader::maybe_numbers(const std::string& key, const Range& range,
                                               std::size_t at_least) {
  const auto* value = take(key);
  if (!value) return {};
  if (value->kind != Value::Kind::array) {
    findings_->add(value->place, phrase("\"%1\" is %2", {plain(key), describe(*value)}),
                   phrase("a list of numbers is needed: %1", {plain("[1.0, 2.0]")}));
    return {};
  }
  std::vector<double> list;
  for (const auto& item : value->items)
    if (check_number(item, key, range)) list.push_back(item.number);
  if (value->items.size() < at_least)
    findings_->add(value->place, phrase("\"%1\" has %2 values", {plain(key), plain(value->items.size())}),
                   phrase("at least %1 are needed", {plain(at_least)}));
  return list;
}

std::vector<double> TableReader::numbers(const std::string& key, const Range& range, std::size_t at_least) {
  if (!has(key)) require(key, phrase("a list of numbers %1", {describe(range)}));
  return maybe_numbers(key, range, at_least);
}

std::optional<std::pair<double, double>> TableReader::maybe_interval(const std::string& key,
                                                                     const Range& range) {
  const auto* value = take(key);
  if (!value) return std::nullopt;
  const auto before = findings_->problems.size();
  const auto list = maybe_numbers(key, range);
  if (findings_->problems.size() > before) return std::nullopt;
  if (list.size() == 2 && list[0] < list[1]) return std::pair{list[0], list[1]};
  findings_->add(value->place, phrase("\"%1\" is not a range", {plain(key)}),
                 phrase("two numbers are needed, the smaller first: %1", {plain("[low, high]")}));
  return std::nullopt;
}

std::vector<std::string> TableReader::maybe_strings(const std::string& key) {
  const auto* value = take(key);
  if (!value) return {};
  if (value->kind != Value::Kind::array) {
    findings_->add(value->place, phrase("\"%1\" is %2", {plain(key), describe(*value)}),
                   phrase("a list of texts is needed: %1", {plain("[\"a\", \"b\"]")}));
    return {};
  }
  std::vector<std::string> list;
  for (const auto& item : value->items) {
    if (item.kind == Value::Kind::string)
      list.push_back(item.string);
    else
      findings_->add(item.place, phrase("\"%1\" holds %2", {plain(key), describe(item)}),
                     phrase("a text in quotes is needed"));
  }
  return list;
}

std::vector<std::string> TableReader::strings(const std::string& key, const Phrase& what) {
  const auto* value = require(key, what);
  auto list = maybe_strings(key);
  if (value && value->kind == Value::Kind::array && value->items.empty())
    findings_->add(value->place, phrase("\"%1\" is an empty list", {plain(key)}), what);
  return list;
}

const Value* TableReader::maybe_table(const std::string& key) {
  const auto* value = take(key);
  if (!value || value->kind == Value::Kind::table) return value;
  findings_->add(value->place, phrase("\"%1\" is %2", {plain(key), describe(*value)}),
                 value->kind == Value::Kind::array
                     ? phrase("one table is needed: single brackets [%1]", {plain(key)})
                     : phrase("a table is needed: %1 or [%2]", {plain("{ ... }"), plain(key)}));
  return nullptr;
}

const Value* TableReader::table(const std::string& key, const Phrase& what) {
  if (!has(key)) require(key, what);
  return maybe_table(key);
}

std::vector<const Value*> TableReader::tables(const std::string& key) {
  const auto* value = take(key);
  if (!value) return {};
  if (value->kind != Value::Kind::array) {
    findings_->add(value->place, phrase("\"%1\" is %2", {plain(key), describe(*value)}),
                   phrase("a list of tables is needed: double brackets [[%1]]", {plain(key)}));
    return {};
  }
  std::vector<const Value*> list;
  for (const auto& item : value->items) {
    if (item.kind == Value::Kind::table)
      list.push_back(&item);
    else
      findings_->add(item.place, phrase("\"%1\" holds %2", {plain(key), describe(item)}),
                     phrase("a table %1 is needed", {plain("{ ... }")}));
  }
  return list;
}

Place TableReader::place_of_last(const std::vector<std::string>& names) const {
  Place last = table_->place;
  for (const auto& entry : table_->entries)
    if (std::find(names.begin(), names.end(), entry.key) != names.end()) last = entry.place;
  return last;
}

void TableReader::check_groups() {
  const auto count = [&](const std::vector<std::string>& names) {
    return std::count_if(names.begin(), names.end(), [&](const auto& name) { return has(name); });
  };
  for (const auto& names : keys_->exactly_one)
    if (const auto given = count(names); given != 1)
      findings_->add(given == 0 ? table_->place : place_of_last(names),
                     phrase("%1 has %2 of %3", {title(), plain(given), quoted_list(names)}),
                     phrase("give exactly one of them"));
  for (const auto& names : keys_->at_least_one)
    if (count(names) == 0)
      findings_->add(table_->place, phrase("%1 has none of %2", {title(), quoted_list(names)}),
                     phrase("give at least one of them"));
}

void TableReader::finish() {
  if (keys_ != nullptr) check_groups();
  for (const auto& entry : table_->entries) {
    const auto found = keys_ != nullptr ? find(*keys_, entry.key, *table_) : Found{};
    if (found.key != nullptr && !found.fits) {
      findings_->add(entry.place, phrase("\"%1\" has no effect in %2", {plain(entry.key), title()}),
                     plain(condition_of(*found.key)));
      continue;
    }
    if (std::find(known_.begin(), known_.end(), entry.key) != known_.end()) continue;
    if (found.key != nullptr && found.key != keys_->named.get()) {
      // Nothing may be accepted that is not read.
      if (findings_->problems.empty())
        throw std::logic_error("the key \"" + path(entry.key) + "\" is declared, but not read");
      continue;
    }
    auto known = keys_ != nullptr ? names_for(*keys_, *table_) : std::vector<std::string>{};
    known.insert(known.end(), known_.begin(), known_.end());
    std::sort(known.begin(), known.end());
    known.erase(std::unique(known.begin(), known.end()), known.end());
    findings_->add(entry.place, phrase("unknown key \"%1\" in %2", {plain(entry.key), title()}),
                   suggestion(entry.key, known));
  }
}

}  // namespace turnpoint::core

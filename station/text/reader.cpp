#include "station/text/reader.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "station/text/number.hpp"

namespace turnpoint::text {

using texts::phrase, texts::plain;

texts::Phrase describe(const Range& range) {
  using Ends = Range::Ends;
  const bool low_open = range.ends == Ends::open_low || range.ends == Ends::open;
  const bool high_open = range.ends == Ends::open_high || range.ends == Ends::open;
  const std::string unit = *range.unit ? std::string(" ") + range.unit : "";
  const auto low = plain(number(range.low)), high = plain(number(range.high) + unit);
  if (!std::isfinite(range.low) && !std::isfinite(range.high))
    return {"", "", {phrase("problem.finite"), plain(unit)}};
  if (!std::isfinite(range.high))
    return phrase(low_open ? "problem.above" : "problem.at_least", {plain(number(range.low) + unit)});
  if (!std::isfinite(range.low)) return phrase(high_open ? "problem.below" : "problem.at_most", {high});
  if (range.ends == Ends::closed) return phrase("problem.from_to", {low, high});
  if (low_open) return phrase(high_open ? "problem.above_below" : "problem.above_at_most", {low, high});
  return phrase("problem.at_least_below", {low, high});
}

bool inside_range(double value, const Range& range) {
  using Ends = Range::Ends;
  const bool low_open = range.ends == Ends::open_low || range.ends == Ends::open;
  const bool high_open = range.ends == Ends::open_high || range.ends == Ends::open;
  return std::isfinite(value) && (low_open ? value > range.low : value >= range.low) &&
         (high_open ? value < range.high : value <= range.high);
}

void Findings::add(const Place& place, texts::Phrase what, texts::Phrase allowed) {
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

texts::Phrase quoted_list(const std::vector<std::string>& words) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto word = "\"" + words[i] + "\"";
    if (i > 0 && i + 1 == words.size()) return phrase("problem.or", {plain(list), plain(word)});
    list += (i > 0 ? ", " : "") + word;
  }
  return plain(list);
}

texts::Phrase suggestion(const std::string& word, const std::vector<std::string>& known) {
  if (known.empty()) return phrase("problem.none_defined");
  std::string all;
  for (const auto& name : known) all += (all.empty() ? "" : ", ") + name;
  auto list = phrase("problem.known", {plain(all)});
  const auto near = nearest(word, known);
  return near.empty() ? list : phrase("problem.did_you_mean", {plain(near), std::move(list)});
}

TableReader::TableReader(const Value& table, std::string name, Findings& findings)
    : table_(&table), name_(std::move(name)), findings_(&findings) {}

texts::Phrase TableReader::title() const {
  return name_.empty() ? phrase("problem.the_file") : plain("[" + name_ + "]");
}

std::string TableReader::path(const std::string& key) const {
  return name_.empty() ? key : name_ + "." + key;
}

Place TableReader::place(const std::string& key) const {
  const auto* entry = table_->find(key);
  return entry ? entry->value.place : table_->place;
}

void TableReader::problem(const std::string& key, const texts::Phrase& what, const texts::Phrase& allowed) {
  findings_->add(place(key), what, allowed);
}

void TableReader::defaulted(const std::string& key, const std::string& value) {
  findings_->defaults_used.push_back(path(key) + " = " + value);
}

const Value* TableReader::take(const std::string& key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
  const auto* entry = table_->find(key);
  return entry ? &entry->value : nullptr;
}

const Value* TableReader::require(const std::string& key, const texts::Phrase& what) {
  const auto* value = take(key);
  if (!value) findings_->add(table_->place, phrase("problem.needs_key", {title(), plain(key)}), what);
  return value;
}

bool TableReader::check_number(const Value& value, const std::string& key, const Range& range) {
  if (value.kind != Value::Kind::integer && value.kind != Value::Kind::number) {
    findings_->add(value.place, phrase("problem.is", {plain(key), describe(value)}),
                   phrase("problem.number_needed", {describe(range)}));
    return false;
  }
  const double x = value.number;
  if (inside_range(x, range)) return true;
  const std::string shown = std::isnan(x)   ? "nan"
                            : std::isinf(x) ? (x < 0 ? "-inf" : "inf")
                                            : text::number(x);
  findings_->add(value.place, phrase("problem.is", {plain(key), plain(shown)}),
                 phrase("problem.allowed", {describe(range)}));
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

std::optional<double> TableReader::maybe_number(const std::string& key, const Range& range) {
  return number_from(take(key), key, range);
}

double TableReader::number(const std::string& key, const Range& range) {
  const auto* value = require(key, phrase("problem.number", {describe(range)}));
  return number_from(value, key, range).value_or(harmless(range));
}

double TableReader::number(const std::string& key, const Range& range, double fallback) {
  const auto* value = take(key);
  if (!value) defaulted(key, text::number(fallback));
  return number_from(value, key, range).value_or(fallback);
}

std::optional<int> TableReader::maybe_integer(const std::string& key, int low, int high) {
  const auto* value = take(key);
  if (!value) return std::nullopt;
  const Range range{static_cast<double>(low), static_cast<double>(high)};
  if (value->kind != Value::Kind::integer) {
    findings_->add(value->place,
                   phrase("problem.is",
                          {plain(key), value->kind == Value::Kind::number ? plain(text::number(value->number))
                                                                          : describe(*value)}),
                   phrase("problem.whole_needed", {describe(range)}));
    return std::nullopt;
  }
  if (!check_number(*value, key, range)) return std::nullopt;
  return static_cast<int>(value->integer);
}

int TableReader::integer(const std::string& key, int low, int high) {
  if (!has(key)) require(key, phrase("problem.whole", {describe(Range{double(low), double(high)})}));
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
  findings_->add(value->place, phrase("problem.is", {plain(key), describe(*value)}),
                 phrase("problem.true_false"));
  return false;
}

std::optional<std::string> TableReader::maybe_string(const std::string& key) {
  const auto* value = take(key);
  if (!value) return std::nullopt;
  if (value->kind == Value::Kind::string && !value->string.empty()) return value->string;
  findings_->add(
      value->place,
      phrase("problem.is",
             {plain(key), value->kind == Value::Kind::string ? phrase("problem.empty") : describe(*value)}),
      phrase("problem.text_needed"));
  return std::nullopt;
}

std::string TableReader::string(const std::string& key, const texts::Phrase& what) {
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
  auto allowed = phrase("problem.allowed", {quoted_list(words)});
  const auto near = value->kind == Value::Kind::string ? nearest(value->string, words) : "";
  if (!near.empty()) allowed = phrase("problem.did_you_mean", {plain(near), std::move(allowed)});
  findings_->add(value->place, phrase("problem.is", {plain(key), describe(*value)}), allowed);
  return std::nullopt;
}

std::string TableReader::word(const std::string& key, const std::vector<std::string>& words) {
  if (!has(key)) require(key, phrase("problem.allowed", {quoted_list(words)}));
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
    findings_->add(value->place, phrase("problem.is", {plain(key), describe(*value)}),
                   phrase("problem.numbers_needed", {plain("[1.0, 2.0]")}));
    return {};
  }
  std::vector<double> list;
  for (const auto& item : value->items)
    if (check_number(item, key, range)) list.push_back(item.number);
  if (value->items.size() < at_least)
    findings_->add(value->place, phrase("problem.has_values", {plain(key), plain(value->items.size())}),
                   phrase("problem.needed_at_least", {plain(at_least)}));
  return list;
}

std::vector<double> TableReader::numbers(const std::string& key, const Range& range, std::size_t at_least) {
  if (!has(key)) require(key, phrase("problem.numbers", {describe(range)}));
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
  findings_->add(value->place, phrase("problem.no_range", {plain(key)}),
                 phrase("problem.two_needed", {plain("[low, high]")}));
  return std::nullopt;
}

std::vector<std::string> TableReader::maybe_strings(const std::string& key) {
  const auto* value = take(key);
  if (!value) return {};
  if (value->kind != Value::Kind::array) {
    findings_->add(value->place, phrase("problem.is", {plain(key), describe(*value)}),
                   phrase("problem.texts_needed", {plain("[\"a\", \"b\"]")}));
    return {};
  }
  std::vector<std::string> list;
  for (const auto& item : value->items) {
    if (item.kind == Value::Kind::string)
      list.push_back(item.string);
    else
      findings_->add(item.place, phrase("problem.holds", {plain(key), describe(item)}),
                     phrase("problem.text_needed"));
  }
  return list;
}

std::vector<std::string> TableReader::strings(const std::string& key, const texts::Phrase& what) {
  const auto* value = require(key, what);
  auto list = maybe_strings(key);
  if (value && value->kind == Value::Kind::array && value->items.empty())
    findings_->add(value->place, phrase("problem.empty_list", {plain(key)}), what);
  return list;
}

const Value* TableReader::maybe_table(const std::string& key) {
  const auto* value = take(key);
  if (!value || value->kind == Value::Kind::table) return value;
  findings_->add(value->place, phrase("problem.is", {plain(key), describe(*value)}),
                 value->kind == Value::Kind::array
                     ? phrase("problem.one_table", {plain(key)})
                     : phrase("problem.table_needed", {plain("{ ... }"), plain(key)}));
  return nullptr;
}

const Value* TableReader::table(const std::string& key, const texts::Phrase& what) {
  if (!has(key)) require(key, what);
  return maybe_table(key);
}

std::vector<const Value*> TableReader::tables(const std::string& key) {
  const auto* value = take(key);
  if (!value) return {};
  if (value->kind != Value::Kind::array) {
    findings_->add(value->place, phrase("problem.is", {plain(key), describe(*value)}),
                   phrase("problem.tables_needed", {plain(key)}));
    return {};
  }
  std::vector<const Value*> list;
  for (const auto& item : value->items) {
    if (item.kind == Value::Kind::table)
      list.push_back(&item);
    else
      findings_->add(item.place, phrase("problem.holds", {plain(key), describe(item)}),
                     phrase("problem.inline_needed", {plain("{ ... }")}));
  }
  return list;
}

void TableReader::finish() {
  for (const auto& entry : table_->entries) {
    if (std::find(known_.begin(), known_.end(), entry.key) != known_.end()) continue;
    auto known = known_;
    std::sort(known.begin(), known.end());
    findings_->add(entry.place, phrase("problem.unknown_key", {plain(entry.key), title()}),
                   suggestion(entry.key, known));
  }
}

}  // namespace turnpoint::text

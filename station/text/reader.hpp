#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/text/toml.hpp"

namespace turnpoint::text {

/// The allowed range of a number in a file. `open` ends are excluded; the unit is only for messages ("mm").
struct Range {
  double low = 0, high = 0;
  enum class Ends { closed, open_low, open_high, open } ends = Ends::closed;
  const char* unit = "";
};

/// Describes a range for people: `from 0 to 1 mm`, `above 0 um`, ...
std::string describe(const Range& range);
/// True if the value is finite and within the range.
bool inside_range(double value, const Range& range);

/// Collects problems and the defaults that were used, so that a reader reports everything in one go.
struct Findings {
  std::vector<Problem> problems;
  std::vector<std::string> defaults_used;  ///< entries such as `timing.anticipation_s = 0`
  void add(const Place& place, std::string what, std::string allowed = "");
  /// Throws BadInput with the problems in file order, if there are any.
  void throw_if_any();
};

/// The title of a table in a list of tables, from its "name": `block.practice`.
std::string titled(const std::string& list, const Value& table);

/// Joins words: `"a", "b" or "c"`.
std::string quoted_list(const std::vector<std::string>& words);

/// Reads one table key by key. Each getter marks its key as known; finish() reports all other keys and
/// suggests the nearest known one. If a value has the wrong type or is out of range, the getter reports a
/// problem and returns a harmless value, so that reading can continue. The table must outlive the reader.
class TableReader {
 public:
  /// `name` is the dotted path for messages and defaults; empty for the whole file.
  TableReader(const Value& table, std::string name, Findings& findings);

  /// The raw value, marked as known; nullptr if absent.
  const Value* take(const std::string& key);
  /// The same, but an absent key is a problem. The message uses `what` to say what the key is.
  const Value* require(const std::string& key, const std::string& what);
  bool has(const std::string& key) const { return table_->find(key) != nullptr; }

  std::optional<double> maybe_number(const std::string& key, const Range& range);
  double number(const std::string& key, const Range& range);
  double number(const std::string& key, const Range& range, double fallback);

  std::optional<int> maybe_integer(const std::string& key, int low, int high);
  int integer(const std::string& key, int low, int high);
  int integer(const std::string& key, int low, int high, int fallback);

  bool boolean(const std::string& key, const char* fallback);  ///< fallback "true" or "false"

  std::optional<std::string> maybe_string(const std::string& key);
  std::string string(const std::string& key, const std::string& what);

  /// One of `words`. The fallback, if given, must be one of them too.
  std::optional<std::string> maybe_word(const std::string& key, const std::vector<std::string>& words);
  std::string word(const std::string& key, const std::vector<std::string>& words);
  std::string word(const std::string& key, const std::vector<std::string>& words,
                   const std::string& fallback);

  /// A list of at least `at_least` numbers within a range; empty if absent.
  std::vector<double> maybe_numbers(const std::string& key, const Range& range, std::size_t at_least = 1);
  std::vector<double> numbers(const std::string& key, const Range& range, std::size_t at_least = 1);
  /// A list of two numbers, the first below the second.
  std::optional<std::pair<double, double>> maybe_interval(const std::string& key, const Range& range);
  std::vector<std::string> maybe_strings(const std::string& key);
  std::vector<std::string> strings(const std::string& key, const std::string& what);

  /// A sub-table; nullptr if absent or not a table.
  const Value* maybe_table(const std::string& key);
  const Value* table(const std::string& key, const std::string& what);
  /// The tables of `[[key]]`; empty if absent.
  std::vector<const Value*> tables(const std::string& key);

  /// Reports a problem with this key's value (or with the table if the key is absent).
  void problem(const std::string& key, const std::string& what, const std::string& allowed = "");
  /// Records that the default `key = value` was used because the key is absent.
  void defaulted(const std::string& key, const std::string& value);
  /// This table in messages: `[timing]`, or `the file`.
  std::string title() const;
  std::string path(const std::string& key) const;
  const Place& place() const { return table_->place; }
  /// The place of the key's value, or of the table if the key is absent.
  Place place(const std::string& key) const;
  Findings& findings() { return *findings_; }

  /// Reports unknown keys. Call once, after the last getter.
  void finish();

 private:
  bool check_number(const Value& value, const std::string& key, const Range& range);
  std::optional<double> number_from(const Value* value, const std::string& key, const Range& range);

  const Value* table_;
  std::string name_;
  Findings* findings_;
  std::vector<std::string> known_;
};

}  // namespace turnpoint::text

#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/text/toml.hpp"

namespace turnpoint::text {

/// What a number in a file may be. `open` ends are excluded; the unit is for messages only ("mm").
struct Range {
  double low = 0, high = 0;
  enum class Ends { closed, open_low, open_high, open } ends = Ends::closed;
  const char* unit = "";
};

/// `from 0 to 1 mm`, `above 0 um`, ...: a range for people.
std::string describe(const Range& range);
/// Finite and within the range.
bool inside_range(double value, const Range& range);

/// Collects problems and the defaults that stood in, so that a reader reports everything in one go.
struct Findings {
  std::vector<Problem> problems;
  std::vector<std::string> defaults_used;  ///< `timing.anticipation_s = 0`
  void add(const Place& place, std::string what, std::string allowed = "");
  /// Throws BadInput, problems in file order, if there is any.
  void throw_if_any();
};

/// `block.practice`: the title of a table in a list of tables, from its "name".
std::string titled(const std::string& list, const Value& table);

/// `"a", "b" or "c"`.
std::string quoted_list(const std::vector<std::string>& words);

/// Reads one table key by key. Each getter marks its key as known; finish() reports the keys that nobody
/// asked for with the nearest known one. A value of the wrong kind or outside its range is a problem, and the
/// getter then returns a harmless value, so that reading goes on. The table must outlive the reader.
class TableReader {
 public:
  /// `name` is the dotted path for messages and defaults; empty for the whole file.
  TableReader(const Value& table, std::string name, Findings& findings);

  /// The raw value, marked as known; nullptr where absent.
  const Value* take(const std::string& key);
  /// The same; absence is a problem that says what the key is (`what`).
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

  /// One of `words`; the fallback, where given, is one of them too.
  std::optional<std::string> maybe_word(const std::string& key, const std::vector<std::string>& words);
  std::string word(const std::string& key, const std::vector<std::string>& words);
  std::string word(const std::string& key, const std::vector<std::string>& words,
                   const std::string& fallback);

  /// A list of numbers in range with at least `at_least` of them; empty where absent.
  std::vector<double> maybe_numbers(const std::string& key, const Range& range, std::size_t at_least = 1);
  std::vector<double> numbers(const std::string& key, const Range& range, std::size_t at_least = 1);
  /// A list of two numbers, the first below the second.
  std::optional<std::pair<double, double>> maybe_interval(const std::string& key, const Range& range);
  std::vector<std::string> maybe_strings(const std::string& key);
  std::vector<std::string> strings(const std::string& key, const std::string& what);

  /// A sub-table; nullptr where absent or not a table.
  const Value* maybe_table(const std::string& key);
  const Value* table(const std::string& key, const std::string& what);
  /// The tables of `[[key]]`; empty where absent.
  std::vector<const Value*> tables(const std::string& key);

  /// A problem about this key's value (or the table where it is absent).
  void problem(const std::string& key, const std::string& what, const std::string& allowed = "");
  /// Records that `key = value` stood in for an absent key.
  void defaulted(const std::string& key, const std::string& value);
  /// `[timing]`, or `the file`: this table in messages.
  std::string title() const;
  std::string path(const std::string& key) const;
  const Place& place() const { return table_->place; }
  /// Where the key's value stands; the table's place where it is absent.
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

#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/text/toml.hpp"

namespace turnpoint::text {

/// The allowed range of a number in a file. `ends` says which ends are excluded (open). The unit appears only
/// in messages ("mm").
struct Range {
  double low = 0, high = 0;
  enum class Ends { closed, open_low, open_high, open } ends = Ends::closed;
  const char* unit = "";
};

/// Describes a range for people: `from 0 to 1 mm`, `above 0 um`, ...
texts::Phrase describe(const Range& range);
/// True if the value is finite and within the range.
bool inside_range(double value, const Range& range);

/// Collects problems, so that a reader can report all of them at once, and the defaults that were used.
struct Findings {
  std::vector<Problem> problems;
  std::vector<std::string> defaults_used;  ///< entries such as `timing.anticipation_s = 0`
  void add(const Place& place, texts::Phrase what, texts::Phrase allowed = {});
  /// Throws BadInput with the problems in file order, if there are any.
  void throw_if_any();
};

/// Returns the title of a table in a list of tables: `block.practice` for the `block` with the name
/// "practice".
std::string titled(const std::string& list, const Value& table);

/// Joins words as `"a", "b" or "c"`.
texts::Phrase quoted_list(const std::vector<std::string>& words);

/// Says which of the known words `word` was probably meant to be: `did you mean "x"? known: a, b, c`.
texts::Phrase suggestion(const std::string& word, const std::vector<std::string>& known);

/// Reads one table key by key. Each getter marks its key as known; finish() reports all other keys and
/// suggests the nearest known key for each. If a value has the wrong type or is out of range, the getter
/// reports a problem and returns a valid value instead, so that reading can continue. The table must outlive
/// the reader.
class TableReader {
 public:
  /// `name` is the dotted path that appears in messages and in the list of defaults; "" for the whole file.
  TableReader(const Value& table, std::string name, Findings& findings);

  /// Returns the raw value and marks the key as known; nullptr if the key is absent.
  const Value* take(const std::string& key);
  /// Like take(), but reports a problem if the key is absent. `what` is the part of the message that says
  /// what the key is for.
  const Value* require(const std::string& key, const texts::Phrase& what);
  bool has(const std::string& key) const { return table_->find(key) != nullptr; }

  std::optional<double> maybe_number(const std::string& key, const Range& range);
  double number(const std::string& key, const Range& range);
  double number(const std::string& key, const Range& range, double fallback);

  std::optional<int> maybe_integer(const std::string& key, int low, int high);
  int integer(const std::string& key, int low, int high);
  int integer(const std::string& key, int low, int high, int fallback);

  bool boolean(const std::string& key, const char* fallback);  ///< `fallback` is "true" or "false"

  std::optional<std::string> maybe_string(const std::string& key);
  std::string string(const std::string& key, const texts::Phrase& what);

  /// Reads one of the given words. The fallback, if given, must be one of these words too.
  std::optional<std::string> maybe_word(const std::string& key, const std::vector<std::string>& words);
  std::string word(const std::string& key, const std::vector<std::string>& words);
  std::string word(const std::string& key, const std::vector<std::string>& words,
                   const std::string& fallback);

  /// Reads a list of at least `at_least` numbers within a range; empty if the key is absent.
  std::vector<double> maybe_numbers(const std::string& key, const Range& range, std::size_t at_least = 1);
  std::vector<double> numbers(const std::string& key, const Range& range, std::size_t at_least = 1);
  /// Reads a list of two numbers, of which the first must be the smaller.
  std::optional<std::pair<double, double>> maybe_interval(const std::string& key, const Range& range);
  std::vector<std::string> maybe_strings(const std::string& key);
  std::vector<std::string> strings(const std::string& key, const texts::Phrase& what);

  /// Returns a sub-table; nullptr if the key is absent or not a table.
  const Value* maybe_table(const std::string& key);
  const Value* table(const std::string& key, const texts::Phrase& what);
  /// Returns the tables of `[[key]]`; empty if the key is absent.
  std::vector<const Value*> tables(const std::string& key);

  /// Reports a problem with this key's value (or with the table if the key is absent).
  void problem(const std::string& key, const texts::Phrase& what, const texts::Phrase& allowed = {});
  /// Records that `key` is absent and that its default `value` was used.
  void defaulted(const std::string& key, const std::string& value);
  /// Returns this table's name for messages: `[timing]`, or `the file`.
  texts::Phrase title() const;
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

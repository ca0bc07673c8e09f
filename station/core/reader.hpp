#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/core/keys.hpp"
#include "station/core/range.hpp"
#include "station/core/toml.hpp"

namespace turnpoint::core {

/// Collects problems, so that a reader can report all of them at once, and the defaults that were used.
struct Findings {
  std::vector<Problem> problems;
  std::vector<std::string> defaults_used;  ///< entries such as `timing.anticipation_s = 0`
  void add(const Place& place, Phrase what, Phrase allowed = {});
  /// Throws BadInput with the problems in file order, if there are any.
  void throw_if_any();
};

/// Returns the title of a table in a list of tables: `block.practice` for the `block` with the name
/// "practice".
std::string titled(const std::string& list, const Value& table);

/// Joins words as `"a", "b" or "c"`.
Phrase quoted_list(const std::vector<std::string>& words);

/// Says which of the known words `word` was probably meant to be: `did you mean "x"? known: a, b, c`.
Phrase suggestion(const std::string& word, const std::vector<std::string>& known);

/// Reads one table key by key. What the keys are is declared in `keys`; a getter takes range, words, default
/// and whether the key is needed from there, and throws std::logic_error for a key that is not declared. If a
/// value has the wrong type or is out of range, the getter reports a problem and returns a valid value
/// instead, so that reading can continue. finish() reports all keys that are not declared or have no effect
/// here, and suggests the nearest. The table and the keys must outlive the reader.
///
/// Getters with a range are for limits that depend on other values of the file, and number_or() is for
/// defaults that do. Without `keys`, all getters take what they allow, and a getter marks its key as known.
class TableReader {
 public:
  /// `name` is the dotted path that appears in messages and in the list of defaults; "" for the whole file.
  TableReader(const Value& table, std::string name, Findings& findings, const Keys& keys);
  TableReader(const Value& table, std::string name, Findings& findings);

  /// Returns the raw value and marks the key as known; nullptr if the key is absent.
  const Value* take(const std::string& key);
  /// Like take(), but reports a problem if the key is absent. `what` is the part of the message that says
  /// what the key is for.
  const Value* require(const std::string& key, const Phrase& what);
  const Value* require(const std::string& key);
  bool has(const std::string& key) const { return table_->find(key) != nullptr; }

  std::optional<double> maybe_number(const std::string& key);
  double number(const std::string& key);
  double number_or(const std::string& key, double fallback);
  std::optional<int> maybe_integer(const std::string& key);
  int integer(const std::string& key);
  bool boolean(const std::string& key);
  std::string string(const std::string& key);
  std::optional<std::string> maybe_word(const std::string& key);
  std::string word(const std::string& key);
  std::vector<double> maybe_numbers(const std::string& key);
  std::vector<double> numbers(const std::string& key);
  std::optional<std::pair<double, double>> maybe_interval(const std::string& key);
  std::vector<std::string> strings(const std::string& key);
  const Value* table(const std::string& key);
  /// The declared range and words of a key, and the keys of the table that it is.
  const Range& range(const std::string& key) const;
  const std::vector<std::string>& words(const std::string& key) const;
  const Keys& keys(const std::string& key) const;
  /// The declaration of a key that applies to this table.
  const Key& declared(const std::string& key) const;

  std::optional<double> maybe_number(const std::string& key, const Range& range);
  double number(const std::string& key, const Range& range);
  double number(const std::string& key, const Range& range, double fallback);

  std::optional<int> maybe_integer(const std::string& key, int low, int high);
  int integer(const std::string& key, int low, int high);
  int integer(const std::string& key, int low, int high, int fallback);

  bool boolean(const std::string& key, const char* fallback);  ///< `fallback` is "true" or "false"

  std::optional<std::string> maybe_string(const std::string& key);
  std::string string(const std::string& key, const Phrase& what);

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
  std::vector<std::string> strings(const std::string& key, const Phrase& what);

  /// Returns a sub-table; nullptr if the key is absent or not a table.
  const Value* maybe_table(const std::string& key);
  const Value* table(const std::string& key, const Phrase& what);
  /// Returns the tables of `[[key]]`; empty if the key is absent.
  std::vector<const Value*> tables(const std::string& key);

  /// Reports a problem with this key's value (or with the table if the key is absent).
  void problem(const std::string& key, const Phrase& what, const Phrase& allowed = {});
  /// Records that `key` is absent and that its default `value` was used.
  void defaulted(const std::string& key, const std::string& value);
  /// Returns this table's name for messages: `[timing]`, or `the file`.
  Phrase title() const;
  std::string path(const std::string& key) const;
  const Place& place() const { return table_->place; }
  /// The place of the key's value, or of the table if the key is absent.
  Place place(const std::string& key) const;
  Findings& findings() { return *findings_; }

  /// Reports unknown keys. Call once, after the last getter.
  void finish();

 private:
  const Key& declared(const std::string& key, Key::Kind kind) const;
  Phrase needed(const Key& key) const;
  void check_groups();
  Place place_of_last(const std::vector<std::string>& names) const;
  bool check_number(const Value& value, const std::string& key, const Range& range);
  std::optional<double> number_from(const Value* value, const std::string& key, const Range& range);

  const Value* table_;
  std::string name_;
  Findings* findings_;
  const Keys* keys_ = nullptr;
  std::vector<std::string> known_;
};

}  // namespace turnpoint::core

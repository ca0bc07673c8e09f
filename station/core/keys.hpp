#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "station/core/range.hpp"
#include "station/core/toml.hpp"

// What the keys of a file that people write are: declared once, in one table for each format. From it follow
// what TableReader accepts and advises, the JSON schema for editors, the reference tables of the pages, and
// the designer's form.
namespace turnpoint::core {

struct Keys;

/// A condition on another key of the same table.
struct With {
  std::string key;
  /// Words of which the key must have one; one that ends in ':' also stands for what begins with it. Without
  /// words, the key must be there, or must not be there if `absent` is set.
  std::vector<std::string> words = {};
  bool absent = false;
};

/// One key of a table.
struct Key {
  enum class Kind {
    number,
    integer,
    boolean,
    text,
    word,        ///< one of `words`
    uri,         ///< one of the forms in `words`, such as `sim:` or `alsa:DEVICE`
    numbers,     ///< a list
    integers,    ///< a list without repetition
    interval,    ///< two numbers, the smaller first
    texts,       ///< a list of texts, of `words` if there are any
    expression,  ///< a number, or linear arithmetic on factors in quotes
    localised,   ///< a text in each language
    table,       ///< `keys`
    tables,      ///< a list of tables
    list,        ///< a list of any of `forms`
    several,     ///< one of `forms`
    any
  };
  std::string name;
  Kind kind = Kind::any;
  std::string help;
  Range range = {};
  bool infinite = false;  ///< a number that may also be `inf`
  std::vector<std::string> words = {};
  std::string pattern = {};               ///< for a text: what it must match, as a regular expression
  std::string form = {};                  ///< the same in words
  std::string fallback = {};              ///< the default, as it is written in a file
  std::string otherwise = {};             ///< what holds without the key, if that is no value: in words
  bool needed = false;                    ///< whether its table must have this key
  std::size_t fewest = 0, most = 0;       ///< for lists: the number of values; 0: any
  std::vector<With> conditions = {};      ///< the key has an effect only if one of these holds
  std::shared_ptr<const Keys> keys = {};  ///< of a table, or of each table of a list
  std::vector<Key> forms = {};

  Key& required() { return needed = true, *this; }
  Key& by_default(std::string written) { return fallback = std::move(written), *this; }
  Key& without_it(std::string words_) { return otherwise = std::move(words_), *this; }
  Key& or_infinite() { return infinite = true, *this; }
  Key& matching(std::string expression, std::string in_words) {
    return pattern = std::move(expression), form = std::move(in_words), *this;
  }
  Key& holding(std::size_t at_least, std::size_t at_most = 0) {
    return fewest = at_least, most = at_most, *this;
  }
  Key& only_with(std::string key, std::vector<std::string> one_of = {}) {
    return conditions.push_back({std::move(key), std::move(one_of)}), *this;
  }
  Key& only_without(std::string key) { return conditions.push_back({std::move(key), {}, true}), *this; }
};

/// The keys of one table. A key may be declared several times under different conditions.
struct Keys {
  Keys() = default;
  Keys(std::initializer_list<Key> keys) : list(keys) {}

  std::vector<Key> list;
  std::vector<std::vector<std::string>> exactly_one = {};  ///< lists of keys of which the table has one
  std::vector<std::vector<std::string>> at_least_one = {};
  std::shared_ptr<const Key> named = {};  ///< what all keys are that the user names, as in [scene.NAME]
  std::size_t fewest = 0;                 ///< number of keys

  Keys& one_of(std::vector<std::string> names) { return exactly_one.push_back(std::move(names)), *this; }
  Keys& some_of(std::vector<std::string> names) { return at_least_one.push_back(std::move(names)), *this; }
  Keys& with_free_names(Key key) { return named = std::make_shared<const Key>(std::move(key)), *this; }
  Keys& holding(std::size_t at_least) { return fewest = at_least, *this; }
  Keys& and_also(const Keys& more) {
    list.insert(list.end(), more.list.begin(), more.list.end());
    return *this;
  }
};

/// Declarations of keys by the kind of their value.
namespace key {
Key number(std::string name, const Range& range, std::string help);
Key integer(std::string name, int low, int high, std::string help);
Key boolean(std::string name, std::string help);
Key string(std::string name, std::string help);
Key word(std::string name, std::vector<std::string> words, std::string help);
Key uri(std::vector<std::string> forms, std::string help);
Key numbers(std::string name, const Range& range, std::string help);
Key integers(std::string name, int low, int high, std::string help);
Key interval(std::string name, const Range& range, std::string help);
Key strings(std::string name, std::string help);
Key words(std::string name, std::vector<std::string> words, std::string help);
Key expression(std::string name, const Range& range, std::string help);
Key localised(std::string name, std::string help);
Key table(std::string name, Keys keys, std::string help);
Key tables(std::string name, Keys keys, std::string help);
Key list(std::string name, std::vector<Key> forms, std::string help);
Key several(std::string name, std::vector<Key> forms, std::string help);
Key any(std::string name, std::string help);
}  // namespace key

/// Whether two declarations say the same, apart from the conditions of the keys themselves.
bool alike(const Key& one, const Key& other);

/// The keys of the tables that a value of this key can be; nullptr if it can be none.
const Keys* tables_of(const Key& key);

/// The keys of a table below `keys`, such as `surface.taper`. Throws std::logic_error if none is declared.
const Keys& below(const Keys& keys, const std::string& path);

/// The declaration of `key` that applies to this table; nullptr if there is none. `fits` says whether its
/// condition holds.
struct Found {
  const Key* key = nullptr;
  bool fits = false;
};
Found find(const Keys& keys, const std::string& key, const Value& table);

/// The names of the keys that this table may have, sorted.
std::vector<std::string> names_for(const Keys& keys, const Value& table);

/// The condition under which a key has an effect: `only with kind = "tone"`; "" if there is none.
std::string condition_of(const Key& key);

/// What a value of this key can be, for people: `number from 0 to 1`.
std::string values_of(const Key& key);

/// The JSON schema of a format, for editors.
std::string json_schema(const Keys& keys, const std::string& title);

/// The reference tables of a format in Markdown, under a heading for each table of a file. Tables with the
/// same keys share one.
std::string reference(const Keys& keys);

}  // namespace turnpoint::core

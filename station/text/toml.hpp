#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "station/text/problem.hpp"

namespace turnpoint::text {

struct Entry;

/// One value of a TOML document and its place in the file. The keys of a table are in the order of the file,
/// although toml++ sorts them by name.
struct Value {
  enum class Kind { boolean, integer, number, string, date, array, table };
  Kind kind = Kind::table;
  Place place;
  bool boolean = false;
  std::int64_t integer = 0;
  double number = 0;           ///< also set for an integer
  std::string string;          ///< in UTF-8
  std::vector<Value> items;    ///< the values of an array
  std::vector<Entry> entries;  ///< the keys of a table, in file order

  /// Returns the entry of a table with this key, or nullptr.
  const Entry* find(const std::string& key) const;
};

/// One key of a table with its place and its value.
struct Entry {
  std::string key;
  Place place;
  Value value;
};

/// Parses `source`. `path` is the file name that messages show. Throws BadInput with the place of a
/// syntax error, of a list with more than 10 000 items, or of a key with more than 16 parts.
Value parse_toml(const std::string& source, const std::string& path);

/// Names the type of a value for messages: `a number`, `text`, `a table`, ...
texts::Phrase describe(const Value& value);

/// Size limit for files that people write (protocols, rigs, calibrations).
constexpr std::size_t most_text_bytes = 4 << 20;

/// Reads a file that people write. Throws BadInput if there is no such file or if it is longer than
/// `most_text_bytes`; other errors are those of system::read_file.
std::string read_text_file(const std::string& path);

/// Returns the text without the UTF-8 byte order mark that some programs put before it.
std::string_view without_byte_order_mark(std::string_view text);

}  // namespace turnpoint::text

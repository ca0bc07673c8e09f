#pragma once
#include <cstddef>
#include <cstdint>
#include <list>
#include <string>
#include <string_view>
#include <vector>

#include "station/core/problem.hpp"

namespace turnpoint::core {

struct Entry;

/// One value of a TOML document and its place in the file. The keys of a table are in the order of the file.
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

/// A range of bytes in the text of a file.
struct Span {
  std::size_t begin = 0, end = 0;
};

/// One key of a TOML file as it is written, with its place in the text. Items of arrays are parts too, named
/// "0", "1", ...
struct Part {
  enum class Kind {
    scalar,
    array,
    inline_table,
    table,  ///< has a header, such as [timing]
    /// a table without its own header: it consists of dotted keys, or only contains tables that have headers
    dotted,
    table_array  ///< a list of tables, such as [[block]]; its parts are these tables
  };
  Kind kind = Kind::scalar;
  std::string name;
  /// The key as written, such as `grid.slope`. For an item of an array, the value. For a table, its header.
  Span key;
  /// The range of the value. For a table with a header: from the header to the end of the line of the last
  /// key that belongs to the table itself.
  Span value;
  std::vector<Span> header_names;  ///< for a table with a header: where each name in the header is
  /// for a dotted table, its name below the header, such as `grid`; "" if it only contains tables that have
  /// headers
  std::string prefix;
  int line = 0;     ///< line of the key or header, from 1
  int section = 0;  ///< for a dotted table: how many headers come before it
  Place key_place;
  Value scalar;           ///< the value of a scalar; of other parts, only the place
  std::list<Part> parts;  ///< in the order of the file

  bool is_table() const { return kind == Kind::table || kind == Kind::dotted || kind == Kind::inline_table; }
  const Part* find(std::string_view name) const;
  Part* find(std::string_view name);
};

/// Reads TOML 1.0. Returns the table of the whole file, as it is written. `path` is the file name that
/// messages show. Throws BadInput with the place of the first mistake, of a list with more than 10 000 items,
/// a table with more than 10 000 keys, or a key with more than 16 parts.
Part parts_of(std::string_view source, const std::string& path);

/// Returns what a part says, without how it is written.
Value value_of(const Part& part);

/// Returns what a file says; throws like parts_of().
Value parse_toml(std::string_view source, const std::string& path);

/// Returns the offset of the end of the line that contains `at`, before its line break.
std::size_t line_end(std::string_view text, std::size_t at);

/// Names the type of a value for messages: `a number`, `text`, `a table`, ...
Phrase describe(const Value& value);

/// Size limit for files that people write (protocols, rigs, calibrations).
constexpr std::size_t most_text_bytes = 4 << 20;

/// Reads a file that people write. Throws BadInput if there is no such file or if it is longer than
/// `most_text_bytes`; other errors are those of core::read_file.
std::string read_text_file(const std::string& path);

/// The UTF-8 byte order mark, which some programs put before a text and by which spreadsheets know UTF-8.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
/// Returns the text without this mark.
std::string_view without_byte_order_mark(std::string_view text);

}  // namespace turnpoint::core

#pragma once
#include <cstddef>
#include <list>
#include <string>
#include <string_view>
#include <vector>

namespace turnpoint::design {

/// A range of bytes in the text of a file.
struct Span {
  std::size_t begin = 0, end = 0;
};

/// One key of a TOML file, with its place in the text. Items of arrays are parts too, named "0", "1", ...
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
  int line = 0;           ///< line of the key or header, from 1
  std::list<Part> parts;  ///< in the order of the file

  bool is_table() const { return kind == Kind::table || kind == Kind::dotted || kind == Kind::inline_table; }
  const Part* find(std::string_view name) const;
  Part* find(std::string_view name);
};

/// Finds all keys in a text that is valid TOML. Returns the table of the whole file.
Part parts_of(const std::string& text);

/// Returns the offset of the end of the line that contains `at`, before its line break.
std::size_t line_end(std::string_view text, std::size_t at);

}  // namespace turnpoint::design

#pragma once
#include <cstddef>
#include <list>
#include <string>
#include <string_view>
#include <vector>

namespace turnpoint::design {

/// A piece of the text of a file, as byte offsets.
struct Span {
  std::size_t begin = 0, end = 0;
};

/// One key of a TOML file, with its place in the text. Items of arrays are parts too, named "0", "1", ...
struct Part {
  enum class Kind {
    scalar,
    array,
    inline_table,
    table,       ///< has a header, such as [timing]
    dotted,      ///< a table without a header of its own: made by dotted keys, or by headers of tables in it
    table_array  ///< [[block]]: its parts are the tables
  };
  Kind kind = Kind::scalar;
  std::string name;
  /// The key as written, such as `grid.slope`. For an item of an array, the value. For a table, its header.
  Span key;
  /// The value. For a table with a header: from the header to the end of the line of its last own key.
  Span value;
  std::vector<Span> header_names;  ///< the names in the header
  std::string prefix;     ///< dotted: its name below the header, such as `grid`; "" if made by headers
  int line = 0;           ///< of the key or header, from 1
  std::list<Part> parts;  ///< in the order of the file

  bool is_table() const { return kind == Kind::table || kind == Kind::dotted || kind == Kind::inline_table; }
  const Part* find(std::string_view name) const;
  Part* find(std::string_view name);
};

/// Finds all keys of a text that is valid TOML. The result is the table of the whole file.
Part parts_of(const std::string& text);

/// Offset of the end of the line at `at`, before its line break.
std::size_t line_end(std::string_view text, std::size_t at);

}  // namespace turnpoint::design

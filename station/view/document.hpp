#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "station/core/toml.hpp"

namespace turnpoint::view {

using core::Part, core::Span;

/// The path to a key, with indices for the items of lists: {"block", "0", "levels"}.
using Path = std::vector<std::string>;

/// A TOML text whose values can be changed one by one. A change returns the whole new text. Every byte that
/// does not belong to the changed key stays as it was: comments, order, blank lines, line breaks. Changes
/// throw std::logic_error for a path that they cannot use or where they cannot write the new value, and
/// core::BadInput if the new text would not be valid TOML.
class Document {
 public:
  /// Throws core::BadInput, with `file` as the name of the file, if the text is not valid TOML.
  Document(std::string text, std::string file);

  const std::string& text() const { return text_; }
  const std::string& file() const { return file_; }
  const Part& root() const { return root_; }
  /// Returns the part at this path; nullptr if there is none.
  const Part* find(const Path& path) const;
  /// Returns the value as it is written, without comments; "" if there is none.
  std::string written(const Path& path) const;
  /// Returns the path of the innermost part at this place. Lines and columns (characters) count from 1;
  /// without a column, the beginning of the line counts. Empty if no key is there.
  Path at(int line, int column = 0) const;

  /// Sets the value of a key; `value` is written as TOML. A key that does not exist yet is added after the
  /// other keys of its table, and missing tables are added too.
  std::string with(const Path& path, const std::string& value) const;
  /// Removes a key with its line, an item of a list, or a whole table.
  std::string without(const Path& path) const;
  /// Adds a copy of a table directly after it. A table of a list ([[block]]) gets this `name` as its key
  /// "name"; another table ([scene.edge]) gets it as the last part of its header.
  std::string with_copy(const Path& path, const std::string& name) const;
  /// Gives another name to a table that has its name in its header, such as [scene.edge].
  std::string with_name(const Path& path, const std::string& name) const;
  /// Lets two tables with headers change places, with the tables below them and the comments above and below
  /// them; or two items of a list, with their comments if each has lines for itself.
  std::string exchanged(const Path& first, const Path& second) const;
  /// Adds tables at the end of the text.
  std::string with_tables(const std::string& tables) const;

 private:
  std::string inserted(const Path& path, const std::string& value) const;
  /// An item of a list, or a header. `alone` says whether nothing else is in its lines but a comma and a
  /// comment.
  struct Item {
    Span value, line;
    Span above;    ///< the comments in the lines directly above it
    Span comment;  ///< what follows its comma, or the item, up to the end of the line
    bool comma = false, alone = false;
  };
  Item item_at(const Span& value) const;
  std::string inside_braces(const Part& table, const std::string& entry) const;
  std::string new_line_at(std::size_t at, const std::string& line) const;
  std::string checked(std::string text) const;
  std::string checked(std::string text, const Path& path) const;
  Span with_comments(const Path& path) const;

  std::string text_, file_, line_break_ = "\n";
  Part root_;
};

/// toml_string() writes a text as a TOML string, key_of() writes a name as a TOML key.
std::string toml_string(const std::string& text);
std::string key_of(const std::string& name);

}  // namespace turnpoint::view

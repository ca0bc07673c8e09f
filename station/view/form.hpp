#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/core/keys.hpp"
#include "station/core/problem.hpp"
#include "station/view/document.hpp"

namespace turnpoint::view {

/// One value that can be changed on a page, or one table below a group that can be added and removed.
struct Field {
  enum class Input {
    number,      ///< one number, or several separated by commas
    boolean,     ///< true or false
    word,        ///< one of `allowed`
    expression,  ///< a number or arithmetic on factors; or a word or a number
    text,
    names,  ///< texts separated by commas; two in a row are joined by an arrow
    name,   ///< the name of the table itself, which stands in its header
    table,  ///< a table, such as a zone or one page, with its fields after it; see extended() and reduced()
    list,   ///< a list of tables, such as pages; `value` is their number
    entry,  ///< a key that the user names, with its value: `start = 5`
    list_name,  ///< a name for one more list of tables: the parts of an interval
    written,    ///< a value as it is written in the file
  };
  Path path;
  Input input = Input::written;
  /// The forms in which the file can have this value, from the table of keys.
  std::vector<const core::Key*> forms = {};
  const core::Key* key = nullptr;  ///< the key itself, with its help; nullptr for a name
  bool present = false;            ///< whether the file has this key
  bool required = false;           ///< whether it is needed while the file has its table
  std::string value = {};  ///< as a person writes it: without quotes and brackets, items separated by commas
  std::vector<std::string> allowed = {};  ///< values to choose from
  bool closed = false;                    ///< whether nothing else than these can be chosen
  /// Whether what looks like a number is a text here: the file has texts, or the value refers to a text.
  bool of_texts = false;
  /// Whether another table gives the value if the file does not have it, so that the default does not hold.
  bool inherited = false;
  /// For a table: whether it can be removed, and whether it can change places with the one before it.
  bool removable = false, movable = false;
  std::size_t heading = 0;  ///< how many names of the path are those of the table above it on the page
  std::vector<std::size_t> remarks = {};  ///< indices into the remarks given to form_of()
};

/// The form fields of one table of a protocol file, such as [timing], [scene.edge], or one [[block]].
struct Group {
  Path path;
  std::string name;  ///< name of the scene, block, ...; "" for a table that a file has only once
  bool present = false;
  bool copied = false;  ///< whether it can be copied, because a file can have several of its kind
  bool removable = false;
  /// A part of the session, which can change places with the part before it (`earlier`) and after it
  /// (`later`).
  Path earlier = {}, later = {};
  std::vector<Field> fields = {};
  std::vector<std::size_t> remarks = {};  ///< indices of the remarks about the table as a whole
};

struct Section {
  /// name of the section: study, question, scenes, levels, blocks, timing or other
  std::string name;
  std::vector<std::string> added;  ///< the kinds of tables that can be added to it
  std::vector<Group> groups;
  std::size_t remarks = 0;  ///< number of remarks in this section
};

/// Everything in a protocol file that can be changed, in the order of the pages. Every declared key that has
/// an effect in its table is a field, whether the file has the key or not. What is not declared is not in the
/// form. `remarks` come from a check of the protocol; each is added to the field or group that it is about.
std::vector<Section> form_of(const Document& document, const std::vector<core::Problem>& remarks);

/// The text of a protocol without anything but its name.
std::string empty_study(const std::string& id);

/// A table of one of the kinds in Section::added as TOML, with texts in all languages of the file that are to
/// be changed, and a name that the file does not have.
std::string new_table(const Document& document, const std::string& kind);

/// The table whose names the values of a key refer to, such as "scene" for "base"; "" if they refer to none.
std::string referred_table(const std::string& key);

/// Writes what a person has typed into a field as TOML. Throws core::BadInput with what is allowed if the
/// field cannot have this value.
std::string encoded(const Field& field, const std::string& typed);

/// Returns the file's text with the typed value in this field. An empty `typed` removes the key if the file
/// need not have it. Another name of a table is also given to what refers to it, except for a factor's, which
/// expressions have.
std::string changed(const Document& document, const Field& field, const std::string& typed);

/// The file's text with the table of a field, or with one table more at the end of its list: a copy of the
/// last one.
std::string extended(const Document& document, const Field& field);
/// The file's text without the table of a field.
std::string reduced(const Document& document, const Field& field);
/// The file's text with the table of a field before the one that was before it in its list.
std::string moved_up(const Document& document, const Field& field);

/// The file's text with the part `from` of the session at the place of the part `to`; parts count from 0, in
/// the order of form_of().
std::string with_part_at(const Document& document, std::size_t from, std::size_t to);

}  // namespace turnpoint::view

#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/core/problem.hpp"
#include "station/view/document.hpp"
#include "station/view/schema.hpp"

namespace turnpoint::view {

/// One value that can be changed on a page.
struct Field {
  Path path;
  Rule::Kind kind = Rule::Kind::other;
  bool present = false;   ///< whether the file has this key
  bool required = false;  ///< whether its table must have this key
  std::string value;      ///< as a person writes it: without quotes and brackets, items separated by commas
  /// for the kind `word`: all possible values; for `names` and `texts`: values to choose from
  std::vector<std::string> allowed;
  std::optional<double> low, high;
  std::string help;
  std::vector<std::size_t> remarks;  ///< indices into the remarks given to form_of()
};

/// The form fields of one table of a protocol file, such as [timing], [scene.edge], or one [[block]].
struct Group {
  Path path;
  std::string name;  ///< name of the scene, block, ...; "" for a table that a file has only once
  bool present = false;
  bool copied = false;  ///< whether it can be copied, because a file can have several of its kind
  bool removable = false;
  /// A part of the session, which can change places with the part before it (`earlier`) and after it (`later`).
  Path earlier = {}, later = {};
  /// the list of tables below this one, such as the pages of an explanation; "" if it has none
  std::string below = {};
  std::size_t below_count = 0;
  std::vector<Field> fields = {};
  std::vector<std::size_t> remarks = {};  ///< indices of the remarks about the table as a whole
};

struct Section {
  /// name of the section: study, question, scenes, levels, blocks, timing or other
  std::string name;
  std::vector<Group> groups;
  std::size_t remarks = 0;  ///< number of remarks in this section
};

/// Everything in a protocol file that can be changed, in the order of the pages. Every key that the schema
/// allows in a table is a field of it, whether the file has the key or not. What the schema does not know is
/// not in the form. `remarks` come from a check of the protocol; each is added to the field or group that it
/// is about.
std::vector<Section> form_of(const Document& document, const Schema& schema,
                             const std::vector<core::Problem>& remarks);

/// The kinds of tables that a person can add to a session, in the order of the buttons.
constexpr const char* kAddedTables[] = {"consent", "explanation", "questionnaire", "screening"};
/// Such a table as TOML, with texts in all languages of the file that are to be changed, and a name that the file does
/// not have.
std::string new_table(const Document& document, const std::string& kind);
/// The file's text with one page of an explanation, or one item of a questionnaire, more or less at the end. A table has
/// at least one.
std::string with_one_more(const Document& document, const Group& group);
std::string with_one_less(const Document& document, const Group& group);

/// The table whose names the values of a key refer to, such as "scene" for "base"; "" if they refer to none.
std::string referred_table(const std::string& key);

/// Writes what a person has typed into a field as TOML. Throws core::BadInput with what is allowed if the
/// field cannot have this value.
std::string encoded(const Field& field, const std::string& typed);

/// Returns the file's text with the typed value in this field. An empty `typed` removes the key if the file
/// need not have it.
std::string changed(const Document& document, const Field& field, const std::string& typed);

}  // namespace turnpoint::view

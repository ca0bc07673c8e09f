#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/design/document.hpp"
#include "station/design/schema.hpp"
#include "station/text/problem.hpp"

namespace turnpoint::design {

/// One value that can be changed on a page.
struct Field {
  Path path;
  Rule::Kind kind = Rule::Kind::other;
  bool present = false;   ///< whether the file has this key
  bool required = false;  ///< whether its table must have it
  std::string value;      ///< as a person writes it: without quotes and brackets, items separated by commas
  std::vector<std::string> allowed;  ///< word: what it can be; names and texts: what can be chosen
  std::optional<double> low, high;
  std::string help;
  std::vector<std::size_t> remarks;  ///< indices into the remarks that the form was made with
};

/// The fields of one table: [timing], [scene.edge], or one [[block]].
struct Group {
  Path path;
  std::string name;  ///< of the scene, block, ...; "" for a table of which there is one
  bool present = false;
  bool copied = false;  ///< whether there can be another one of its kind
  bool removable = false;
  std::vector<Field> fields;
  std::vector<std::size_t> remarks;  ///< about the table as a whole
};

struct Section {
  /// study, question, scenes, levels, blocks, timing or other
  std::string name;
  std::vector<Group> groups;
  std::size_t remarks = 0;  ///< number of remarks in it
};

/// Everything in a protocol file that can be changed, in the order of the pages. Every key that the schema
/// allows in a table is a field of it, whether the file has the key or not. What the schema does not know is
/// not in the form. `remarks` are what a check says; each goes to its field.
std::vector<Section> form_of(const Document& document, const Schema& schema,
                             const std::vector<text::Problem>& remarks);

/// The table whose names the values of a key refer to, such as "scene" for "base"; "" if they refer to none.
std::string referred_table(const std::string& key);

/// Writes what a person has typed into a field as TOML. Throws text::BadInput with what is allowed if the
/// field cannot have this value.
std::string encoded(const Field& field, const std::string& typed);

/// The text in which a field has the typed value. An empty text removes a key that the file need not have.
std::string changed(const Document& document, const Field& field, const std::string& typed);

}  // namespace turnpoint::design

#pragma once
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "station/core/toml.hpp"

namespace turnpoint::view {

/// What the JSON schema for editors says about one key of a protocol file.
struct Rule {
  enum class Kind {
    text,
    number,
    integer,
    boolean,
    word,
    expression,
    numbers,
    names,
    texts,
    table,
    tables,
    other
  };
  Kind kind = Kind::other;
  std::vector<std::string> allowed;  ///< for the kinds `word` and `names`: the words that the schema lists
  std::optional<double> low, high;   ///< for the kinds of numbers: the limits, if the schema has them
  std::string help;                  ///< the schema's description; "" if it has none
  /// Keys of a table, or of each table of a list, in the order of the schema.
  struct Key;
  std::vector<Key> keys;
  /// true if the keys of the table are names that the user chooses, as in [scene]; `keys` then has one
  /// element, which stands for all of them
  bool any_key = false;
};
struct Rule::Key {
  std::string name;
  bool required = false;
  const nlohmann::ordered_json* schema = nullptr;
};

/// The schema for editors (protocols/protocol.schema.json), which says what keys a protocol can have.
class Schema {
 public:
  /// `source` is the text of the schema. Throws std::runtime_error if it is not a JSON object.
  explicit Schema(const std::string& source);

  Rule root() const { return rule(*json_); }
  /// The rule of a key. If the schema allows several forms, `value` chooses the one that fits it; without a
  /// value, the first one counts.
  Rule rule(const nlohmann::ordered_json& schema, const core::Value* value = nullptr) const;
  /// The rules of all forms that the schema allows for a key.
  std::vector<Rule> forms(const nlohmann::ordered_json& schema) const;

 private:
  Rule rule_of(const nlohmann::ordered_json& given, const nlohmann::ordered_json& form) const;
  const nlohmann::ordered_json& resolved(const nlohmann::ordered_json& schema) const;

  std::unique_ptr<const nlohmann::ordered_json> json_;
};

}  // namespace turnpoint::view

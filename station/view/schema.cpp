#include "station/view/schema.hpp"

#include <algorithm>
#include <stdexcept>

namespace turnpoint::view {

namespace {

using Json = nlohmann::ordered_json;
using ValueKind = core::Value::Kind;

bool fits(const Json& schema, const core::Value& value) {
  const auto type = schema.value("type", schema.contains("enum") || schema.contains("const") ? "string" : "");
  switch (value.kind) {
    case ValueKind::boolean:
      return type == "boolean";
    case ValueKind::integer:
      return type == "integer" || type == "number";
    case ValueKind::number:
      return type == "number";
    case ValueKind::string:
      return type == "string";
    case ValueKind::array:
      if (type != "array") return false;
      return value.items.empty() || !schema.contains("items") || fits(schema["items"], value.items.front());
    case ValueKind::table:
      return type == "object" &&
             std::all_of(value.entries.begin(), value.entries.end(), [&](const auto& entry) {
               return !schema.contains("properties") || schema["properties"].contains(entry.key);
             });
    default:
      return false;
  }
}

std::vector<std::string> words_of(const Json& schema) {
  std::vector<std::string> words;
  if (!schema.contains("enum")) return words;
  for (const auto& word : schema["enum"])
    if (word.is_string()) words.push_back(word);
  return words;
}

Rule::Kind kind_of_items(const Json& items) {
  const auto type = items.value("type", items.contains("enum") ? "string" : "");
  return type == "number" || type == "integer" ? Rule::Kind::numbers
         : type == "string"                    ? Rule::Kind::names
         : type == "object"                    ? Rule::Kind::tables
                                               : Rule::Kind::other;
}

void add_keys(const Json& schema, Rule& rule) {
  const auto required = schema.value("required", Json::array());
  if (const auto properties = schema.find("properties"); properties != schema.end())
    for (const auto& [name, below] : properties->items())
      rule.keys.push_back(
          {name, std::find(required.begin(), required.end(), name) != required.end(), &below});
  const auto more = schema.find("additionalProperties");
  if (more == schema.end() || !more->is_object()) return;
  rule.any_key = true;
  rule.keys.push_back({"", false, &*more});
}

bool is_linear(const Json& schema) { return schema.value("$ref", "") == "#/$defs/linear"; }

/// The forms among which the schema lets a file choose; nullptr if there is only one.
const Json* forms_in(const Json& schema) {
  for (const char* several : {"oneOf", "anyOf"})
    if (schema.contains(several) && !schema.contains("type")) return &schema[several];
  return nullptr;
}

}  // namespace

Schema::Schema(const std::string& source) {
  auto json = Json::parse(source, nullptr, false);
  if (!json.is_object()) throw std::runtime_error("the schema of protocols is not a JSON object");
  json_ = std::make_unique<const Json>(std::move(json));
}

const Json& Schema::resolved(const Json& schema) const {
  const auto* found = &schema;
  while (found->contains("$ref")) {
    const std::string ref = (*found)["$ref"];  // such as #/$defs/linear
    found = &json_->at("$defs").at(ref.substr(ref.rfind('/') + 1));
  }
  return *found;
}

Rule Schema::rule(const Json& given, const core::Value* value) const {
  const auto* schema = &resolved(given);
  if (const auto* forms = forms_in(*schema); forms != nullptr && !is_linear(given)) {
    const auto found = std::find_if(forms->begin(), forms->end(), [&](const Json& form) {
      return value == nullptr || fits(resolved(form), *value);
    });
    schema = &resolved(found == forms->end() ? forms->front() : *found);
  }
  return rule_of(given, *schema);
}

std::vector<Rule> Schema::forms(const Json& given) const {
  const auto* several = forms_in(resolved(given));
  if (several == nullptr || is_linear(given)) return {rule(given)};
  std::vector<Rule> rules;
  for (const auto& form : *several)
    for (auto& one : forms(form)) rules.push_back(std::move(one));
  return rules;
}

Rule Schema::rule_of(const Json& given, const Json& form) const {
  const auto& whole = resolved(given);
  Rule rule;
  rule.help = given.value("description", whole.value("description", ""));
  if (is_linear(given)) {
    rule.kind = Rule::Kind::expression;
    return rule;
  }
  const auto type = form.value("type", "");
  rule.allowed = words_of(form);
  if (form.contains("minimum")) rule.low = form["minimum"].get<double>();
  if (form.contains("exclusiveMinimum")) rule.low = form["exclusiveMinimum"].get<double>();
  if (form.contains("maximum")) rule.high = form["maximum"].get<double>();
  if (form.contains("exclusiveMaximum")) rule.high = form["exclusiveMaximum"].get<double>();
  if (!rule.allowed.empty()) {
    rule.kind = Rule::Kind::word;
  } else if (type == "array") {
    const auto* items = form.contains("items") ? &resolved(form["items"]) : &form;
    if (items->contains("anyOf") && !items->contains("type")) items = &resolved((*items)["anyOf"].front());
    rule.kind = kind_of_items(*items);
    rule.allowed = words_of(*items);
    if (rule.kind == Rule::Kind::tables) add_keys(*items, rule);
  } else if (type == "object") {
    rule.kind = given.value("$ref", "") == "#/$defs/texts" ? Rule::Kind::texts : Rule::Kind::table;
    add_keys(form, rule);
  } else {
    rule.kind = type == "number"    ? Rule::Kind::number
                : type == "integer" ? Rule::Kind::integer
                : type == "boolean" ? Rule::Kind::boolean
                : type == "string"  ? Rule::Kind::text
                                    : Rule::Kind::other;
  }
  return rule;
}

}  // namespace turnpoint::view

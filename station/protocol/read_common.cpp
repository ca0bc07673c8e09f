#include <algorithm>
#include <utility>

#include "station/core/number.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/reading.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

using core::TableReader;
using core::Value;

Localised localised_from(const core::Value& value, const std::string& key, const Reading& reading) {
  Localised texts;
  const auto& languages = reading.protocol.languages;
  auto& findings = reading.findings;
  const std::string example = "{ " + (languages.empty() ? "en" : languages.front()) + " = \"...\" }";
  if (value.kind != Value::Kind::table) {
    findings.add(value.place, phrase("\"%1\" is %2", {plain(key), describe(value)}),
                 phrase("write a text in each language: %1", {plain(example)}));
    return texts;
  }
  for (const auto& entry : value.entries) {
    if (std::find(languages.begin(), languages.end(), entry.key) == languages.end())
      findings.add(entry.place,
                   phrase("\"%1\" has a text in \"%2\", which is not a declared language",
                          {plain(key), plain(entry.key)}),
                   phrase("the languages declared in [protocol] are %1", {core::quoted_list(languages)}));
    else if (entry.value.kind != Value::Kind::string || entry.value.string.empty())
      findings.add(entry.value.place, phrase("\"%1\" is %2", {plain(key), describe(entry.value)}),
                   phrase("write a text in quotes"));
    else
      texts[entry.key] = entry.value.string;
  }
  for (const auto& language : languages)
    if (!value.find(language))
      findings.add(value.place, phrase("\"%1\" has no text in \"%2\"", {plain(key), plain(language)}),
                   phrase("write a text in every language that [protocol] declares"));
  return texts;
}

Localised read_localised(TableReader& reader, const std::string& key, const Reading& reading) {
  const auto* value = reader.require(key);
  return value ? localised_from(*value, key, reading) : Localised{};
}

std::optional<Linear> read_expression(TableReader& reader, const std::string& key, const Reading& reading) {
  const auto* value = reader.take(key);
  return value ? linear_from(*value, key, reader.range(key), reading.protocol.factors, reading.findings)
               : std::nullopt;
}

std::optional<Distribution> read_distribution(TableReader& reader, const std::string& key,
                                              const Reading& reading) {
  const auto* value = reader.take(key);
  if (!value) return std::nullopt;
  if (value->kind == Value::Kind::table) {
    TableReader inner(*value, reader.path(key), reader.findings(), reader.keys(key));
    inner.require("uniform");
    const auto interval = inner.maybe_interval("uniform");
    inner.finish();
    return interval ? std::optional(Distribution{interval->first, interval->second, {}}) : std::nullopt;
  }
  auto expression = read_expression(reader, key, reading);
  if (!expression) return std::nullopt;
  const auto [low, high] = bounds(*expression, reading.protocol.factors);
  if (expression->is_constant()) expression.reset();
  return Distribution{low, high, std::move(expression)};
}

using core::Value;

namespace {

std::string shown(const FactorValue& value) {
  const auto* number = std::get_if<double>(&value);
  return number ? core::number(*number) : "\"" + std::get<std::string>(value) + "\"";
}

}  // namespace

std::optional<FactorValue> read_factor_value(const core::Value& value, const Factor& factor,
                                             core::Findings& findings) {
  if (is_broken(factor)) return std::nullopt;
  const bool numeric = span(factor).has_value();
  const bool is_number = value.kind == Value::Kind::number || value.kind == Value::Kind::integer;
  if (numeric != is_number || (!numeric && value.kind != Value::Kind::string)) {
    findings.add(value.place, phrase("a value of \"%1\" is %2", {plain(factor.name), describe(value)}),
                 numeric ? phrase("write a number")
                         : phrase("write one of the names in the factor's list, in quotes"));
    return std::nullopt;
  }
  const FactorValue result = numeric ? FactorValue(value.number) : FactorValue(value.string);
  if (factor.range) {
    const core::Range range{factor.range->first, factor.range->second};
    if (core::inside_range(value.number, range)) return result;
    findings.add(value.place, phrase("\"%1\" is %2", {plain(factor.name), plain(core::number(value.number))}),
                 phrase("the factor's range is %1", {describe(range)}));
    return std::nullopt;
  }
  if (std::find(factor.levels.begin(), factor.levels.end(), result) != factor.levels.end()) return result;
  std::string levels;
  for (const auto& level : factor.levels) levels += (levels.empty() ? "" : ", ") + shown(level);
  findings.add(value.place, phrase("\"%1\" is %2", {plain(factor.name), plain(shown(result))}),
               phrase("the factor's levels are %1", {plain(levels)}));
  return std::nullopt;
}

const Factor* read_numeric_factor(TableReader& reader, const std::string& key, const Reading& reading) {
  const auto& factors = reading.protocol.factors;
  const auto name = reader.string(key);
  if (name.empty()) return nullptr;
  const auto* factor = find_factor(factors, name);
  if (!factor)
    reader.problem(key, phrase("unknown factor \"%1\"", {plain(name)}),
                   core::suggestion(name, names(factors)));
  else if (!span(*factor) && !is_broken(*factor))
    reader.problem(key, phrase("the factor \"%1\" has names as values, not numbers", {plain(name)}),
                   phrase("use a factor with a range or numeric levels"));
  return factor && (span(*factor) || is_broken(*factor)) ? factor : nullptr;
}

std::string read_scene_name(TableReader& reader, const std::string& key, const Reading& reading) {
  auto name = reader.string(key);
  const auto& known = reading.declared_scenes;
  if (reader.has(key) && std::find(known.begin(), known.end(), name) == known.end())
    reading.findings.add(reader.place(key), phrase("unknown scene \"%1\"", {plain(name)}),
                         core::suggestion(name, known));
  return name;
}

}  // namespace turnpoint::protocol

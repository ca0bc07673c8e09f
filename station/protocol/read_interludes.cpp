#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "station/core/number.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/interludes.hpp"
#include "station/protocol/reading.hpp"
#include "station/protocol/sources.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

using core::Range;
using core::TableReader;
using core::Value;

namespace {

constexpr std::size_t most_items = 200;

const std::string& plan_name(const std::variant<Block, Sequence>& part) {
  const auto* sequence = std::get_if<Sequence>(&part);
  return sequence ? sequence->name : block_of(part).name;
}

/// Finds the item that `name` refers to: either an earlier item of the same interlude, or QUESTIONNAIRE.ITEM.
/// Replaces `name` by the full name.
const Item* find_item(std::string& name, const Interlude& here, const Protocol& protocol) {
  for (const auto& item : here.items)
    if (item.id == name) {
      name = here.name + "." + name;
      return &item;
    }
  for (const auto& interlude : protocol.interludes)
    for (const auto& item : interlude.items)
      if (interlude.name + "." + item.id == name) return &item;
  return nullptr;
}

/// True if `name` is BLOCK.accuracy of a block that stands above this interlude.
bool is_score(const std::string& name, const Interlude& here, const Protocol& protocol) {
  for (std::size_t i = 0; i < here.above && i < protocol.plan.size(); ++i)
    if (plan_name(protocol.plan[i]) + ".accuracy" == name) return true;
  return false;
}

std::vector<std::string> known_names(const Interlude& here, const Protocol& protocol) {
  std::vector<std::string> names;
  for (const auto& item : here.items) names.push_back(item.id);
  for (const auto& interlude : protocol.interludes)
    for (const auto& item : interlude.items) names.push_back(interlude.name + "." + item.id);
  for (std::size_t i = 0; i < here.above && i < protocol.plan.size(); ++i)
    names.push_back(plan_name(protocol.plan[i]) + ".accuracy");
  return names;
}

std::string without_spaces(const std::string& text) {
  const auto from = text.find_first_not_of(" \t");
  return from == std::string::npos ? "" : text.substr(from, text.find_last_not_of(" \t") - from + 1);
}

/// Checks that the rule compares an answer with a value that the answer can have.
void check_value(const AnswerCondition& rule, const Item* item, const std::string& right,
                 core::Findings& findings) {
  const auto* number = std::get_if<double>(&rule.value);
  if (!item || item->value || item->rating) {
    const double low = item && item->value ? item->value->low : item ? 1 : 0;
    const double high = item && item->value ? item->value->high
                        : item              ? static_cast<double>(item->choices.size())
                                            : 1;
    if (!number || *number < low || *number > high)
      findings.add(rule.place,
                   phrase("\"%1\" compares a number with \"%2\"", {plain(rule.source), plain(right)}),
                   phrase("a number from %1 to %2", {plain(core::number(low)), plain(core::number(high))}));
    return;
  }
  std::vector<std::string> ids;
  for (const auto& choice : item->choices) ids.push_back(choice.id);
  if (rule.relation != Relation::equal)
    findings.add(rule.place, phrase("\"%1\" puts choices in an order", {plain(rule.source)}),
                 phrase("use %1", {plain("== or !=")}));
  else if (std::find(ids.begin(), ids.end(), right) == ids.end())
    findings.add(rule.place, phrase("\"%1\": there is no choice \"%2\"", {plain(rule.source), plain(right)}),
                 core::suggestion(right, ids));
}

void add_rule(const Value& value, const Interlude& here, const Reading& reading,
              std::vector<AnswerCondition>& rules) {
  static const std::vector<std::tuple<const char*, Relation, bool>> signs{
      {"==", Relation::equal, false},      {"!=", Relation::equal, true},
      {"<=", Relation::less_equal, false}, {">=", Relation::greater_equal, false},
      {"<", Relation::less, false},        {">", Relation::greater, false}};
  const auto example = phrase("write a comparison in quotes: %1 or %2",
                              {plain("\"age >= 18\""), plain("\"practice.accuracy >= 0.8\"")});
  if (value.kind != Value::Kind::string)
    return reading.findings.add(value.place, phrase("a rule is %1", {describe(value)}), example);
  for (const auto& [sign, relation, unequal] : signs) {
    const auto at = value.string.find(sign);
    if (at == std::string::npos) continue;
    AnswerCondition rule;
    rule.about = without_spaces(value.string.substr(0, at));
    rule.relation = relation, rule.unequal = unequal;
    rule.source = value.string, rule.place = value.place;
    const auto right = without_spaces(value.string.substr(at + std::string(sign).size()));
    const auto* item = find_item(rule.about, here, reading.protocol);
    if (!item && !is_score(rule.about, here, reading.protocol))
      return reading.findings.add(value.place, phrase("nothing above is called \"%1\"", {plain(rule.about)}),
                                  core::suggestion(rule.about, known_names(here, reading.protocol)));
    const auto number = core::read_number(right);
    const bool numeric = !item || item->value || item->rating;
    rule.value = numeric && number ? FactorValue(*number) : FactorValue(right);
    check_value(rule, item, right, reading.findings);
    rules.push_back(std::move(rule));
    return;
  }
  reading.findings.add(value.place, phrase("\"%1\" is not a comparison", {plain(value.string)}), example);
}

std::vector<AnswerCondition> read_rules(TableReader& reader, const std::string& key, const Interlude& here,
                                        const Reading& reading) {
  std::vector<AnswerCondition> rules;
  const auto* value = reader.take(key);
  if (!value) return rules;
  if (value->kind != Value::Kind::array)
    add_rule(*value, here, reading, rules);
  else
    for (const auto& one : value->items) add_rule(one, here, reading, rules);
  return rules;
}

void read_simulated(TableReader& reader, Item& item, const Reading& reading) {
  const auto* value = reader.take("simulated");
  if (!value) return;
  const bool number = value->kind == Value::Kind::number || value->kind == Value::Kind::integer;
  const auto is = [&](const Choice& choice) { return choice.id == value->string; };
  if (item.value && number && value->number >= item.value->low && value->number <= item.value->high)
    item.simulated = value->number;
  else if (item.rating && number && value->number >= 1 &&
           value->number <= static_cast<double>(item.choices.size()) &&
           value->number == std::floor(value->number))
    item.simulated = value->number;
  else if (!item.value && !item.rating && value->kind == Value::Kind::string &&
           std::any_of(item.choices.begin(), item.choices.end(), is))
    item.simulated = value->string;
  else
    reading.findings.add(value->place, phrase("\"%1\" is %2", {plain("simulated"), describe(*value)}),
                         phrase("an answer that the item allows"));
}

Item read_item(const Value& table, const Interlude& here, const std::string& path, const Reading& reading) {
  TableReader reader(table, path, reading.findings, keys_of("questionnaire.item"));
  Item item;
  item.place = reader.place("id");
  item.id = reader.string("id");
  item.question = read_localised(reader, "question", reading);
  item.choices = read_choice_list(reader, path + ".choices", reading);
  if (reader.has("choices") && (item.choices.size() < 2 || item.choices.size() > most_choices))
    reader.problem("choices", phrase("\"%1\" has %2", {plain("choices"), plain(item.choices.size())}),
                   phrase("from %1 to %2", {plain("2"), plain("9")}));
  if (const auto* rating = reader.maybe_table("rating")) {
    auto scale = read_scale(*rating, reader.path("rating"), reading);
    item.rating = !scale.choices.empty();
    if (item.rating) item.choices = std::move(scale.choices);
    item.anchors = std::move(scale.anchors);
    item.value = std::move(scale.value);
  }
  if (const auto* number = reader.maybe_table("number")) {
    TableReader inner(*number, reader.path("number"), reading.findings, reader.keys("number"));
    item.value = read_typed(inner);
    inner.finish();
  }
  item.when = read_rules(reader, "when", here, reading);
  read_simulated(reader, item, reading);
  reader.finish();
  return item;
}

void read_items(TableReader& reader, Interlude& interlude, const Reading& reading) {
  reader.require("item");
  const auto tables = reader.tables("item");
  if (tables.size() > most_items)
    return reader.problem("item",
                          phrase("\"%1\" has %2 items", {plain(interlude.name), plain(tables.size())}),
                          phrase("at most %1", {plain(most_items)}));
  for (const auto* table : tables) {
    auto item = read_item(*table, interlude, reader.path("item"), reading);
    const auto same = [&](const Item& other) { return other.id == item.id; };
    if (!item.id.empty() && std::any_of(interlude.items.begin(), interlude.items.end(), same))
      reading.findings.add(item.place,
                           phrase("there is already an item with the id \"%1\"", {plain(item.id)}),
                           phrase("each item of a questionnaire needs a different id"));
    interlude.items.push_back(std::move(item));
  }
}

void read_consent(TableReader& reader, Interlude& interlude, const Reading& reading) {
  Item item;
  item.place = reader.place();
  item.id = "consent";
  item.question = read_localised(reader, "text", reading);
  item.choices = {{"agree", read_localised(reader, "agree", reading)},
                  {"refuse", read_localised(reader, "refuse", reading)}};
  item.simulated = "agree";
  interlude.items.push_back(std::move(item));
  interlude.farewell = read_localised(reader, "farewell", reading);
}

Example read_example(const Value& table, const std::string& path, const Reading& reading) {
  TableReader reader(table, path, reading.findings, keys_of("explanation.page.examples"));
  Example example;
  example.label = read_localised(reader, "label", reading);
  example.scene = read_scene_name(reader, "scene", reading);
  example.duration_s = reader.number("duration_s");
  const auto& factors = reading.protocol.factors;
  if (const auto* with = reader.maybe_table("with"))
    for (const auto& entry : with->entries) {
      const auto* factor = find_factor(factors, entry.key);
      if (!factor)
        reading.findings.add(entry.place, phrase("unknown factor \"%1\"", {plain(entry.key)}),
                             core::suggestion(entry.key, names(factors)));
      else if (const auto value = read_factor_value(entry.value, *factor, reading.findings))
        example.with[entry.key] = *value;
    }
  const auto scene = reading.protocol.scenes.find(example.scene);
  if (scene != reading.protocol.scenes.end())
    for (const auto* expression : expressions_of(scene->second))
      for (const auto& name : factors_in(*expression))
        if (!example.with.count(name))
          reader.problem(
              "with",
              phrase("%1 does not set \"%2\", on which the scene depends", {plain("\"with\""), plain(name)}),
              plain("with = { " + name + " = ... }"));
  reader.finish();
  return example;
}

void read_pages(TableReader& reader, Interlude& interlude, const Reading& reading) {
  constexpr std::size_t most_examples = 4;
  reader.require("page");
  for (const auto* table : reader.tables("page")) {
    TableReader inner(*table, reader.path("page"), reading.findings, reader.keys("page"));
    ExplanationPage page;
    page.place = inner.place();
    page.text = read_localised(inner, "text", reading);
    page.picture = inner.maybe_string("picture").value_or("");
    page.picture_place = inner.place("picture");
    const auto examples = inner.tables("examples");
    if (examples.size() > most_examples)
      inner.problem("examples", phrase("\"%1\" has %2", {plain("examples"), plain(examples.size())}),
                    phrase("at most 4 on a page"));
    for (const auto* example : examples)
      page.examples.push_back(read_example(*example, inner.path("examples"), reading));
    inner.finish();
    interlude.pages.push_back(std::move(page));
  }
}

void read_screening(TableReader& reader, Interlude& interlude, const Reading& reading) {
  reader.require("pass");
  interlude.pass = read_rules(reader, "pass", interlude, reading);
  interlude.farewell = read_localised(reader, "farewell", reading);
  if (reader.has("pass") && interlude.pass.empty() && reading.findings.problems.empty())
    reader.problem("pass", phrase("\"pass\" has no rule"), phrase("write at least one comparison"));
}

/// Counts the parts of the plan (blocks and sequences) that begin above this line.
std::size_t parts_above(const Protocol& protocol, const Place& place) {
  const auto above = [&](const auto& part) { return block_of(part).place.line < place.line; };
  return static_cast<std::size_t>(std::count_if(protocol.plan.begin(), protocol.plan.end(), above));
}

void read_interlude(const Value& table, InterludeKind kind, const char* list, Reading& reading) {
  TableReader reader(table, titled(list, table), reading.findings, keys_of(list));
  Interlude interlude;
  interlude.kind = kind;
  interlude.place = reader.place();
  interlude.above = parts_above(reading.protocol, table.place);
  interlude.name = reader.string("name");
  std::vector<std::string> parts;
  for (const auto& part : reading.protocol.plan) parts.push_back(plan_name(part));
  const bool repeats = kind == InterludeKind::questionnaire || kind == InterludeKind::explanation;
  if (const auto after = repeats ? reader.maybe_string("after_each") : std::nullopt) {
    if (std::find(parts.begin(), parts.end(), *after) == parts.end())
      reader.problem("after_each", phrase("there is no block or sequence \"%1\"", {plain(*after)}),
                     core::suggestion(*after, parts));
    interlude.after_each = *after;
  }
  read_audience(reader, interlude.audience, reading);
  const auto same = [&](const Interlude& other) { return other.name == interlude.name; };
  const auto& others = reading.protocol.interludes;
  if (!interlude.name.empty() && (std::find(parts.begin(), parts.end(), interlude.name) != parts.end() ||
                                  std::any_of(others.begin(), others.end(), same)))
    reader.problem("name", phrase("there is already a part named \"%1\"", {plain(interlude.name)}),
                   phrase("each part of the session needs a different name"));
  if (kind == InterludeKind::questionnaire) read_items(reader, interlude, reading);
  if (kind == InterludeKind::consent) read_consent(reader, interlude, reading);
  if (kind == InterludeKind::explanation) read_pages(reader, interlude, reading);
  if (kind == InterludeKind::screening) read_screening(reader, interlude, reading);
  reader.finish();
  reading.protocol.interludes.push_back(std::move(interlude));
}

}  // namespace

void read_interludes(TableReader& file, Reading& reading) {
  static const std::vector<std::pair<const char*, InterludeKind>> kinds{
      {"consent", InterludeKind::consent},
      {"questionnaire", InterludeKind::questionnaire},
      {"explanation", InterludeKind::explanation},
      {"screening", InterludeKind::screening}};
  std::vector<std::tuple<const Value*, InterludeKind, const char*>> tables;
  for (const auto& [name, kind] : kinds)
    for (const auto* table : file.tables(name)) tables.emplace_back(table, kind, name);
  std::stable_sort(tables.begin(), tables.end(), [](const auto& a, const auto& b) {
    return std::get<0>(a)->place.line < std::get<0>(b)->place.line;
  });
  for (const auto& [table, kind, name] : tables) read_interlude(*table, kind, name, reading);
}

}  // namespace turnpoint::protocol

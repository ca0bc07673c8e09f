#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "station/protocol/expression.hpp"
#include "station/protocol/reading.hpp"
#include "station/protocol/sources.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

using core::Range;
using core::TableReader;
using core::Value;

namespace {

void read_what(TableReader& reader, Block& block, const Reading& reading) {
  if (reader.has("procedures")) block.procedures = reader.strings("procedures");
  std::vector<std::string> known, whole;
  for (const auto& spec : reading.protocol.procedures) known.push_back(spec.name);
  for (const auto& name : block.procedures) {
    const auto family = reading.families.find(name);
    if (family == reading.families.end())
      whole.push_back(name);
    else
      whole.insert(whole.end(), family->second.begin(), family->second.end());
  }
  block.procedures = std::move(whole);
  std::set<std::string> seen;
  for (const auto& name : block.procedures) {
    // `known` is empty if no procedure could be read. Do not report every name in the list as unknown then.
    if (!known.empty() && std::find(known.begin(), known.end(), name) == known.end())
      reader.problem("procedures", phrase("unknown procedure \"%1\"", {plain(name)}),
                     core::suggestion(name, known));
    if (!seen.insert(name).second)
      reader.problem("procedures", phrase("\"%1\" appears twice", {plain(name)}),
                     phrase("list each procedure only once"));
  }
  const bool levels = reader.has("level") || reader.has("levels");
  if (reader.has("procedures") == levels)
    return reading.findings.add(reader.place(),
                                levels ? phrase("%1 has both procedures and fixed levels", {reader.title()})
                                       : phrase("%1 presents nothing", {reader.title()}),
                                phrase("write either \"procedures\" or both \"level\" and \"levels\""));
  if (!levels) {
    if (reader.has("task"))
      reader.problem("task", phrase("each procedure names its task"), phrase("leave it out here"));
    return;
  }
  block.task = read_asked(reader, reading).name;
  const auto* factor = read_numeric_factor(reader, "level", reading);
  const auto* list = reader.require("levels");
  reader.numbers("levels");
  if (!factor || !list || list->kind != Value::Kind::array) return;
  block.level = factor->name;
  for (const auto& item : list->items)
    if (const auto value = read_factor_value(item, *factor, reading.findings))
      if (const auto* number = std::get_if<double>(&*value)) block.levels.push_back(*number);
}

void read_catch(TableReader& reader, Block& block, const Reading& reading) {
  const auto* table = reader.maybe_table("catch");
  if (!table) return;
  TableReader inner(*table, reader.path("catch"), reading.findings, reader.keys("catch"));
  Catch trials;
  trials.rate = inner.number("rate");
  for (const auto& factor : reading.protocol.factors) {
    const auto* value = inner.take(factor.name);
    if (!value) continue;
    if (!trials.factor.empty())
      inner.problem(factor.name, phrase("\"catch\" sets a second factor"),
                    phrase("\"catch\" may set only one factor"));
    trials.factor = factor.name;
    const auto one = [&](const Value& item) {
      const auto read = read_factor_value(item, factor, reading.findings);
      if (const auto* number = read ? std::get_if<double>(&*read) : nullptr)
        trials.levels.push_back(*number);
      else if (read)
        inner.problem(factor.name, phrase("\"catch\" sets a factor whose values are names"),
                      phrase("a numeric factor"));
    };
    if (value->kind != Value::Kind::array)
      one(*value);
    else
      for (const auto& item : value->items) one(item);
    if (value->kind == Value::Kind::array && value->items.empty())
      inner.problem(factor.name, phrase("\"catch\" has an empty list"),
                    phrase("list at least one easy level"));
  }
  if (trials.factor.empty() && table->entries.size() <= 1)
    reading.findings.add(table->place, phrase("\"catch\" does not say what to present"),
                         phrase("name a factor and its easy levels: %1",
                                {plain("{ rate = 0.06, offset_mm = [-25.0, 25.0] }")}));
  inner.finish();
  block.catch_trials = trials;
}

void read_practice(TableReader& reader, Block& block, const Reading& reading) {
  block.practice = reader.boolean("practice");
  const auto* table = reader.maybe_table("pass");
  if (!table) return;
  if (!block.practice) return;
  TableReader inner(*table, reader.path("pass"), reading.findings, reader.keys("pass"));
  block.pass = Pass{inner.number("accuracy"), inner.integer("retries")};
  inner.finish();
}

/// Reports what would come between the trials of a list whose order has rules, or end it before it is done.
void check_order_rules(TableReader& reader, const Block& block, const Reading& reading) {
  for (const auto& name : block.procedures) {
    const auto* spec = find_procedure(reading.protocol, name);
    if (!spec || spec->rules.empty()) continue;
    const auto refuse = [&](const char* key, core::Phrase what) {
      reader.problem(key, std::move(what), phrase("leave it out, or leave out the rules of the order"));
    };
    if (block.procedures.size() > 1 && block.interleave != Interleave::none)
      refuse("interleave",
             phrase("trials of other procedures would come between those of \"%1\", whose order has "
                    "rules",
                    {plain(name)}));
    if (block.catch_trials)
      refuse("catch",
             phrase("catch trials would come between those of \"%1\", whose order has rules", {plain(name)}));
    // Even a block with as many trials as the list ends early: a trial without an answer comes again.
    if (!spec->rules.equally.empty() && (block.lasts_s || block.trials))
      refuse(block.lasts_s ? "lasts_s" : "trials",
             phrase("the block may end before each value of \"%1\" has followed each other one equally often",
                    {plain(name)}));
  }
}

void read_block_keys(TableReader& reader, Block& block, const Reading& reading) {
  block.place = reader.place();
  read_what(reader, block, reading);
  block.trials = reader.maybe_integer("trials");
  block.lasts_s = reader.maybe_number("lasts_s");
  if (block.lasts_s && !block.level.empty())
    reader.problem("lasts_s", phrase("a list of fixed levels has its own end"),
                   phrase("use \"procedures\", or give \"trials\" instead"));
  if (!block.levels.empty() && !block.trials) block.trials = static_cast<int>(block.levels.size());
  const auto feedback = reader.word("feedback");
  block.feedback = feedback == "trial"   ? Feedback::trial
                   : feedback == "block" ? Feedback::block
                                         : Feedback::none;
  read_practice(reader, block, reading);
  const auto order = reader.maybe_word("interleave");
  block.interleave = order == "random"      ? Interleave::random
                     : order == "alternate" ? Interleave::alternate
                     : order == "passes"    ? Interleave::passes
                                            : Interleave::none;
  if (std::set(block.procedures.begin(), block.procedures.end()).size() > 1) reader.require("interleave");
  read_catch(reader, block, reading);
  check_order_rules(reader, block, reading);
  read_break(reader, block, reading);
  if (const auto name = reader.maybe_string("instruction")) {
    std::vector<std::string> known;
    for (const auto& [key, instruction] : reading.protocol.instructions) known.push_back(key);
    if (std::find(known.begin(), known.end(), *name) == known.end())
      reader.problem("instruction", phrase("there is no [instructions.%1]", {plain(*name)}),
                     core::suggestion(*name, known));
    block.fixed["instruction"] = *name;
  }
}

Block read_block(const Value& table, const Reading& reading) {
  TableReader reader(table, titled("block", table), reading.findings, keys_of("block"));
  Block block;
  block.name = reader.string("name");
  read_audience(reader, block.audience, reading);
  const auto kind = reader.word("kind");
  if (kind == "trials")
    read_block_keys(reader, block, reading);
  else
    read_strokes(reader, kind, block, reading);
  reader.finish();
  return block;
}

void check_instruction_levels(const Factor& factor, TableReader& reader, const Reading& reading) {
  if (factor.name != "instruction") return;
  for (const auto& level : factor.levels) {
    const auto* name = std::get_if<std::string>(&level);
    if (name && !reading.protocol.instructions.count(*name))
      reader.problem("over", phrase("there is no [instructions.%1]", {plain(*name)}),
                     phrase("add such a table for each level of the factor \"instruction\""));
  }
}

Sequence read_sequence(const Value& table, const Reading& reading) {
  TableReader reader(table, titled("sequence", table), reading.findings, keys_of("sequence"));
  Sequence sequence;
  sequence.name = reader.string("name");
  reader.word("design");
  sequence.over = reader.string("over");
  const auto& factors = reading.protocol.factors;
  const auto* factor = find_factor(factors, sequence.over);
  if (!sequence.over.empty() && !factor)
    reader.problem("over", phrase("unknown factor \"%1\"", {plain(sequence.over)}),
                   core::suggestion(sequence.over, names(factors)));
  if (factor && factor->levels.size() < 2)
    reader.problem(
        "over",
        phrase("the factor \"%1\" does not have several levels to put in order", {plain(sequence.over)}),
        phrase("use a factor with two or more \"levels\""));
  if (factor) check_instruction_levels(*factor, reader, reading);
  sequence.cycles = reader.integer("cycles");
  sequence.mirror = reader.boolean("mirror");
  sequence.one_per_session = reader.word("each_session") == "one";
  if (const auto* block = reader.table("block")) {
    TableReader inner(*block, reader.path("block"), reading.findings, reader.keys("block"));
    read_block_keys(inner, sequence.block, reading);
    inner.finish();
  }
  read_audience(reader, sequence.block.audience, reading);
  sequence.block.name = sequence.name;
  reader.finish();
  return sequence;
}

}  // namespace

void read_break(TableReader& reader, Block& block, const Reading& reading) {
  const auto* table = reader.maybe_table("break_after");
  if (!table) return;
  TableReader inner(*table, reader.path("break_after"), reading.findings, reader.keys("break_after"));
  block.break_after = Break{inner.integer("trials"), inner.number("min_s")};
  inner.finish();
}

void read_plan(TableReader& file, Reading& reading) {
  std::vector<std::pair<const Value*, bool>> tables;  // each table, with true for a [[sequence]]
  for (const auto* table : file.tables("block")) tables.emplace_back(table, false);
  for (const auto* table : file.tables("sequence")) tables.emplace_back(table, true);
  const auto above = [](const auto& a, const auto& b) {
    return std::tie(a.first->place.line, a.first->place.column) <
           std::tie(b.first->place.line, b.first->place.column);
  };
  std::stable_sort(tables.begin(), tables.end(), above);
  std::set<std::string> seen;
  for (const auto& [table, is_sequence] : tables) {
    std::string name;
    if (is_sequence) {
      auto sequence = read_sequence(*table, reading);
      name = sequence.name;
      reading.protocol.plan.emplace_back(std::move(sequence));
    } else {
      auto block = read_block(*table, reading);
      name = block.name;
      reading.protocol.plan.emplace_back(std::move(block));
    }
    if (!name.empty() && !seen.insert(name).second)
      reading.findings.add(table->find("name")->place,
                           phrase("there is already a block or sequence named \"%1\"", {plain(name)}),
                           phrase("each block and sequence needs a different name"));
  }
  if (tables.empty() && !file.has("block") && !file.has("sequence"))
    reading.findings.add(file.place(), phrase("the file has no [[block]] and no [[sequence]]"),
                         phrase("add at least one of them"));
}

}  // namespace turnpoint::protocol

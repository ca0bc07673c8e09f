#include <algorithm>
#include <cctype>
#include <set>

#include "station/core/number.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/reading.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

using core::Range;
using core::TableReader;
using core::Value;

namespace {

bool is_language(const std::string& code) {
  const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '-'; };
  return code.size() >= 2 && code.size() <= 16 && std::all_of(code.begin(), code.end(), letter) &&
         code[0] != '-';
}

void read_seed(TableReader& file, Reading& reading) {
  const auto* table = file.maybe_table("random");
  if (!table) {
    if (!file.has("random")) reading.findings.defaults_used.push_back("random.seed = \"per-session\"");
    return;
  }
  TableReader reader(*table, "random", reading.findings, file.keys("random"));
  const auto* seed = reader.require("seed");
  if (seed && seed->kind == Value::Kind::integer && seed->integer >= 0 &&
      seed->integer <= (std::int64_t{1} << 53))
    reading.protocol.seed = static_cast<std::uint64_t>(seed->integer);
  else if (seed && (seed->kind != Value::Kind::string || seed->string != "per-session"))
    reader.problem(
        "seed",
        phrase("\"%1\" is %2",
               {plain("seed"), seed->kind == Value::Kind::integer ? plain(seed->integer) : describe(*seed)}),
        phrase("allowed: \"per-session\" or a whole number from 0 to 2^53"));
  reader.finish();
}

void check_factor_name(TableReader& reader, const std::string& name) {
  if (name == "abs")
    reader.problem("name", phrase("\"%1\" is not a valid name for a factor", {plain(name)}),
                   phrase("\"abs\" is a function; choose another name"));
}

void read_level(const core::Value& item, Factor& factor, core::Findings& findings) {
  const bool number = item.kind == Value::Kind::number || item.kind == Value::Kind::integer;
  const bool fits = number ? core::inside_range(item.number, {-1e6, 1e6})
                           : item.kind == Value::Kind::string && !item.string.empty() && !factor.range;
  const FactorValue value = number ? FactorValue(item.number) : FactorValue(item.string);
  const auto& levels = factor.levels;
  if (!fits || (!levels.empty() && value.index() != levels.front().index()))
    findings.add(item.place, phrase("a level of \"%1\" is %2", {plain(factor.name), describe(item)}),
                 phrase("levels must be either all numbers (between -1000000 and 1000000) or all names"));
  else if (std::find(levels.begin(), levels.end(), value) != levels.end())
    findings.add(item.place, phrase("a level of \"%1\" appears twice", {plain(factor.name)}),
                 phrase("each level must be different"));
  else if (factor.range && !core::inside_range(item.number, {factor.range->first, factor.range->second}))
    findings.add(item.place, phrase("a level of \"%1\" is outside its range", {plain(factor.name)}),
                 describe(Range{factor.range->first, factor.range->second}));
  else
    factor.levels.push_back(value);
}

/// Reads the key "draw", which says how the values of a factor are drawn.
void read_draw(TableReader& reader, Factor& factor, bool has_levels, Reading& reading) {
  const auto* draw = reader.take("draw");
  if (!draw) return;
  const auto is = [&](const char* word) { return draw->kind == Value::Kind::string && draw->string == word; };
  const auto* normal = draw->kind == Value::Kind::table ? draw->find("normal") : nullptr;
  if ((is("without-repetition") || is("per-participant")) && has_levels) {
    factor.draw = is("per-participant") ? FactorDraw::per_participant : FactorDraw::without_repetition;
  } else if (is("uniform") && factor.range && !has_levels) {
    factor.draw = FactorDraw::uniform;
  } else if (normal && normal->value.kind == Value::Kind::table && factor.range && !has_levels) {
    TableReader inner(normal->value, "factor." + factor.name + ".draw.normal", reading.findings,
                      keys_of("factor.draw.normal"));
    const auto [low, high] = *factor.range;
    factor.draw = FactorDraw::normal;
    factor.mean = inner.number("mean", {low, high});
    factor.sd = inner.number("sd", {0, high - low, Range::Ends::open_low});
    inner.finish();
  } else {
    reader.problem(
        "draw", phrase("\"draw\" of \"%1\" is %2", {plain(factor.name), describe(*draw)}),
        phrase("with a range: \"uniform\" or %1; with levels: \"without-repetition\" or \"per-participant\"",
               {plain("{ normal = { mean = ..., sd = ... } }")}));
  }
}

Factor read_factor(const core::Value& table, Reading& reading) {
  TableReader reader(table, titled("factor", table), reading.findings, keys_of("factor"));
  Factor factor;
  factor.place = reader.place("name");
  factor.name = reader.string("name");
  check_factor_name(reader, factor.name);
  factor.range = reader.maybe_interval("range");
  const auto* levels = reader.take("levels");
  if (levels && (levels->kind != Value::Kind::array || levels->items.empty()))
    reader.problem("levels",
                   levels->kind == Value::Kind::array
                       ? phrase("\"levels\" is empty")
                       : phrase("\"%1\" is %2", {plain("levels"), describe(*levels)}),
                   phrase("write a list of numbers or of names"));
  else if (levels)
    for (const auto& item : levels->items) read_level(item, factor, reading.findings);
  read_draw(reader, factor, levels != nullptr, reading);
  reader.finish();
  return factor;
}

}  // namespace

void read_header(TableReader& file, Reading& reading) {
  file.word("format");
  auto& protocol = reading.protocol;
  if (const auto* table = file.table("protocol")) {
    TableReader reader(*table, "protocol", reading.findings, file.keys("protocol"));
    protocol.id = reader.string("id");
    protocol.version = reader.string("version");
    protocol.title = reader.string("title");
    protocol.languages = reader.strings(
        "languages", phrase("write a list of language codes: %1", {plain("[\"en\", \"ja\"]")}));
    std::set<std::string> seen;
    for (const auto& code : protocol.languages)
      if (!is_language(code))
        reader.problem("languages", phrase("\"%1\" in \"languages\"", {plain(code)}),
                       phrase("a language code has 2 to 16 letters, with a hyphen before a region, such as "
                              "\"en\" or \"pt-BR\""));
      else if (!seen.insert(code).second)
        reader.problem("languages", phrase("\"%1\" in \"languages\"", {plain(code)}),
                       phrase("list each language code only once, such as \"en\", \"de\", \"ja\""));
    reader.finish();
  }
  read_seed(file, reading);
}

void read_factors(TableReader& file, Reading& reading) {
  auto& factors = reading.protocol.factors;
  constexpr std::size_t most_factors = 100;
  const auto tables = file.tables("factor");
  if (tables.size() > most_factors)
    return reading.findings.add(tables[most_factors]->place, phrase("%1 factors", {plain(tables.size())}),
                                phrase("at most %1", {plain(most_factors)}));
  for (const auto* table : tables) {
    auto factor = read_factor(*table, reading);
    if (find_factor(factors, factor.name))
      reading.findings.add(factor.place,
                           phrase("there is already a factor named \"%1\"", {plain(factor.name)}),
                           phrase("each factor needs a different name"));
    else
      factors.push_back(std::move(factor));
  }
}

void read_resume(TableReader& file, Reading& reading) {
  static const core::Value empty;
  const auto* table = file.maybe_table("resume");
  TableReader reader(table ? *table : empty, "resume", reading.findings, file.keys("resume"));
  auto& resume = reading.protocol.resume;
  const auto& words = reader.words("incomplete");
  const auto word = reader.word("incomplete");
  resume.incomplete = static_cast<ResumePolicy>(std::find(words.begin(), words.end(), word) - words.begin());
  resume.max_age_h = reader.number("max_age_h");
  resume.warmup = reader.integer("warmup");
  resume.restart_unit = reader.maybe_word("restart_unit").value_or("");
  reader.finish();
}

}  // namespace turnpoint::protocol

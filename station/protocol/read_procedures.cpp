#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "station/core/number.hpp"
#include "station/procedure/constant_stimuli.hpp"
#include "station/procedure/description.hpp"
#include "station/procedure/keys.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/reading.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

using core::Range;
using core::TableReader;
using core::Value;
using procedure::Kind;
using procedure::Spec;

namespace {

// Returns the copied procedure's table `below`, with the keys of `own` added or replaced. The inner tables
// "grid" and "prior" are merged key by key.
Value overlay(Value below, const Value& own) {
  for (const auto& entry : own.entries) {
    const auto found = std::find_if(below.entries.begin(), below.entries.end(),
                                    [&](const auto& other) { return other.key == entry.key; });
    if (found == below.entries.end()) {
      below.entries.push_back(entry);
      continue;
    }
    const bool axes = (entry.key == "grid" || entry.key == "prior") &&
                      entry.value.kind == Value::Kind::table && found->value.kind == Value::Kind::table;
    const auto merged = axes ? overlay(found->value, entry.value) : entry.value;
    *found = entry;
    found->value = merged;
  }
  below.place = own.place;
  return below;
}

void check_balance(TableReader& reader, const Spec& spec, const Reading& reading) {
  const auto& factors = reading.protocol.factors;
  std::set<std::string> seen;
  for (const auto& name : spec.balance) {
    const auto* factor = find_factor(factors, name);
    if (!factor)
      reader.problem("balance", phrase("unknown factor \"%1\"", {plain(name)}),
                     core::suggestion(name, names(factors)));
    else if (factor->levels.empty())
      reader.problem("balance", phrase("the factor \"%1\" has a range, not levels", {plain(name)}),
                     phrase("use a factor with \"levels\""));
    if (name == spec.level || !seen.insert(name).second)
      reader.problem("balance", phrase("\"%1\" is set twice", {plain(name)}),
                     phrase("list each factor only once, and not the factor that the procedure sets"));
  }
}

void check_max_run(TableReader& reader, const Spec& spec, const Reading& reading) {
  const auto& factors = reading.protocol.factors;
  for (const auto& [name, limit] : spec.max_run)
    if (name != procedure::kRightAnswer && !find_factor(factors, name))
      reader.problem("order", phrase("unknown factor \"%1\" in \"max_run\"", {plain(name)}),
                     core::suggestion(name, names(factors)));
}

/// The places of the values of a factor that the list sets, and the number of the factor in
/// procedure::OrderRules.
struct Listed {
  std::size_t number = 0;
  std::vector<FactorValue> values;
};

std::optional<Listed> listed(const Spec& spec, const std::string& name, const Reading& reading) {
  if (name == spec.level) return Listed{0, {spec.values.begin(), spec.values.end()}};
  const auto found = std::find(spec.balance.begin(), spec.balance.end(), name);
  const auto* factor = find_factor(reading.protocol.factors, name);
  if (found == spec.balance.end() || !factor) return std::nullopt;
  return Listed{1 + static_cast<std::size_t>(found - spec.balance.begin()), factor->levels};
}

/// Reads the pairs of values of one factor that never follow each other.
void read_never(const core::Entry& entry, const Listed& factor, Spec& spec, core::Findings& findings) {
  const auto place_of = [&](const Value& value) -> std::optional<std::size_t> {
    const bool is_number = value.kind == Value::Kind::number || value.kind == Value::Kind::integer;
    const auto wanted = is_number ? FactorValue(value.number) : FactorValue(value.string);
    const auto found = std::find(factor.values.begin(), factor.values.end(), wanted);
    if (found == factor.values.end()) return std::nullopt;
    return static_cast<std::size_t>(found - factor.values.begin());
  };
  const auto allowed = phrase("pairs of values that the list has: %1", {plain("[[before, after], ...]")});
  if (entry.value.kind != Value::Kind::array || entry.value.items.empty())
    return findings.add(entry.place, phrase("\"%1\" is not a list of pairs", {plain(entry.key)}), allowed);
  for (const auto& pair : entry.value.items) {
    if (pair.kind != Value::Kind::array || pair.items.size() != 2) {
      findings.add(pair.place, phrase("this is not a pair of values"), allowed);
      continue;
    }
    const auto before = place_of(pair.items[0]), now = place_of(pair.items[1]);
    if (!before || !now)
      findings.add(pair.items[before ? 1 : 0].place,
                   phrase("\"%1\" never has this value in the list", {plain(entry.key)}), allowed);
    else
      spec.rules.never.push_back({factor.number, *before, *now});
  }
}

/// Reads the rules of the order of a list, and checks that some order keeps them.
void read_order_rules(TableReader& reader, Spec& spec, const Reading& reading) {
  if (spec.after_each_other.empty() && spec.never_after.entries.empty()) return;
  auto& findings = reader.findings();
  const auto before = findings.problems.size();
  const auto in_list = phrase("the level, or a factor in \"balance\"");
  const auto refuse = [&](core::Phrase what, core::Phrase allowed) {
    reader.problem("order", std::move(what), std::move(allowed));
  };
  auto& rules = spec.rules;
  rules.back = static_cast<std::size_t>(spec.back);
  for (const auto& name : spec.after_each_other) {
    const auto factor = listed(spec, name, reading);
    if (!factor)
      refuse(phrase("the list does not set \"%1\", so its order cannot follow a rule", {plain(name)}),
             in_list);
    else if (std::find(rules.equally.begin(), rules.equally.end(), factor->number) != rules.equally.end())
      refuse(phrase("\"%1\" is set twice", {plain(name)}), phrase("name each factor once"));
    else
      rules.equally.push_back(factor->number);
  }
  for (const auto& entry : spec.never_after.entries) {
    if (const auto factor = listed(spec, entry.key, reading))
      read_never(entry, *factor, spec, findings);
    else
      findings.add(
          entry.place,
          phrase("the list does not set \"%1\", so its order cannot follow a rule", {plain(entry.key)}),
          in_list);
  }
  for (const auto& [name, limit] : spec.max_run)
    if (const auto factor = listed(spec, name, reading)) rules.runs.push_back({factor->number, limit});
  if (spec.shuffle == procedure::Shuffle::none)
    refuse(phrase("a list that is not shuffled cannot follow rules of its order"),
           plain("shuffle = \"within-block\""));
  if (spec.stop.right)
    refuse(phrase("a list that ends early does not keep the rules of its order"),
           phrase("leave out \"stop\""));
  std::set<std::size_t> ruled(rules.equally.begin(), rules.equally.end());
  for (const auto& never : rules.never) ruled.insert(never.factor);
  for (const auto& run : rules.runs) ruled.insert(run.factor);
  if (!rules.equally.empty() && ruled.size() > rules.equally.size())
    refuse(phrase("\"after_each_other\" does not name all factors that have rules"),
           phrase("name there what \"never_after\" and \"max_run\" name, too"));
  std::size_t cells = 1;
  procedure::Context context;
  for (const auto& name : spec.balance)
    if (const auto* factor = find_factor(reading.protocol.factors, name)) {
      context.factor_levels[name] = factor->levels.size();
      cells *= factor->levels.size();
    }
  if (ruled.lower_bound(1) != ruled.end()) {
    if (cells > 0 && static_cast<std::size_t>(spec.repeats) % cells != 0)
      refuse(
          phrase(
              "the combinations of \"balance\" do not come equally often, so the order cannot follow a rule"),
          phrase("set \"repeats\" to a multiple of %1", {plain(cells)}));
    if (spec.shuffle == procedure::Shuffle::within_repeat)
      refuse(phrase("a rule for a factor in \"balance\" holds over the whole list, not within repeats"),
             plain("shuffle = \"within-block\""));
  }
  if (findings.problems.size() > before || spec.values.empty() || spec.repeats < 1) return;
  if (const auto problem = procedure::order_problem(spec, context)) refuse(problem->what, problem->allowed);
}

void check_tracks(TableReader& reader, const Spec& spec, const Reading& reading) {
  std::vector<std::string> ids;
  for (const auto& choice : reading.protocol.task.choices) ids.push_back(choice.id);
  if (!spec.tracks.empty() && !ids.empty() && std::find(ids.begin(), ids.end(), spec.tracks) == ids.end())
    reader.problem("tracks", phrase("\"%1\" is not a choice of the task", {plain(spec.tracks)}),
                   core::suggestion(spec.tracks, ids));
}

// Checks that every level that the procedure can present is a value of its factor.
void check_levels(TableReader& reader, const Spec& spec, const Factor& factor) {
  const auto check = [&](const char* key, double level) {
    const auto& levels = factor.levels;
    const bool inside = factor.range
                            ? level >= factor.range->first && level <= factor.range->second
                            : std::find(levels.begin(), levels.end(), FactorValue(level)) != levels.end();
    if (inside || !reader.has(key)) return true;
    reader.problem(key, phrase("\"%1\" has %2", {plain(std::string(key)), plain(core::number(level))}),
                   factor.range ? phrase("the range of \"%1\" is %2",
                                         {plain(factor.name),
                                          describe(Range{factor.range->first, factor.range->second})})
                                : phrase("a level of \"%1\"", {plain(factor.name)}));
    return false;
  };
  const auto check_all = [&](const char* key, const std::vector<double>& levels) {
    for (const double level : levels)
      if (!check(key, level)) break;  // report only one problem per list
  };
  if (spec.kind == Kind::adjustment) {
    check_all("start_below", spec.ascending.values), check_all("start_above", spec.descending.values);
    check_all("start", spec.values);
  } else {
    check_all("values", spec.values);
  }
  check_all("stimuli", spec.stimuli.values);
  for (const auto& [key, starts] :
       {std::pair("start_ascending", &spec.ascending), std::pair("start_descending", &spec.descending)})
    if (!starts->empty() && check(key, starts->ends().first)) check(key, starts->ends().second);
  if (spec.start) check("start", *spec.start);
  if (spec.min) check("min", *spec.min);
  if (spec.max) check("max", *spec.max);
}

// Checks the procedure with procedure::validate(). Each problem names its key; in the path of a key, dots
// separate the names of inner tables.
void check_spec(const Value& table, const Spec& spec, core::Findings& findings) {
  for (const auto& fault : procedure::validate(spec)) {
    const Value* at = &table;
    std::string rest = fault.key;
    while (!rest.empty()) {
      const auto dot = rest.find('.');
      const auto* entry = at->find(rest.substr(0, dot));
      if (!entry) break;
      at = &entry->value;
      rest = dot == std::string::npos ? "" : rest.substr(dot + 1);
    }
    findings.add(at->place,
                 phrase("procedure \"%1\": \"%2\": %3", {plain(spec.name), plain(fault.key), fault.what}),
                 fault.allowed);
  }
}

/// Checks the factors of the stimuli with which the level is compared.
void check_against(TableReader& reader, const Spec& spec, const Reading& reading) {
  std::set<std::string> seen{spec.level};
  for (const auto& name : spec.against) {
    const auto* factor = find_factor(reading.protocol.factors, name);
    if (!factor)
      reader.problem("against", phrase("unknown factor \"%1\"", {plain(name)}),
                     core::suggestion(name, names(reading.protocol.factors)));
    else if (!seen.insert(name).second)
      reader.problem("against", phrase("\"%1\" is set twice", {plain(name)}),
                     phrase("name another factor for each interval"));
    else if (!is_broken(*factor))
      check_levels(reader, spec, *factor);
  }
}

/// Checks the factor of the second dimension and its values.
void check_second(const Value& table, const Spec& spec, const Reading& reading, core::Findings& findings) {
  const auto* second = table.find("second");
  if (!spec.second || spec.second->level.empty() || !second) return;
  TableReader reader(second->value, "second", findings, keys_of("procedure.second"));
  const auto* factor = read_numeric_factor(reader, "level", reading);
  if (!factor || is_broken(*factor)) return;
  for (const double value : spec.second->stimuli.values) {
    const auto& levels = factor->levels;
    const bool inside = factor->range
                            ? value >= factor->range->first && value <= factor->range->second
                            : std::find(levels.begin(), levels.end(), FactorValue(value)) != levels.end();
    if (inside) continue;
    return reader.problem(
        "stimuli", phrase("\"%1\" has %2", {plain("stimuli"), plain(core::number(value))}),
        factor->range
            ? phrase("the range of \"%1\" is %2",
                     {plain(factor->name), describe(Range{factor->range->first, factor->range->second})})
            : phrase("a level of \"%1\"", {plain(factor->name)}));
  }
}

/// True if the procedure chooses the value of this factor.
bool chooses(const Spec& spec, const std::string& factor) {
  return factor == spec.level || (spec.second && factor == spec.second->level);
}

/// Reads the values that factors have in all trials of the procedure.
void read_with(TableReader& reader, Spec& spec, const Reading& reading, core::Findings& findings) {
  const auto& factors = reading.protocol.factors;
  const auto* with = reader.maybe_table("with");
  for (const auto& entry : with ? with->entries : std::vector<core::Entry>{}) {
    const auto* factor = find_factor(factors, entry.key);
    const bool twice = chooses(spec, entry.key) ||
                       std::find(spec.balance.begin(), spec.balance.end(), entry.key) != spec.balance.end();
    if (!factor || twice)
      findings.add(entry.place,
                   twice ? phrase("\"%1\" is set twice", {plain(entry.key)})
                         : phrase("unknown factor \"%1\"", {plain(entry.key)}),
                   twice ? phrase("set factors that the procedure does not set otherwise")
                         : core::suggestion(entry.key, names(factors)));
    else if (const auto value = read_factor_value(entry.value, *factor, findings))
      spec.with[entry.key] = *value;
  }
}

/// Makes one procedure for each level of the factor that `for_each` names.
std::vector<Spec> family_of(const Value& table, const Spec& spec, const Reading& reading,
                            core::Findings& findings) {
  const auto* key = table.find("for_each");
  if (!key) return {spec};
  const auto* factor = key->value.kind == Value::Kind::string
                           ? find_factor(reading.protocol.factors, key->value.string)
                           : nullptr;
  const bool twice = factor && (chooses(spec, factor->name) || spec.with.count(factor->name) > 0);
  if (!factor || factor->levels.empty() || twice) {
    findings.add(
        key->value.place,
        phrase("\"for_each\" is %1, which is not a factor with levels that the procedure does not set",
               {describe(key->value)}),
        phrase("name a factor with \"levels\""));
    return {};
  }
  std::vector<Spec> family;
  for (const auto& level : factor->levels) {
    auto one = spec;
    const auto* number = std::get_if<double>(&level);
    auto name = number ? core::exact(*number) : std::get<std::string>(level);
    for (auto& c : name)
      if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '_';
    one.name = spec.name + "-" + name;
    one.family = spec.name;
    one.with[factor->name] = level;
    family.push_back(std::move(one));
  }
  return family;
}

/// Adds the procedures that were made from one table. Reports a problem if two would have the same name: the
/// levels may differ only in characters that are not allowed in names, or another table may already have the
/// name.
void add_family(const Value& table, const std::string& name, std::vector<Spec> family, Reading& reading) {
  for (auto& one : family) {
    if (one.family.empty()) {
      one.name = name;
    } else {
      auto& procedures = reading.protocol.procedures;
      const auto same = [&](const Spec& other) { return other.name == one.name; };
      if (std::any_of(procedures.begin(), procedures.end(), same))
        return reading.findings.add(
            table.find("for_each")->value.place,
            phrase("\"for_each\" makes a second procedure named \"%1\"", {plain(one.name)}),
            phrase("choose another name for the table or for the level"));
      reading.families[name].push_back(one.name);
    }
    if (!reading.tasks.empty()) reading.asks[one.name] = reading.protocol.task.name;
    reading.protocol.procedures.push_back(std::move(one));
  }
}

/// Tells the procedure how often a guess is right, if the participant may be unsure instead of guessing.
void read_unsure_rate(TableReader& reader, Spec& spec, const Reading& reading) {
  const auto& task = reading.protocol.task;
  if (task.unsure.empty() || task.choices.empty()) return;
  spec.guess_rate = 1.0 / static_cast<double>(task.choices.size());
  if (spec.kind != Kind::constant_stimuli && spec.kind != Kind::weighted_up_down &&
      spec.kind != Kind::program)
    reader.problem("kind",
                   phrase("this kind of procedure does not know what to do with the answer \"unsure\""),
                   phrase("use \"weighted-up-down\", \"constant-stimuli\" or \"program\""));
  if (spec.target && *spec.target <= *spec.guess_rate)
    reader.problem("target", phrase("a guess already reaches this target"),
                   phrase("above %1", {plain(core::number(*spec.guess_rate, 3))}));
}

Spec read_procedure(const Value& table, const Reading& reading, core::Findings& findings) {
  TableReader reader(table, titled("procedure", table), findings, keys_of("procedure"));
  Spec spec;
  spec.name = reader.string("name");
  reader.take("copy");
  reading.protocol.task = read_asked(reader, reading);
  spec.kind = procedure::parse_kind(reader.word("kind")).value_or(Kind::constant_stimuli);
  const auto* factor = read_numeric_factor(reader, "level", reading);
  if (factor) spec.level = factor->name;
  procedure::description(spec.kind).read(reader, spec);
  read_unsure_rate(reader, spec, reading);
  if (procedure::follows_answers(spec)) procedure::read_runs(reader, spec);
  check_max_run(reader, spec, reading);
  check_second(table, spec, reading, findings);
  check_against(reader, spec, reading);
  check_tracks(reader, spec, reading);
  check_balance(reader, spec, reading);
  if (findings.problems.empty()) read_order_rules(reader, spec, reading);
  read_with(reader, spec, reading, findings);
  if (reader.take("continues")) spec.continues = reader.boolean("continues");
  reader.take("for_each");
  if (factor && !is_broken(*factor)) check_levels(reader, spec, *factor);
  if (findings.problems.empty()) check_spec(table, spec, findings);
  reader.finish();
  return spec;
}

std::string name_of(const Value& table) {
  const auto* name = table.find("name");
  return name && name->value.kind == Value::Kind::string ? name->value.string : "";
}

// Merges the table with the procedures that it copies. The copied procedures must be above it in the file.
Value with_copies(const Value& table, const std::map<std::string, Value>& above, core::Findings& findings) {
  const auto* copy = table.find("copy");
  if (!copy) return table;
  std::vector<std::string> known;
  for (const auto& [name, value] : above) known.push_back(name);
  const auto found = copy->value.kind == Value::Kind::string ? above.find(copy->value.string) : above.end();
  if (found != above.end()) return overlay(found->second, table);
  findings.add(copy->value.place,
               phrase("\"copy\" is %1, which is not a procedure above this one", {describe(copy->value)}),
               core::suggestion(copy->value.string, known));
  return table;
}

}  // namespace

void read_procedures(TableReader& file, Reading& reading) {
  std::map<std::string, Value> above;
  std::set<std::pair<int, int>> places;
  for (const auto* table : file.tables("procedure")) {
    const auto name = name_of(*table);
    core::Findings found;
    const auto whole = with_copies(*table, above, found);
    const bool broken_copy = !found.problems.empty();
    Spec spec;
    if (!broken_copy) spec = read_procedure(whole, reading, found);
    auto family = family_of(whole, spec, reading, found);
    // If a procedure contains a mistake, every procedure that copies it contains the mistake too. So report
    // only one problem for each place in the file.
    for (auto& problem : found.problems)
      if (places.insert({problem.place.line, problem.place.column}).second)
        reading.findings.problems.push_back(std::move(problem));
    auto& defaults = reading.findings.defaults_used;
    defaults.insert(defaults.end(), found.defaults_used.begin(), found.defaults_used.end());
    if (!name.empty() && !above.emplace(name, whole).second)
      reading.findings.add(table->find("name")->place,
                           phrase("there is already a procedure named \"%1\"", {plain(name)}),
                           phrase("each procedure needs a different name"));
    else if (!name.empty())
      add_family(*table, name, std::move(family), reading);
  }
}

}  // namespace turnpoint::protocol

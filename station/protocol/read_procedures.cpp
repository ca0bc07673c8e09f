#include <algorithm>
#include <map>
#include <set>

#include "station/protocol/expression.hpp"
#include "station/protocol/grid.hpp"
#include "station/protocol/reading.hpp"
#include "station/text/number.hpp"

namespace turnpoint::protocol {

using procedure::Kind;
using procedure::Spec;
using text::Range;
using text::TableReader;
using text::Value;

namespace {

const Range any_level{-1e6, 1e6};

// A copy's keys lie over those of the procedure that it copies; grids and priors axis by axis.
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

void read_order(TableReader& reader, Spec& spec) {
  const auto* table = reader.maybe_table("order");
  if (!table) {
    if (!reader.has("order")) reader.defaulted("order.shuffle", "\"within-repeat\"");
    return;
  }
  TableReader inner(*table, reader.path("order"), reader.findings());
  const auto shuffle = inner.word("shuffle", {"within-repeat", "within-block", "none"}, "within-repeat");
  spec.shuffle = shuffle == "none"           ? procedure::Shuffle::none
                 : shuffle == "within-block" ? procedure::Shuffle::within_block
                                             : procedure::Shuffle::within_repeat;
  spec.max_run = inner.maybe_integer("max_run", 1, 1000);
  inner.finish();
}

void read_balance(TableReader& reader, Spec& spec, const Reading& reading) {
  spec.balance = reader.maybe_strings("balance");
  const auto& factors = reading.protocol.factors;
  std::set<std::string> seen;
  for (const auto& name : spec.balance) {
    const auto* factor = find_factor(factors, name);
    if (!factor)
      reader.problem("balance", "unknown factor \"" + name + "\"", suggestion(name, names(factors)));
    else if (factor->levels.empty())
      reader.problem("balance", "the factor \"" + name + "\" has a range, not levels",
                     "a factor with \"levels\"");
    if (name == spec.level || !seen.insert(name).second)
      reader.problem("balance", "\"" + name + "\" is set twice",
                     "each factor once, and not the level itself");
  }
}

void read_constant(TableReader& reader, Spec& spec, const Reading& reading) {
  spec.values = reader.numbers("values", any_level);
  spec.repeats = reader.integer("repeats", 1, 10000);
  read_balance(reader, spec, reading);
  read_order(reader, spec);
}

void read_adjustment(TableReader& reader, Spec& spec, const Reading& reading) {
  spec.values = reader.numbers("start", any_level);
  spec.repeats = reader.integer("repeats", 1, 10000);
  read_balance(reader, spec, reading);
  read_order(reader, spec);
}

void read_tracks(TableReader& reader, Spec& spec, const Reading& reading) {
  spec.tracks = reader.maybe_string("tracks").value_or("");
  std::vector<std::string> ids;
  for (const auto& choice : reading.protocol.task.choices) ids.push_back(choice.id);
  if (!spec.tracks.empty() && !ids.empty() && std::find(ids.begin(), ids.end(), spec.tracks) == ids.end())
    reader.problem("tracks", "\"" + spec.tracks + "\" is no choice of the task",
                   suggestion(spec.tracks, ids));
}

void read_scale(TableReader& reader, Spec& spec) {
  const auto scale = reader.word("scale", {"linear", "log10", "dB"}, "linear");
  spec.scale = scale == "log10" ? procedure::Scale::log10
               : scale == "dB"  ? procedure::Scale::dB
                                : procedure::Scale::linear;
}

void read_stop(TableReader& reader, Spec& spec) {
  const auto* table = reader.table("stop", "when it ends: { trials = 40 }");
  if (!table) return;
  TableReader inner(*table, reader.path("stop"), reader.findings());
  spec.stop.trials = inner.maybe_integer("trials", 1, 100000);
  spec.stop.reversals = inner.maybe_integer("reversals", 1, 10000);
  spec.stop.min_trials = inner.maybe_integer("min_trials", 1, 100000);
  spec.stop.threshold_sd = inner.maybe_number("threshold_sd", {0, 1e6, Range::Ends::open_low});
  spec.stop.entropy_nats = inner.maybe_number("entropy_nats", {-100, 100});
  const int rules =
      inner.has("trials") + inner.has("reversals") + inner.has("threshold_sd") + inner.has("entropy_nats");
  if (rules == 0)
    reader.findings().add(table->place, "\"stop\" has no rule",
                          "\"trials\", \"reversals\", \"threshold_sd\" or \"entropy_nats\"");
  if (rules > 1 && !inner.has("rule"))
    reader.findings().add(table->place, "\"stop\" has several rules",
                          "\"rule\" = \"or\" (the first that holds ends it) or \"and\" (all must hold)");
  spec.stop.rule = inner.maybe_word("rule", {"or", "and"}).value_or("or") == "and" ? procedure::StopRule::all
                                                                                   : procedure::StopRule::any;
  inner.finish();
}

void read_steps(TableReader& reader, Spec& spec) {
  const Range step{0, 1e6, Range::Ends::open_low};
  spec.step = reader.maybe_numbers("step", step);
  spec.step_down = reader.maybe_numbers("step_down", step);
  spec.step_up = reader.maybe_numbers("step_up", step);
  if (reader.has("step") == reader.has("step_down"))
    reader.findings().add(
        reader.has("step") ? reader.place("step_down") : reader.place("step_up"),
        reader.title() + (reader.has("step") ? " has both \"step\" and \"step_down\"" : " has no steps"),
        "\"step\" (up and down alike) or \"step_down\"");
}

void read_staircase(TableReader& reader, Spec& spec, const Reading& reading) {
  read_tracks(reader, spec, reading);
  read_scale(reader, spec);
  spec.start = reader.number("start", any_level);
  spec.min = reader.number("min", any_level);
  spec.max = reader.number("max", any_level);
  read_steps(reader, spec);
  spec.discard_reversals = reader.integer("discard_reversals", 0, 1000, 0);
  if (spec.kind == Kind::up_down) {
    spec.n_down = reader.integer("n_down", 1, 20);
    spec.n_up = reader.integer("n_up", 1, 20, 1);
    spec.initial_down = reader.maybe_integer("initial_down", 1, 20);
  } else {
    spec.target = reader.number("target", {0, 1, Range::Ends::open});
    if (reader.has("step_up"))
      reader.problem("step_up", "\"step_up\" beside \"target\"",
                     "the step up follows from the target and the step down");
  }
  read_stop(reader, spec);
}

void read_axes(TableReader& reader, Spec& spec) {
  if (const auto* grid = reader.table("grid", "grid.threshold, grid.slope, grid.guess and grid.lapse")) {
    TableReader inner(*grid, reader.path("grid"), reader.findings());
    const auto axis = [&](const char* key, procedure::Grid& into) {
      if (const auto* value = inner.require(key, "a grid: { from, to, step } or { values = [...] }"))
        into = read_grid(*value, inner.path(key), Axis::parameter, reader.findings());
    };
    axis("threshold", spec.threshold), axis("slope", spec.slope), axis("guess", spec.guess),
        axis("lapse", spec.lapse);
    inner.finish();
  }
  if (const auto* prior = reader.maybe_table("prior")) {
    TableReader inner(*prior, reader.path("prior"), reader.findings());
    const auto axis = [&](const char* key, procedure::Prior& into) {
      if (const auto* value = inner.take(key)) into = read_prior(*value, inner.path(key), reader.findings());
    };
    axis("threshold", spec.prior_threshold), axis("slope", spec.prior_slope), axis("guess", spec.prior_guess),
        axis("lapse", spec.prior_lapse);
    inner.finish();
  }
}

void read_posterior(TableReader& reader, Spec& spec, const Reading& reading) {
  read_tracks(reader, spec, reading);
  read_scale(reader, spec);
  const auto function = reader.word("function", {"weibull", "normal", "logistic"});
  spec.function = function == "normal"     ? terms::Function::normal
                  : function == "logistic" ? terms::Function::logistic
                                           : terms::Function::weibull;
  if (const auto* stimuli = reader.require("stimuli", "the levels to choose from: { from, to, step }"))
    spec.stimuli = read_grid(*stimuli, reader.path("stimuli"), Axis::stimuli, reader.findings());
  read_axes(reader, spec);
  const std::vector<std::string> parameters{"threshold", "slope", "guess", "lapse"};
  spec.nuisance = reader.maybe_strings("nuisance");
  for (const auto& name : spec.nuisance)
    if (std::find(parameters.begin(), parameters.end(), name) == parameters.end())
      reader.problem("nuisance", "\"" + name + "\" is no parameter",
                     "allowed: " + text::quoted_list(parameters));
  reader.word("select", {"min-expected-entropy"}, "min-expected-entropy");
  read_stop(reader, spec);
}

// Every level that the procedure can present must be a value of its factor.
void check_levels(TableReader& reader, const Spec& spec, const Factor& factor) {
  const auto check = [&](const char* key, double level) {
    const auto& levels = factor.levels;
    const bool inside = factor.range
                            ? level >= factor.range->first && level <= factor.range->second
                            : std::find(levels.begin(), levels.end(), FactorValue(level)) != levels.end();
    if (inside || !reader.has(key)) return true;
    reader.problem(key, "\"" + std::string(key) + "\" has " + text::number(level),
                   factor.range ? "the range of \"" + factor.name + "\" is " +
                                      describe(Range{factor.range->first, factor.range->second})
                                : "a level of \"" + factor.name + "\"");
    return false;
  };
  const auto check_all = [&](const char* key, const std::vector<double>& levels) {
    for (const double level : levels)
      if (!check(key, level)) break;  // one of a list is told
  };
  check_all(spec.kind == Kind::adjustment ? "start" : "values", spec.values);
  check_all("stimuli", spec.stimuli.values);
  if (spec.start) check("start", *spec.start);
  if (spec.min) check("min", *spec.min);
  if (spec.max) check("max", *spec.max);
}

// The procedures' own rules; a fault names its key, dotted for a key of an inner table.
void check_spec(const Value& table, const Spec& spec, text::Findings& findings) {
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
    findings.add(at->place, "procedure \"" + spec.name + "\": \"" + fault.key + "\": " + fault.what,
                 fault.allowed);
  }
}

Spec read_procedure(const Value& table, const Reading& reading, text::Findings& findings) {
  TableReader reader(table, titled("procedure", table), findings);
  Spec spec;
  spec.name = read_name(reader, "name", "a name for the data file");
  reader.take("copy");
  spec.kind =
      procedure::parse_kind(reader.word("kind", procedure::kind_names())).value_or(Kind::constant_stimuli);
  const auto* factor = read_numeric_factor(reader, "level", reading);
  if (factor) spec.level = factor->name;
  switch (spec.kind) {
    case Kind::constant_stimuli:
      read_constant(reader, spec, reading);
      break;
    case Kind::adjustment:
      read_adjustment(reader, spec, reading);
      break;
    case Kind::up_down:
    case Kind::weighted_up_down:
      read_staircase(reader, spec, reading);
      break;
    default:
      read_posterior(reader, spec, reading);
  }
  if (factor && !is_broken(*factor)) check_levels(reader, spec, *factor);
  if (findings.problems.empty()) check_spec(table, spec, findings);
  reader.finish();
  return spec;
}

std::string name_of(const Value& table) {
  const auto* name = table.find("name");
  return name && name->value.kind == Value::Kind::string ? name->value.string : "";
}

// The table with the procedures that it copies below it, which stand above it in the file.
Value with_copies(const Value& table, const std::map<std::string, Value>& above, text::Findings& findings) {
  const auto* copy = table.find("copy");
  if (!copy) return table;
  std::vector<std::string> known;
  for (const auto& [name, value] : above) known.push_back(name);
  const auto found = copy->value.kind == Value::Kind::string ? above.find(copy->value.string) : above.end();
  if (found != above.end()) return overlay(found->second, table);
  findings.add(copy->value.place, "\"copy\" is " + describe(copy->value) + ", which is no procedure above",
               suggestion(copy->value.string, known));
  return table;
}

}  // namespace

void read_procedures(TableReader& file, Reading& reading) {
  std::map<std::string, Value> above;
  std::set<std::pair<int, int>> places;
  for (const auto* table : file.tables("procedure")) {
    const auto name = name_of(*table);
    text::Findings found;
    const auto whole = with_copies(*table, above, found);
    const bool broken_copy = !found.problems.empty();
    Spec spec;
    if (!broken_copy) spec = read_procedure(whole, reading, found);
    // What a copied procedure has wrong stands in the copy too: report each place once.
    for (auto& problem : found.problems)
      if (places.insert({problem.place.line, problem.place.column}).second)
        reading.findings.problems.push_back(std::move(problem));
    auto& defaults = reading.findings.defaults_used;
    defaults.insert(defaults.end(), found.defaults_used.begin(), found.defaults_used.end());
    if (!name.empty() && !above.emplace(name, whole).second)
      reading.findings.add(table->find("name")->place, "a second procedure named \"" + name + "\"",
                           "names must differ");
    else if (!name.empty())
      spec.name = name, reading.protocol.procedures.push_back(std::move(spec));
  }
}

}  // namespace turnpoint::protocol

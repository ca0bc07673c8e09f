#include "station/procedure/grid.hpp"

#include <algorithm>
#include <cmath>

#include "station/core/elementary.hpp"
#include "station/core/number.hpp"

namespace turnpoint::procedure {

using core::phrase, core::plain;

namespace {

using core::TableReader;

core::Phrase forms() {
  return phrase("allowed: %1, %2, %3 or %4",
                {plain("{ from, to, step }"), plain("{ from, to, count }"),
                 plain("{ log_from, log_to, count }"), plain("{ values = [...] }")});
}

// Computes each value as from + i * step, because adding the step again and again would accumulate rounding
// errors.
std::vector<double> even_steps(TableReader& reader, double from, double to) {
  const double step = reader.number("step");
  const double intervals = (to - from) / step;
  if (!(intervals <= most_grid_points - 1)) {
    reader.problem("step", phrase("the grid would have %1 points", {plain(core::number(intervals + 1))}),
                   phrase("at most %1", {plain(most_grid_points)}));
    return {from};
  }
  const double whole = std::round(intervals);
  if (std::fabs(intervals - whole) > 1e-6 || whole < 0)
    reader.problem("to",
                   phrase("the steps from %1 by %2 do not end exactly at %3",
                          {plain(core::number(from)), plain(core::number(step)), plain(core::number(to))}),
                   phrase("a possible end is %1", {plain(core::number(from + std::max(whole, 0.0) * step))}));
  std::vector<double> values;
  for (int i = 0; i <= static_cast<int>(whole); ++i) values.push_back(at_step(from, i, step));
  return values;
}

std::vector<double> linear_axis(TableReader& reader) {
  const double from = reader.number("from"), to = reader.number("to");
  if (reader.has("to") && to < from) {
    reader.problem("to", phrase("%1 is less than %2", {plain("\"to\""), plain("\"from\"")}),
                   phrase("at least %1", {plain(core::number(from))}));
    return {from};
  }
  if (!reader.has("count")) return even_steps(reader, from, to);
  const int count = reader.integer("count");
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(from + (to - from) * i / (count - 1));
  return values;
}

std::vector<double> log_axis(TableReader& reader) {
  const double from = reader.number("log_from"), to = reader.number("log_to");
  const int count = reader.integer("count");
  if (reader.has("log_to") && to <= from) {
    reader.problem("log_to", phrase("\"log_to\" must be greater than \"log_from\""),
                   phrase("above %1", {plain(core::number(from))}));
    return {from};
  }
  std::vector<double> values{from};
  const double first = core::log(from), range = core::log(to) - first;
  for (int i = 1; i + 1 < count; ++i) values.push_back(core::exp(first + range * i / (count - 1)));
  values.push_back(to);
  return values;
}

}  // namespace

double decimal_places(const std::vector<double>& values) {
  constexpr double most = 1e9, largest = 1e15, rounding = 1e-12;
  for (double places = 1; places <= most; places *= 10)
    if (std::ranges::all_of(values, [&](double value) {
          const double scaled = std::fabs(value * places);
          return scaled <= largest &&
                 std::fabs(scaled - std::round(scaled)) <= rounding * std::max(1.0, scaled);
        }))
      return places;
  return 0;
}

double at_step(double from, std::int64_t steps, double step) {
  const double places = decimal_places({from, step});
  if (places == 0 || !(std::fabs(static_cast<double>(steps) * step * places) < 4e15))
    return from + static_cast<double>(steps) * step;
  return static_cast<double>(std::llround(from * places) + steps * std::llround(step * places)) / places;
}

namespace {

/// The form of a grid that a table has, by the first key of each form; nullptr if it has none.
const core::Keys* form_of(const core::Key& grid, const core::Value& table) {
  const core::Keys* found = nullptr;
  for (const auto& form : grid.forms) {
    const auto fits =
        std::ranges::count_if(form.keys->list, [&](const auto& key) { return table.find(key.name); });
    const bool whole = fits == std::ssize(form.keys->list);
    if (table.find(form.keys->list.front().name) && (found == nullptr || whole)) found = form.keys.get();
  }
  return found;
}

}  // namespace

Grid read_grid(const core::Value& table, core::TableReader& outer, const std::string& key) {
  Grid grid;
  const auto name = outer.path(key);
  auto& findings = outer.findings();
  if (table.kind != core::Value::Kind::table) {
    findings.add(table.place, phrase("\"%1\" is %2", {plain(name), describe(table)}), forms());
    return grid;
  }
  const auto* form = form_of(outer.declared(key), table);
  if (form == nullptr) {
    findings.add(table.place, phrase("\"%1\" does not describe a grid", {plain(name)}), forms());
    return grid;
  }
  TableReader reader(table, name, findings, *form);
  if (reader.has("tied")) {
    grid.tied = reader.word("tied");
  } else if (reader.has("values")) {
    grid.values = reader.numbers("values");
    for (std::size_t i = 1; i < grid.values.size(); ++i)
      if (grid.values[i] <= grid.values[i - 1]) {
        reader.problem("values", phrase("\"values\" are not in ascending order"),
                       phrase("each value must be greater than the one before"));
        break;
      }
  } else if (reader.has("log_from")) {
    grid.values = log_axis(reader);
  } else {
    grid.values = linear_axis(reader);
  }
  reader.finish();
  return grid;
}

Prior read_prior(const core::Value& table, core::TableReader& outer, const std::string& key) {
  Prior prior;
  const auto name = outer.path(key);
  auto& findings = outer.findings();
  if (table.kind != core::Value::Kind::table) {
    findings.add(
        table.place, phrase("\"%1\" is %2", {plain(name), describe(table)}),
        phrase("write %1 or %2", {plain("{ normal = { mean, sd } }"), plain("{ weights = [...] }")}));
    return prior;
  }
  TableReader reader(table, name, findings, outer.keys(key));
  const auto* normal = reader.maybe_table("normal");
  prior.weights = reader.maybe_numbers("weights");
  if (normal) {
    TableReader inner(*normal, name + ".normal", findings, reader.keys("normal"));
    const double mean = inner.number("mean");
    prior.normal = {mean, inner.number("sd")};
    inner.finish();
  }
  reader.finish();
  return prior;
}

}  // namespace turnpoint::procedure

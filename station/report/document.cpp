#include "station/report/document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <set>

#include "station/core/number.hpp"
#include "station/report/figure_files.hpp"

namespace turnpoint::report {

std::pair<core::Phrase, core::Phrase> in_known_digits(const Number& number) {
  using core::plain;
  if (!number.interval) return {plain(with_minus(core::number(number.value, number.digits))), {}};
  const auto& [low, high, confidence] = *number.interval;
  const bool endless = number.unbounded && !(std::isfinite(low) && std::isfinite(high));
  const double error = endless ? 0 : core::uncertainty(number.value, low, high);
  const auto shown = [&](double value) {
    if (std::isfinite(value)) return plain(with_minus(core::estimated(value, error)));
    if (!number.unbounded) return core::phrase("report.not_determined");
    return plain(value < 0 ? "\u2212\u221e" : "\u221e");
  };
  return {shown(number.value),
          {"",
           "",
           {plain(number.at_most ? "[\u2264 " : "["), shown(low), plain(number.at_least ? ", \u2265 " : ", "),
            shown(high), plain("]")}}};
}

Cell amount(const std::optional<double>& value, int digits, const char* missing) {
  return count(value ? Text(Number{*value, {}, digits}) : Text(missing));
}

Cell share(const std::optional<double>& value, int digits) {
  return value ? count(Number{100 * *value, {}, digits} + Text(" %")) : count("\u2013");
}

Cell estimated(double value, const analysis::Interval& interval) { return count(Number{value, interval}); }

Cell estimated(const std::optional<analysis::Estimate>& estimate) {
  if (estimate) return estimated(estimate->value, estimate->interval);
  return {core::phrase("report.not_estimated"), Cell::Kind::missing};
}

void Document::remark(const std::vector<analysis::Statement>& statements, const std::string& condition) {
  for (auto statement : statements) {
    if (!condition.empty()) statement.text = {"", "", {core::plain(condition + ": "), statement.text}};
    parts.push_back(std::move(statement));
  }
}

void Document::table(Table added) {
  if (!added.rows.empty()) parts.push_back(std::move(added));
}

void Document::figure(const std::string& file, std::optional<Figure> drawn) {
  if (!drawn) return;
  // the files for a paper have the same caption
  if (has_moved(*drawn) || has_moved(for_paper(*drawn, kOneColumn_mm)) ||
      has_moved(for_paper(*drawn, kTwoColumns_mm)))
    drawn->caption += " " + Words(language)("figure.caption_beside");
  parts.push_back(NamedFigure{file, std::move(*drawn)});
}

std::vector<NamedFigure> figures_of(const Document& document) {
  std::vector<NamedFigure> figures;
  for (const auto& part : document.parts)
    if (const auto* figure = std::get_if<NamedFigure>(&part)) figures.push_back(*figure);
  return figures;
}

Text threshold_label(const LevelAnalysis& data) {
  const auto* key = data.design == Design::two_sided ? "report.pse" : "report.threshold";
  return {in_unit(core::phrase(key), core::plain(data.level_unit)), Text::Look::label};
}

Text slope_label(core::Function function, const LevelAnalysis& data) {
  using core::phrase, core::plain;
  const auto& unit = data.level_unit;
  const auto label = [](core::Phrase name) { return Text(std::move(name), Text::Look::label); };
  if (function == core::Function::normal) return label(in_unit(phrase("report.spread_sd"), plain(unit)));
  if (function == core::Function::weibull) return label(phrase("report.slope_exponent"));
  return label(in_unit(phrase("report.slope"), plain(unit.empty() ? "" : "1/" + unit)));
}

void add_meanings(const SessionData& data, Document& document) {
  List list;
  const auto add = [&list](const LevelAnalysis& part) {
    if (!part.meaning.empty())
      list.items.push_back((part.name.empty() ? "" : part.name + ": ") + part.meaning);
  };
  for (const auto& part : data.parts) add(part);
  if (data.parts.empty()) add(data);
  if (list.items.empty()) return;
  document.say("What the protocol measures:");
  document.parts.push_back(std::move(list));
}

Text early_end(const EarlyEnd& end) {
  return Text(core::phrase("report.ended_early_in", {core::plain(end.block), end.why}));
}

namespace {

/// Says why procedures' own estimates differ from the fit. `thresholds_differ`: see SessionData.
std::string why_estimates_differ(const std::vector<OwnEstimate>& estimates, bool thresholds_differ) {
  using procedure::Choice;
  std::set<Choice> choices;
  std::set<std::string> settles_at;
  for (const auto& [of, estimate, is_brief] : estimates) {
    choices.insert(estimate.choice);
    if (estimate.choice == Choice::track && estimate.settles_at)
      settles_at.insert(core::number(100 * *estimate.settles_at, 3) + " %");
  }
  std::string why;
  if (choices.contains(Choice::posterior)) {
    why +=
        "A procedure with a posterior estimates the mean of that posterior, with the prior and the grid of "
        "the protocol; its 95 % intervals are central. ";
    if (!thresholds_differ)
      why +=
          "The fit uses the same answers, but a prior of its own, which is nearly flat, and shows medians. "
          "The fewer answers there are, the further the two are apart. ";
  }
  if (choices.contains(Choice::track))
    why += "A staircase estimates from the last levels that it tried; the fit uses all answers. ";
  if (choices.contains(Choice::program))
    why +=
        "A separate program estimated by its own method; the fit uses the same answers as the protocol's "
        "analysis says. ";
  if (choices.contains(Choice::series))
    why +=
        "The method of limits takes the middle between the last level with the old answer and the first with "
        "the new one, in each series. If ascending series change at higher levels than descending ones, the "
        "participant tended to repeat answers (habituation); if at lower levels, to expect the change, or "
        "some answers changed by chance. The fit uses all answers, as if neither happened. ";
  if (!settles_at.empty())
    why += fmt::format(
        "A staircase settles where {} of the answers are right (or are the tracked answer), which need not "
        "be the threshold of the fit.",
        fmt::join(settles_at, " or "));
  return why;
}

}  // namespace

void add_own_estimates(std::vector<Column> of, const std::vector<OwnEstimate>& estimates,
                       bool thresholds_differ, Document& document) {
  if (estimates.empty()) return;
  Table table{std::move(of), {}};
  for (const auto* title :
       {"Procedure", "Block", "Parameter", "Estimate, 95 % interval", "Standard deviation", "Taken from"})
    table.columns.emplace_back(title);
  for (const auto& [first, estimate, is_brief] : estimates) {
    const bool level = estimate.parameter.starts_with("threshold") || estimate.parameter == "pse";
    auto parameter = procedure::parameter_name(estimate.parameter);
    if (level || !estimate.unit.empty())
      parameter = in_unit(std::move(parameter), core::plain(estimate.unit));
    auto value = estimate.interval ? estimated(estimate.mean, *estimate.interval)
                 : estimate.sd     ? count(with_minus(core::estimated(estimate.mean, *estimate.sd)))
                                   : amount(estimate.mean);
    value.brief = is_brief;
    auto row = first;
    row.insert(row.end(), {estimate.procedure, estimate.block, parameter, std::move(value),
                           amount(estimate.sd, 2, ""), estimate.basis});
    table.rows.push_back(std::move(row));
  }
  document.table(std::move(table));
  document.explain(why_estimates_differ(estimates, thresholds_differ));
}

}  // namespace turnpoint::report

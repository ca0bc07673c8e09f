#include "station/view/report_pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "station/core/number.hpp"
#include "station/report/figures.hpp"
#include "station/report/words.hpp"
#include "station/session/pages.hpp"
#include "station/view/report_data.hpp"

namespace turnpoint::view {

namespace {

using analysis::Estimate;
using report::Words;
using core::number;

std::string with(double value, const analysis::Interval& interval) {
  const auto shown = [&](double end) {
    return core::estimated(end, core::uncertainty(value, interval.low, interval.high));
  };
  return fmt::format("{} [{}, {}]", shown(value), shown(interval.low), shown(interval.high));
}

std::string with(const std::optional<Estimate>& estimate, const std::string& unit, const Words& words) {
  if (!estimate) return words("report.not_estimated");
  return with(estimate->value, estimate->interval) + (unit.empty() ? "" : " " + unit);
}

/// The name of a measure of speed and accuracy. Abbreviations are the same in every language.
std::string measure_name(const std::string& measure, const Words& words) {
  static const std::map<std::string, const char*> known{{"proportion correct", "report.proportion_right"},
                                                        {"median response time", "report.median_time"},
                                                        {"boundary", "report.boundary"},
                                                        {"time outside the decision", "report.nondecision"},
                                                        {"inverse efficiency", "report.inverse_efficiency"}};
  const auto found = known.find(measure);
  return found == known.end() ? measure : words(found->second);
}

/// Adds statements about one condition, whose name and a colon are in `prefix`.
void add_statements(const std::vector<analysis::Statement>& statements, const std::string& prefix,
                    ReportPages& pages) {
  for (const auto& statement : statements)
    pages.statements.push_back(
        prefix.empty() ? statement.text : core::Phrase{"", "", {core::plain(prefix), statement.text}});
}

void add_outcomes(const report::Summary& summary, const Words& words, ReportPages& pages) {
  const auto& counts = summary.outcomes;
  pages.outcomes = {
      {words("report.presented"), std::to_string(counts.presented)},
      {words("report.answered"), std::to_string(counts.answered)},
      {words("report.late_early"), fmt::format("{}, {}", counts.timeouts, counts.anticipations)},
      {words("report.void"), std::to_string(counts.aborted + counts.faults)}};
  if (const auto& caught = summary.catch_trials)
    pages.outcomes.emplace_back(
        words("report.catch_right"),
        words("report.of", {std::to_string(caught->right), std::to_string(caught->trials)}));
  if (summary.bias && summary.data.choices.size() > 1)
    pages.outcomes.emplace_back(words("report.chose", summary.data.choices[1]),
                                with(summary.bias->share_second, summary.bias->interval));
}

void add_fits(const report::Summary& summary, const Words& words, ReportPages& pages) {
  for (const auto& named : summary.fits) {
    if (!named.fit.parameters) continue;
    const auto prefix = named.name.empty() ? "" : named.name + ": ";
    const auto& p = *named.fit.parameters;
    const auto& part = report::analysis_of(named, summary.data);
    const bool two_sided = part.design == report::Design::two_sided;
    const auto& unit = part.level_unit;
    const auto in_unit = [&unit](const std::string& what) {
      return unit.empty() ? what : what + " (" + unit + ")";
    };
    const auto line = [&](const std::string& what, double value, const auto& interval) {
      pages.fit.emplace_back(prefix + what, interval ? with(value, interval->interval) : number(value, 3));
    };
    line(in_unit(words(two_sided ? "report.pse" : "report.threshold")), p.threshold,
         named.intervals.threshold);
    if (report::slope_estimated(named))
      line(named.fit.options.function == core::Function::normal ? in_unit(words("report.spread"))
                                                                 : words("report.slope"),
           p.slope, named.intervals.slope);
    line(words("report.lapse"), p.lapse, named.intervals.lapse);
    if (auto intervals = report::describe_intervals(named, summary.data); intervals != core::Phrase())
      pages.statements.push_back({"", "", {core::plain(prefix), std::move(intervals)}});
    add_statements(named.fit.statements, prefix, pages);
  }
}

/// Adds the estimates of procedures with a second dimension or a criterion, which no fit has, and which procedures
/// ended early.
void add_estimates(const report::Summary& summary, ReportPages& pages) {
  for (const auto& end : summary.data.early_ends)
    pages.statements.push_back({"", "", {core::phrase("report.ended_early"), core::plain(": "), end.why}});
  for (const auto& estimate : summary.data.estimates) {
    const auto& name = estimate.parameter;
    const bool in_fit = !summary.fits.empty() && name != "criterion" && name != "gradient" && name != "floor";
    if (!estimate.interval || in_fit) continue;
    pages.fit.emplace_back(estimate.procedure + ", " +
                               core::say(session::parameter_name(name), summary.data.language) +
                               (estimate.unit.empty() ? "" : " (" + estimate.unit + ")"),
                           with(estimate.mean, *estimate.interval));
  }
}

void add_judgements(const report::Summary& summary, const Words& words, ReportPages& pages) {
  const auto& unit = summary.data.level_unit;
  for (const auto& judged : summary.judgements) {
    const auto prefix = judged.condition.empty() ? "" : judged.condition + ": ";
    if (judged.exponent)
      pages.fit.emplace_back(prefix + words("report.exponent"), with(judged.exponent, "", words));
    for (const auto& level : judged.levels)
      pages.fit.emplace_back(prefix + number(level.level, 4) + (unit.empty() ? "" : " " + unit),
                             with(level.mean, "", words));
    add_statements(judged.statements, prefix, pages);
  }
}

void add_confusions(const report::Summary& summary, const Words& words, ReportPages& pages) {
  const auto& choices = summary.data.choices;
  for (const auto& confusion : summary.confusions)
    for (const auto& row : confusion.rows)
      if (row.stimulus && row.right)
        pages.fit.emplace_back(
            (confusion.condition.empty() ? "" : confusion.condition + ": ") +
                words("report.right_answer", choices.at(static_cast<std::size_t>(*row.stimulus))),
            with(row.right->value, row.right->interval));
}

void add_trade(const report::Summary& summary, const Words& words, ReportPages& pages) {
  const auto& trade = summary.trade;
  for (const auto& result : trade.instructions) {
    const auto prefix = result.instruction.empty() ? "" : result.instruction + ": ";
    if (!summary.data.scored) continue;
    pages.speed_accuracy.emplace_back(prefix + words("report.proportion_right"),
                                      with(result.proportion_correct, "", words));
    pages.speed_accuracy.emplace_back(prefix + words("report.median_time"),
                                      with(result.median_s, "s", words));
    add_statements(result.statements, prefix, pages);
  }
  for (const auto& difference : trade.differences)
    if (difference.estimate)
      pages.speed_accuracy.emplace_back(
          difference.second + " \u2212 " + difference.first + ": " + measure_name(difference.measure, words),
          with(difference.estimate, difference.unit == "proportion" ? "" : difference.unit, words));
  add_statements(trade.statements, "", pages);
}

void add_finger(const report::Summary& summary, const Words& words, ReportPages& pages) {
  if (!summary.finger) return;
  for (const auto& entry : summary.finger->conditions) {
    const auto prefix = entry.condition.empty() ? "" : entry.condition + ": ";
    const auto line = [&](const char* what, const std::optional<Estimate>& estimate, const char* unit) {
      if (estimate) pages.forces.emplace_back(prefix + words(what), with(estimate, unit, words));
    };
    line("report.normal_force", entry.normal_N, "N");
    line("report.speed", entry.speed_mm_s, "mm/s");
    line("report.friction_smooth", entry.mu_low, "");
    line("report.friction_rough", entry.mu_high, "");
    line("report.felt", entry.shift_mm, "mm");
  }
  add_statements(summary.finger->statements, "", pages);
}

}  // namespace

ReportPages report_pages(const report::Summary& summary) {
  const Words words(summary.data.language);
  ReportPages pages;
  pages.title = summary.data.title + ", " + summary.data.participant;
  pages.run_mode = summary.data.run_mode, pages.status = summary.data.status;
  add_outcomes(summary, words, pages);
  add_fits(summary, words, pages);
  add_estimates(summary, pages);
  add_judgements(summary, words, pages);
  if (summary.data.design == report::Design::categories) add_confusions(summary, words, pages);
  add_trade(summary, words, pages);
  add_finger(summary, words, pages);
  pages.health = summary.data.health;
  if (summary.bias) add_statements(summary.bias->statements, "", pages);
  add_statements(summary.fatigue.statements, "", pages);
  pages.figures = report::figures_of(summary);
  // a session with several instructions is about the trade-off between them
  if (summary.trade.instructions.size() > 1)
    std::stable_partition(pages.figures.begin(), pages.figures.end(),
                          [](const auto& figure) { return figure.name == "speed-accuracy"; });
  return pages;
}

ReportPages report_pages(const std::string& database, const std::string& session_id,
                         const std::string& language) {
  auto data = report_data(database, session_id);
  data.language = language;
  return report_pages(report::summarise(std::move(data)));
}

}  // namespace turnpoint::view

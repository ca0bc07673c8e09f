#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>
#include <string>

#include "station/core/number.hpp"
#include "station/report/figures.hpp"
#include "station/report/html_parts.hpp"
#include "station/report/svg.hpp"

namespace turnpoint::report {

namespace {

std::string bare(double value, const analysis::Interval& interval) {
  const auto shown = [&](double end) {
    return core::estimated(end, core::uncertainty(value, interval.low, interval.high));
  };
  return minus(shown(interval.low)) + " to " + minus(shown(interval.high));
}

}  // namespace

std::string why_estimates_differ(const std::vector<ProcedureEstimate>& estimates, bool thresholds_differ) {
  bool posterior = false, track = false, series = false, program = false;
  std::set<std::string> settles_at;
  for (const auto& estimate : estimates) {
    posterior |= estimate.choice == procedure::Choice::posterior;
    track |= estimate.choice == procedure::Choice::track;
    series |= estimate.choice == procedure::Choice::series;
    program |= estimate.choice == procedure::Choice::program;
    if (estimate.choice == procedure::Choice::track && estimate.settles_at)
      settles_at.insert(number(100 * *estimate.settles_at) + " %");
  }
  std::string why;
  if (posterior) {
    why +=
        "A procedure with a posterior estimates the mean of that posterior, with the prior and the grid of "
        "the protocol; its 95 % intervals are central. ";
    if (!thresholds_differ)
      why +=
          "The fit uses the same answers, but a prior of its own, which is nearly flat, and shows medians. "
          "The fewer answers there are, the further the two are apart. ";
  }
  if (track) why += "A staircase estimates from the last levels that it tried; the fit uses all answers. ";
  if (program)
    why +=
        "A separate program estimated by its own method; the fit uses the same answers as the protocol's "
        "analysis says. ";
  if (series)
    why +=
        "The method of limits takes the middle between the last level with the old answer and the first "
        "with the new one, in each series. If ascending series change at higher levels than descending "
        "ones, the participant tended to repeat answers (habituation); if at lower levels, to expect the "
        "change, or some answers changed by chance. The fit uses all answers, as if neither happened. ";
  if (!settles_at.empty())
    why += fmt::format(
        "A staircase settles where {} of the answers are right (or are the tracked answer), which need not "
        "be the threshold of the fit.",
        fmt::join(settles_at, " or "));
  return why;
}

const char* const kEstimateTitles =
    "<th>Procedure</th><th>Block</th><th>Parameter</th><th>Estimate</th><th>Standard deviation</th>"
    "<th>95 % interval</th><th>Taken from</th>";

std::string estimate_cells(const ProcedureEstimate& estimate) {
  const auto mean =
      estimate.sd ? core::estimated(estimate.mean, *estimate.sd) : core::number(estimate.mean, 3);
  const bool level = estimate.parameter.starts_with("threshold") || estimate.parameter == "pse";
  const auto unit = estimate.unit.empty() && level ? "no unit" : estimate.unit;
  return "<td>" + escaped(estimate.procedure) + "</td><td>" + escaped(estimate.block) + "</td><td>" +
         escaped(estimate.parameter + (unit.empty() ? "" : " (" + unit + ")")) + "</td><td class=\"n\">" +
         minus(mean) + "</td><td class=\"n\">" + (estimate.sd ? number(*estimate.sd, 2) : "") +
         "</td><td class=\"n\">" + (estimate.interval ? bare(estimate.mean, *estimate.interval) : "") +
         "</td><td>" + escaped(estimate.basis) + "</td>";
}

std::string early_end(const EarlyEnd& end) {
  return "<p>Ended early in " + escaped(end.block) + ": " + escaped(core::say(end.why, "en")) + ".</p>\n";
}

std::string estimate_section(const SessionData& data) {
  if (data.estimates.empty() && data.early_ends.empty()) return "";
  std::string html = "<h2>The procedure's own estimate</h2>\n";
  for (const auto& end : data.early_ends) html += early_end(end);
  if (data.estimates.empty()) return html;
  html += std::string("<table><tr>") + kEstimateTitles + "</tr>";
  for (const auto& estimate : data.estimates) html += "<tr>" + estimate_cells(estimate) + "</tr>";
  return html + "</table>\n<p class=\"soft\">" +
         why_estimates_differ(data.estimates, data.thresholds_differ) + "</p>\n";
}

std::string threshold_curve_section(const Summary& summary) {
  const auto& data = summary.data;
  if (data.threshold_curves.empty()) return "";
  std::string html =
      "<h2>Threshold along the second dimension</h2>\n" + picture(threshold_curve_figure(summary));
  for (const auto& curve : data.threshold_curves) {
    html += "<table><tr><th>" + escaped(curve.label) + "</th><th>Threshold, " + escaped(data.level_label) +
            "</th><th>95 % interval</th></tr>";
    for (const auto& point : curve.points)
      html += "<tr><td class=\"n\">" + number(point.second, 4) + "</td><td class=\"n\">" +
              minus(core::estimated(point.threshold, core::uncertainty(point.threshold, point.interval.low,
                                                                       point.interval.high))) +
              "</td><td class=\"n\">" + bare(point.threshold, point.interval) + "</td></tr>";
    html += "</table>\n";
  }
  return html +
         "<p class=\"soft\">Means and central 95 % credible intervals of the procedure's posterior, with the "
         "prior and the grid of the protocol. All answers determine the threshold at each place, because the "
         "procedure assumes that it changes by its gradient.</p>\n";
}

}  // namespace turnpoint::report

#include <cmath>

#include "station/core/number.hpp"
#include "station/report/figures.hpp"
#include "station/report/html_parts.hpp"
#include "station/report/svg.hpp"

namespace turnpoint::report {

namespace {

using analysis::Estimate;
using analysis::FingerCondition;

struct Measure {
  const char* title;
  std::optional<Estimate> FingerCondition::*value;
};
constexpr Measure kMeasures[] = {{"Normal force (N)", &FingerCondition::normal_N},
                                 {"Speed (mm/s)", &FingerCondition::speed_mm_s},
                                 {"Friction on the smooth side (coefficient)", &FingerCondition::mu_low},
                                 {"Friction on the rough side (coefficient)", &FingerCondition::mu_high},
                                 {"Felt minus planned boundary (mm)", &FingerCondition::shift_mm}};

std::string finger_table(const analysis::Finger& finger) {
  std::string html = "<table><tr><th></th>";
  for (const auto& condition : finger.conditions)
    html += "<th>" + escaped(name_of(condition.condition)) + "</th>";
  html += "</tr>";
  for (const auto& [title, value] : kMeasures) {
    html += std::string("<tr><th>") + title + "</th>";
    for (const auto& condition : finger.conditions) html += cell(condition.*value);
    html += "</tr>";
  }
  html += "<tr><th>Trials recorded / with known forces / with a felt boundary</th>";
  for (const auto& condition : finger.conditions)
    html += "<td class=\"n\">" + std::to_string(condition.trials) + " / " +
            std::to_string(condition.measured) + " / " + std::to_string(condition.felt) + "</td>";
  return html + "</tr></table>\n";
}

std::string repeats_table(const std::vector<analysis::RepeatedTrials>& repeats) {
  if (repeats.empty()) return "";
  std::string html =
      "<table><tr><th>Level</th><th>Presented</th><th>Presented again because of the movement</th></tr>";
  for (const auto& at : repeats)
    html += "<tr><th>" + (at.level ? core::number(*at.level, 4) : std::string("none")) +
            "</th><td class=\"n\">" + std::to_string(at.presented) + "</td><td class=\"n\">" +
            std::to_string(at.repeated) + " (" +
            core::number(std::round(100.0 * at.repeated / at.presented), 3) + " %)</td></tr>";
  return html +
         "</table>\n<p class=\"soft\">If some levels are repeated more often than others, the trials that "
         "count are a selection.</p>\n";
}

}  // namespace

std::string finger_section(const Summary& summary) {
  if (!summary.finger) return "";
  const auto& finger = *summary.finger;
  auto html = "<h2>The finger</h2>\n" + finger_table(finger) + picture(finger_figure(summary)) +
              notes(finger.statements);
  if (const auto figure = friction_figure(summary))
    html += picture(figure) +
            "<p class=\"soft\">All conditions together. Filled markers: means of 3 or more trials at one "
            "planned boundary. Open markers: single trials, side by side if they have the same boundary. The "
            "felt boundary is where friction changed under the finger; the planned one is the place that the "
            "scene\u2019s <code>edge</code> names. They should agree for an edge that friction "
            "defines, <code>{ friction = \u2026 }</code>; other edges are defined at other places. Along the "
            "strip: means of "
            "the strokes in bins of 2 mm, with bars of one standard error, where 3 or more strokes were "
            "made.</p>\n";
  html += repeats_table(summary.data.repeats);
  return html +
         "<p class=\"soft\">Answered trials without practice. Force and speed are means over a trial\u2019s "
         "strokes; with more than 40 trials, a marker is the mean of several trials, with a bar from the "
         "smallest to the largest. Friction is lateral force divided by normal force, in the scene "
         "presented last. 95 % intervals: Student\u2019s t over trials; for a single trial, 1.96 standard "
         "errors.</p>\n";
}

}  // namespace turnpoint::report

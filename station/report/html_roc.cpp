#include "station/report/figures.hpp"
#include "station/report/html_parts.hpp"
#include "station/report/svg.hpp"

namespace turnpoint::report {

namespace {

std::string level_of(const analysis::RatedDetection& entry) {
  return entry.level ? number(*entry.level, 4) : "all";
}

std::optional<analysis::Estimate> sensitivity(const std::optional<analysis::RatingFit>& fit) {
  return fit ? std::optional(fit->sensitivity) : std::nullopt;
}

std::string criteria_table(const Summary& summary) {
  std::string rows;
  for (const auto& entry : summary.rocs) {
    if (!entry.equal) continue;
    std::string criteria;
    for (const double criterion : entry.equal->criteria)
      criteria += (criteria.empty() ? "" : ", ") + number(criterion);
    rows += "<tr><td>" + escaped(name_of(entry.condition)) + "</td><td class=\"n\">" + level_of(entry) +
            "</td><td>" + criteria + "</td></tr>";
  }
  if (rows.empty()) return "";
  return "<table><tr><th>Condition</th><th>" + escaped(summary.data.level_label) +
         "</th><th>Criteria between ratings that were given (equal variances; SDs above the mean without a "
         "signal)</th></tr>" +
         rows + "</table>\n";
}

}  // namespace

std::optional<Figure> roc_figure(const Summary& summary) {
  if (summary.rocs.empty()) return std::nullopt;
  Figure figure;
  figure.title = "Receiver operating characteristic";
  figure.chart_width_px = 420, figure.chart_height_px = 420;
  figure.caption = core::text("figure.caption_roc", "en");
  std::string last;
  for (const auto& entry : summary.rocs) {
    if (figure.charts.empty() || entry.condition != last) {
      figure.charts.push_back({name_of(entry.condition), {"False alarms", 0, 1}, {"Hits", 0, 1}, {}});
      last = entry.condition;
    }
    auto& layers = figure.charts.back().layers;
    Line line;
    Points points;
    line.series = points.series = static_cast<int>(layers.size() / 2);
    line.name = level_of(entry);
    for (const auto& point : entry.roc.points) {
      line.x.push_back(point.false_alarms), line.y.push_back(point.hits);
      points.x.push_back(point.false_alarms), points.y.push_back(point.hits);
    }
    layers.push_back(std::move(line));
    layers.push_back(std::move(points));
  }
  return figure;
}

std::string roc_section(const Summary& summary) {
  if (summary.rocs.empty()) return "";
  auto html = "<h2>Receiver operating characteristic</h2>\n" + picture(roc_figure(summary)) +
              "<table><tr><th>Condition</th><th>" + escaped(summary.data.level_label) +
              "</th><th>Area under the curve</th><th>d\u2032, equal variances</th>"
              "<th>d<sub>a</sub>, unequal variances</th><th>SD with a signal</th></tr>";
  for (const auto& entry : summary.rocs)
    html += "<tr><td>" + escaped(name_of(entry.condition)) + "</td><td class=\"n\">" + level_of(entry) +
            "</td>" + cell(entry.roc.area) + cell(sensitivity(entry.equal)) +
            cell(sensitivity(entry.unequal)) +
            cell(entry.unequal ? std::optional(entry.unequal->sd) : std::nullopt) + "</tr>";
  const bool rated = summary.data.design == Design::ratings;
  return html + "</table>\n" + criteria_table(summary) + "<p class=\"soft\">" +
         (rated ? "Ratings go from the surest no to the surest yes."
                : "Answer and confidence together are a rating, from the surest no to the surest yes.") +
         " Each point counts the trials that are rated at least so high: hits with a signal, false alarms "
         "without one. An area of 0.5 is chance. The area is that under straight lines, which is a little "
         "smaller than under a smooth curve; its 95 % interval is that of Newcombe (2006, method 5). d\u2032 "
         "and "
         "d<sub>a</sub> are maximum likelihood fits of normal distributions, without and with a standard "
         "deviation of its own for trials with a signal (1 is that of trials without); their intervals "
         "follow "
         "from the expected information. They are left out where the answers do not determine them.</p>\n";
}

}  // namespace turnpoint::report

#include <algorithm>

#include "station/report/figures.hpp"
#include "station/report/html_parts.hpp"
#include "station/report/svg.hpp"
#include "station/report/words.hpp"

namespace turnpoint::report {

namespace {

using analysis::SpeedAccuracyCurve;

std::string curve_table(const Summary& summary) {
  std::string html =
      "<table><tr><th>Condition</th><th>Asymptote (d\u2032)</th><th>Rate (1/s)</th><th>Intercept "
      "(s)</th></tr>";
  for (const auto& curve : summary.curves)
    html += "<tr><td>" + escaped(name_of(curve.condition)) + "</td>" + cell(curve.asymptote) +
            cell(curve.rate_per_s) + cell(curve.intercept_s) + "</tr>";
  return html + "</table>\n";
}

/// A table with one row for each pair of conditions; "" if there is only one curve.
std::string curve_difference_table(const Summary& summary) {
  const auto& differences = summary.curve_differences;
  if (differences.empty()) return "";
  std::string html =
      "<table><tr><th>Difference</th><th>Asymptote (d\u2032)</th><th>Ratio of rates (no unit)</th>"
      "<th>Intercept (s)</th><th>p if only the asymptote is shared</th><th>rate shared</th>"
      "<th>intercept shared</th></tr>";
  const auto p_cells = [](const analysis::CurveDifference& pair) {
    std::string cells;
    for (std::size_t i = 0; i < pair.p.size(); ++i)
      cells += "<td class=\"n\">" + (pair.p[i] ? number(*pair.p[i]) : std::string("\u2013")) +
               (pair.corrected_p[i] ? ", corrected " + number(*pair.corrected_p[i]) : "") + "</td>";
    return cells;
  };
  for (const auto& pair : differences)
    html += "<tr><td>" + escaped(name_of(pair.second)) + " \u2212 " + escaped(name_of(pair.first)) + "</td>" +
            cell(pair.asymptote) + cell(pair.rate_ratio) + cell(pair.intercept_s) + p_cells(pair) + "</tr>";
  return html + "</table>\n";
}

/// d' by lag and difficulty; "" if there are not two levels or more.
std::string level_table(const Summary& summary) {
  std::string html;
  for (const auto& curve : summary.curves)
    for (std::size_t i = 0; i < curve.by_level.size(); ++i)
      for (const auto& level : curve.by_level[i])
        html += "<tr><td>" + escaped(name_of(curve.condition)) + "</td><td class=\"n\">" +
                number(curve.points[i].lag_s) + "</td><td class=\"n\">" + number(level.level.value_or(0)) +
                "</td>" + cell(level.d_prime) + "</tr>";
  if (html.empty()) return html;
  return "<table><tr><th>Condition</th><th>Signal after (s)</th><th>" + escaped(summary.data.level_label) +
         ", without sign</th><th>d\u2032 (standard deviations)</th></tr>" + html + "</table>\n";
}

std::string lag_table(const Summary& summary) {
  std::string html =
      "<table><tr><th>Condition</th><th>Signal after (s)</th><th>Mean response time (s)</th><th>Trials</th>"
      "<th>d\u2032 (standard deviations)</th></tr>";
  for (const auto& curve : summary.curves)
    for (const auto& point : curve.points) {
      const auto& n = point.counts;
      html += "<tr><td>" + escaped(name_of(curve.condition)) + "</td><td class=\"n\">" + number(point.lag_s) +
              "</td><td class=\"n\">" + number(point.time_s) + "</td><td class=\"n\">" +
              std::to_string(n.hits + n.misses + n.false_alarms + n.correct_rejections) + "</td>" +
              cell(point.d_prime) + "</tr>";
    }
  return html + "</table>\n";
}

}  // namespace

std::optional<Figure> signal_figure(const Summary& summary) {
  Chart chart{"", {}, {}, {}};
  std::vector<double> times{0}, heights{0};
  int series = 0;
  for (const auto& curve : summary.curves) {
    Points points;
    Line line;
    points.series = line.series = series++;
    points.name = line.name = name_of(curve.condition);
    for (const auto& point : curve.points) {
      if (!point.d_prime) continue;
      points.x.push_back(point.time_s), points.y.push_back(point.d_prime->value);
      points.low.push_back(point.d_prime->interval.low), points.high.push_back(point.d_prime->interval.high);
      times.push_back(point.time_s);
      heights.insert(heights.end(), {point.d_prime->interval.low, point.d_prime->interval.high});
    }
    const double last_s = *std::max_element(times.begin(), times.end());
    if (curve.asymptote && curve.rate_per_s && curve.intercept_s)
      for (int i = 0; i <= 200; ++i) {
        line.x.push_back(1.05 * last_s * i / 200);
        line.y.push_back(analysis::d_prime_at(curve.asymptote->value, curve.rate_per_s->value,
                                              curve.intercept_s->value, line.x.back()));
      }
    if (!line.x.empty()) chart.layers.push_back(line);
    chart.layers.push_back(points);
  }
  if (times.size() < 2) return std::nullopt;
  chart.x = report::fitted("Time from response zero to the answer (s)", times, 0.06);
  chart.y = report::fitted("Sensitivity d\u2032", heights, 0.08);
  Figure figure;
  figure.title = "Sensitivity over time";
  figure.chart_width_px = 560;
  figure.caption = Words("en").together({"figure.caption_signal"});
  figure.charts.push_back(std::move(chart));
  return figure;
}

std::string signal_section(const Summary& summary) {
  if (summary.curves.empty()) return "";
  auto html =
      "<h2>Accuracy at the response signal</h2>\n" + picture(signal_figure(summary)) + curve_table(summary);
  html += curve_difference_table(summary);
  for (const auto& curve : summary.curves) html += notes(curve.statements);
  return html + lag_table(summary) + level_table(summary) +
         "<p class=\"soft\">Only answers within the window after the signal are used. The curve is "
         "d\u2032(t) = asymptote (1 \u2212 exp(\u2212rate (t \u2212 intercept))); t is the mean response "
         "time at a lag, so it includes the time that people need to answer the signal. Each lag has its own "
         "criterion. The values are the most probable ones, with 95 % profile intervals. Priors: the "
         "asymptote "
         "is half-normal with a standard deviation of 1.8; the rate is log-normal around 3 per second, with "
         "a "
         "standard deviation of 1.5 in its natural logarithm; the intercept is uniform up to the longest "
         "mean "
         "response time. With few trials a rate is drawn towards 3 per second. An end that the answers do "
         "not "
         "determine is named as such. The p values compare the model in which both conditions share one "
         "parameter with two curves of their own (chi squared, one degree of freedom). d\u2032 at "
         "each lag has the log-linear correction and the interval of Gourevitch and Galanter.</p>\n";
}

}  // namespace turnpoint::report

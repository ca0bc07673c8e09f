#include "station/report/psychometric_parts.hpp"

#include <algorithm>
#include <cmath>

namespace turnpoint::report {

Axis proportion_axis(std::string label, double lowest) {
  Axis axis{std::move(label), std::clamp(lowest - 0.03, -0.03, 0.45), 1.03};
  axis.most = 1;
  return axis;
}

Axis level_axis(std::string label, const std::vector<double>& levels, analysis::Scale scale) {
  return fitted(std::move(label), levels, 0.05,
                scale == analysis::Scale::log10 ? AxisScale::log10 : AxisScale::linear);
}

void add_curve(Chart& chart, const DrawnFunction& drawn, double low, double high,
               std::pair<double, double> presented) {
  constexpr int steps = 120;
  const bool logarithmic = chart.x.scale == AxisScale::log10;
  const auto part = [&](double from, double to, bool beyond) {
    if (!(from < to)) return;
    Line line;
    line.series = drawn.series;
    line.beyond = beyond;
    if (!beyond) line.name = drawn.name;
    for (int i = 0; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      line.x.push_back(logarithmic ? from * std::pow(to / from, share) : from + share * (to - from));
      line.y.push_back(drawn.at(line.x.back()));
    }
    chart.layers.push_back(std::move(line));
  };
  const double first = std::clamp(presented.first, low, high), last = std::clamp(presented.second, low, high);
  part(low, first, true);
  part(first, last, false);
  part(last, high, true);
}

double criterion(const DrawnFunction& drawn) {
  auto parameters = drawn.parameters;
  parameters.guess = drawn.guess, parameters.lapse = 0;
  return analysis::probability(drawn.function, drawn.scale, parameters, parameters.threshold);
}

std::string in_percent(double criterion) { return core::number(100 * criterion, 3) + " %"; }

void add_threshold(Chart& chart, const DrawnFunction& drawn, const analysis::Interval* interval,
                   const LevelAnalysis& data, const Words& words) {
  const double at = drawn.parameters.threshold;
  if (at < chart.x.low || at > chart.x.high) return;
  const auto unit = data.level_unit.empty() ? "" : " " + data.level_unit;
  const auto label = words(data.design == Design::two_sided ? "figure.pse" : "figure.threshold",
                           in_digits(at, interval) + unit + " (" + in_percent(criterion(drawn)) + ")");
  const double height = drawn.at(at);
  chart.layers.push_back(Rule{Rule::Direction::vertical, at,
                              drawn.name.empty() ? label : drawn.name + ": " + label,
                              drawn.name.empty() ? kNeutral : drawn.series, height});
  if (interval != nullptr) chart.layers.push_back(Span{interval->low, interval->high, height, drawn.series});
}

void add_chance(Chart& chart, const LevelAnalysis& data, int alternatives, const std::string& label) {
  if (data.design == Design::forced_choice)
    chart.layers.push_back(Rule{Rule::Direction::horizontal, 1.0 / alternatives, label});
}

bool has_silent_chance(const Figure& figure) {
  return std::any_of(figure.charts.begin(), figure.charts.end(), [](const Chart& chart) {
    return std::any_of(chart.layers.begin(), chart.layers.end(), [](const Layer& layer) {
      const auto* rule = std::get_if<Rule>(&layer);
      return rule != nullptr && rule->label.empty();
    });
  });
}

bool goes_beyond(const Figure& figure) {
  return std::any_of(figure.charts.begin(), figure.charts.end(), [](const Chart& chart) {
    return std::any_of(chart.layers.begin(), chart.layers.end(), [](const Layer& layer) {
      const auto* line = std::get_if<Line>(&layer);
      return line != nullptr && line->beyond;
    });
  });
}

}  // namespace turnpoint::report

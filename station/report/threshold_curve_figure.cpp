#include <map>
#include <utility>

#include "station/report/figures.hpp"
#include "station/report/words.hpp"

namespace turnpoint::report {

namespace {

/// The two answers to a stimulus are drawn beside each other, this share of the axis apart.
constexpr double kApart = 0.014;

/// One marker for all trials with the same stimulus and answer; its area shows how many they are.
Points trials_of(const ThresholdCurve& curve, bool logarithmic) {
  const double apart = kApart * (curve.points.back().second - curve.points.front().second);
  std::map<std::pair<std::pair<double, double>, bool>, int> counts;
  for (const auto& trial : curve.trials)
    if (!logarithmic || trial.level > 0) ++counts[{{trial.second, trial.level}, trial.one}];
  Points points;
  points.series = report::kNeutral;
  for (const auto& [what, count] : counts) {
    points.x.push_back(what.first.first + (what.second ? -0.5 : 0.5) * apart),
        points.y.push_back(what.first.second);
    points.open.push_back(!what.second);
    points.weight.push_back(count);
  }
  return points;
}

Chart panel_of(const ThresholdCurve& curve, const core::Phrase& level_label, const Words& words) {
  Band band;
  Line line;
  for (const auto& point : curve.points) {
    band.x.push_back(point.second), line.x.push_back(point.second);
    line.y.push_back(point.threshold);
    band.low.push_back(point.interval.low), band.high.push_back(point.interval.high);
  }
  const auto points = trials_of(curve, curve.ratios);
  auto seconds = line.x, levels = points.y;
  levels.insert(levels.end(), band.low.begin(), band.low.end());
  levels.insert(levels.end(), band.high.begin(), band.high.end());
  Chart panel;
  panel.title = curve.procedure;
  panel.x = report::fitted(words(curve.label), seconds, 0.06);
  panel.y =
      report::fitted(words(level_label), levels, 0.08, curve.ratios ? AxisScale::log10 : AxisScale::linear);
  panel.layers = {band, points, line};
  return panel;
}

}  // namespace

std::optional<Figure> threshold_curve_figure(const Summary& summary) {
  const Words words(summary.data.language);
  Figure figure;
  figure.title = "Threshold along the second dimension";
  figure.chart_width_px = 620;
  figure.chart_height_px = 340;
  std::size_t trials = 0;
  for (const auto& curve : summary.data.threshold_curves) {
    figure.charts.push_back(panel_of(curve, summary.data.level_label, words));
    trials += curve.trials.size();
  }
  if (figure.charts.empty()) return std::nullopt;
  figure.caption =
      of_trials(summary.data, trials) + " " + words.together({"figure.areas", "figure.caption_posterior"});
  return figure;
}

}  // namespace turnpoint::report

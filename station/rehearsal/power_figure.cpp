#include "station/rehearsal/power_figure.hpp"

#include <algorithm>

#include "station/core/number.hpp"
#include "station/report/words.hpp"

namespace turnpoint::rehearsal {

namespace {

constexpr int bins = 24;

report::Chart panel_of(const Recovery& recovery) {
  report::Chart panel;
  panel.title = recovery.source + ": " + recovery.parameter;
  auto sorted = recovery.estimates;
  std::sort(sorted.begin(), sorted.end());
  // Choose the axis from the values without the lowest and the highest 1 %, because a few values may lie very
  // far out.
  const auto at = [&](double share) {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  };
  std::vector<double> ends{at(0.01), at(0.99)};
  if (recovery.truth) ends.push_back(*recovery.truth);
  panel.x = report::fitted(
      core::say(report::in_unit(core::plain(recovery.parameter), core::plain(recovery.unit)), "en"), ends,
      0.1);
  std::vector<double> shown;
  std::copy_if(sorted.begin(), sorted.end(), std::back_inserter(shown),
               [&](double value) { return value >= panel.x.low && value <= panel.x.high; });
  auto bars = report::histogram(shown, panel.x.low, panel.x.high, bins);
  auto heights = bars.heights;
  heights.push_back(0);
  panel.y = report::fitted("Sessions (number)", heights, 0.05);
  panel.y.low = 0;
  panel.layers.emplace_back(std::move(bars));
  if (recovery.truth)
    panel.layers.emplace_back(report::Rule{report::Rule::Direction::vertical, *recovery.truth,
                                           "truth " + core::estimated(*recovery.truth, ends[1] - ends[0])});
  return panel;
}

}  // namespace

report::Figure figure_of(const Power& power, const std::string& title) {
  report::Figure figure;
  figure.title = title;
  for (const auto& recovery : power.recoveries)
    if (recovery.estimates.size() > 1) figure.charts.push_back(panel_of(recovery));
  figure.columns = 3;
  figure.chart_width_px = 360, figure.chart_height_px = 240;
  figure.caption = title + ". " + std::to_string(power.observers) + " simulated sessions; mean length " +
                   core::number(power.trials, 3) + " trials and " + core::number(power.minutes, 2) +
                   " minutes.";
  return figure;
}

}  // namespace turnpoint::rehearsal

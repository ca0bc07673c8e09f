#include <algorithm>
#include <span>

#include "station/report/figures.hpp"
#include "station/report/words.hpp"

namespace turnpoint::report {

namespace {

using analysis::AtBoundary;

// In a longer session, a marker is the mean of several trials, so that markers do not cover each other.
constexpr std::size_t kMostMarkers = 40;

using Value = std::optional<double> analysis::FingerTrial::*;

struct Reading {
  double trial = 0, value = 0;
};

std::vector<Reading> readings(const analysis::Finger& finger, const std::string& condition, Value value) {
  std::vector<Reading> list;
  for (const auto& trial : finger.trials)
    if (trial.condition == condition && trial.*value)
      list.push_back({trial.trial_index + 1.0, *(trial.*value)});
  return list;
}

/// Adds one marker: the mean of the readings in `group`, with a bar from the smallest to the largest reading.
void add_mean(Points& points, std::span<const Reading> group) {
  Reading mean;
  double low = group.front().value, high = low;
  for (const auto& [trial, value] : group) {
    mean.trial += trial / static_cast<double>(group.size());
    mean.value += value / static_cast<double>(group.size());
    low = std::min(low, value), high = std::max(high, value);
  }
  points.add(mean.trial, mean.value, low, high);
}

/// Divides the readings into groups of `size` successive readings. A reading from another block always begins
/// a new group.
Points grouped(const std::vector<Reading>& list, std::size_t size) {
  Points points;
  std::size_t first = 0;
  for (std::size_t i = 1; i <= list.size(); ++i) {
    const bool apart =
        i < list.size() && list[i].trial - list[i - 1].trial > 4 * static_cast<double>(size) + 1;
    if (i < list.size() && i - first < size && !apart) continue;
    add_mean(points, std::span(list).subspan(first, i - first));
    first = i;
  }
  return points;
}

/// Draws one value over the session, with a series for each condition.
Chart over_session(const analysis::Finger& finger, const Words& words, const char* label, Value value) {
  Chart chart;
  std::vector<double> all, trials;
  const auto size = (finger.trials.size() + kMostMarkers - 1) / kMostMarkers;
  for (std::size_t i = 0; i < finger.conditions.size(); ++i) {
    auto points = grouped(readings(finger, finger.conditions[i].condition, value), size);
    if (points.x.empty()) continue;
    points.series = static_cast<int>(i);
    if (finger.conditions.size() > 1) points.name = finger.conditions[i].condition;
    all.insert(all.end(), points.high.begin(), points.high.end());
    trials.insert(trials.end(), points.x.begin(), points.x.end());
    chart.layers.push_back(std::move(points));
  }
  chart.x = report::fitted(words("figure.trial_in_session"), trials, 0.04);
  chart.x.counts = true;
  all.push_back(0);  // force and speed are shown from 0, so that conditions can be compared by their ratio
  chart.y = report::fitted(words(label), all, 0.12);
  chart.y.low = 0;
  return chart;
}

// Series of figures that pool all conditions. They differ from the first two series, which stand for
// conditions.
constexpr int kSmoothSeries = 2, kRoughSeries = 3;
// distance between the markers of trials with the same planned boundary, as a share of the axis
constexpr double kBeside = 0.02;

/// Returns markers for these values. Values with the same planned boundary stand side by side, so that their
/// bars do not hide each other.
Points markers(const std::vector<AtBoundary>& values, const Axis& along, int series,
               const std::string& name) {
  Points points;
  points.series = series;
  points.name = name;
  for (auto group = values.begin(); group != values.end();) {
    const auto end = std::find_if(group, values.end(),
                                  [&](const AtBoundary& at) { return at.planned_mm != group->planned_mm; });
    double x =
        group->planned_mm - 0.5 * kBeside * (along.high - along.low) * static_cast<double>(end - group - 1);
    for (; group != end; ++group, x += kBeside * (along.high - along.low)) {
      const auto bar = group->interval.value_or(analysis::Interval{group->value, group->value});
      points.add(x, group->value, bar.low, bar.high);
      points.open.push_back(group->trials == 1);
    }
  }
  return points;
}

/// Returns all values and both ends of their intervals.
std::vector<double> extent(const std::vector<AtBoundary>& values) {
  std::vector<double> all;
  for (const auto& at : values) {
    all.push_back(at.value);
    if (at.interval) all.insert(all.end(), {at.interval->low, at.interval->high});
  }
  return all;
}

/// Makes two charts against the planned boundary: the felt minus the planned boundary, and the friction on
/// both sides of it.
std::vector<Chart> boundary_charts(const Summary& summary) {
  const auto& [shift_mm, mu_low, mu_high] = summary.finger->boundaries;
  std::vector<double> planned;
  for (const auto& at : shift_mm) planned.push_back(at.planned_mm);
  const Words words(summary.data.language);
  const auto along = report::fitted(words("figure.planned_boundary"), planned, 0.08);
  Chart felt{words("figure.where_changes"), along, {}, {}}, sides{words("figure.both_sides"), along, {}, {}};
  auto shifts = extent(shift_mm);
  shifts.push_back(0);
  felt.y = report::fitted(words("figure.felt"), shifts, 0.1);
  felt.layers.push_back(Rule{Rule::Direction::horizontal, 0, ""});
  felt.layers.push_back(markers(shift_mm, along, report::kNeutral, ""));
  auto friction = extent(mu_low);
  for (const double value : extent(mu_high)) friction.push_back(value);
  friction.push_back(0);
  sides.y = report::fitted(words("figure.coefficient"), friction, 0.1);
  sides.y.low = 0;
  sides.layers.push_back(markers(mu_low, along, kSmoothSeries, words("figure.smooth_side")));
  sides.layers.push_back(markers(mu_high, along, kRoughSeries, words("figure.rough_side")));
  return {std::move(felt), std::move(sides)};
}

}  // namespace

std::optional<Figure> finger_figure(const Summary& summary) {
  if (!summary.finger) return std::nullopt;
  Figure figure;
  figure.title = "Force and speed of the finger";
  figure.columns = 2;
  figure.chart_width_px = 400;
  figure.chart_height_px = 260;
  const Words words(summary.data.language);
  for (auto chart :
       {over_session(*summary.finger, words, "figure.normal_force", &analysis::FingerTrial::normal_N),
        over_session(*summary.finger, words, "figure.speed", &analysis::FingerTrial::speed_mm_s)})
    if (!chart.layers.empty()) figure.charts.push_back(std::move(chart));
  if (figure.charts.empty()) return std::nullopt;
  const auto trials = summary.finger->trials.size();
  figure.caption = of_trials(summary.data, trials) + " " +
                   words(trials > kMostMarkers ? "figure.caption_finger_means" : "figure.caption_finger");
  return figure;
}

std::optional<Chart> strip_chart(const std::vector<analysis::FrictionCurve>& curves,
                                 const std::string& language) {
  const Words words(language);
  Chart chart;
  chart.title = words("figure.along_strip");
  std::vector<double> along, friction{0};
  for (const auto& curve : curves) {
    if (curve.from_boundary_mm.empty()) continue;
    Points points;
    points.series = static_cast<int>(chart.layers.size());
    points.name = words(curve.narrow ? "figure.towards_narrow" : "figure.towards_wide");
    for (std::size_t i = 0; i < curve.friction.size(); ++i)
      points.add(curve.from_boundary_mm[i], curve.friction[i], curve.friction[i] - curve.se[i],
                 curve.friction[i] + curve.se[i]);
    along.insert(along.end(), points.x.begin(), points.x.end());
    friction.insert(friction.end(), points.high.begin(), points.high.end());
    chart.layers.push_back(std::move(points));
  }
  if (along.empty()) return std::nullopt;
  along.push_back(0);
  chart.x = report::fitted(words("figure.from_boundary"), along, 0.04);
  chart.y = report::fitted(words("figure.coefficient"), friction, 0.1);
  chart.y.low = 0;
  chart.layers.insert(chart.layers.begin(), Rule{Rule::Direction::vertical, 0, words("figure.planned")});
  return chart;
}

std::optional<Figure> friction_figure(const Summary& summary) {
  const auto strip = strip_chart(summary.data.strip, summary.data.language);
  if (!summary.finger || (summary.finger->boundaries.shift_mm.empty() && !strip)) return std::nullopt;
  Figure figure;
  figure.title = "Friction along the strip";
  figure.columns = 2;
  figure.chart_width_px = 400;
  figure.chart_height_px = 300;
  if (!summary.finger->boundaries.shift_mm.empty()) figure.charts = boundary_charts(summary);
  if (strip) figure.charts.push_back(*strip);
  const Words words(summary.data.language);
  figure.caption = of_trials(summary.data, summary.finger->trials.size());
  if (!summary.finger->boundaries.shift_mm.empty()) figure.caption += " " + words("figure.caption_boundary");
  if (strip) figure.caption += " " + words("figure.caption_strip");
  return figure;
}

}  // namespace turnpoint::report

#pragma once
#include <optional>
#include <string>
#include <utility>

#include "station/analysis/psychometric_fit.hpp"
#include "station/report/chart.hpp"
#include "station/report/session_data.hpp"
#include "station/report/words.hpp"

namespace turnpoint::report {

// What charts of the psychometric functions of one participant and of a group have in common.

/// A fitted function, as a chart shows it.
struct DrawnFunction {
  analysis::Function function = analysis::Function::normal;
  analysis::Scale scale = analysis::Scale::linear;
  analysis::Psychometric parameters;
  double guess = 0;  ///< the lower asymptote of a person without lapses
  int series = 0;
  std::string name = {};  ///< in the legend, and with the threshold; "" if there is only one

  double at(double level) const { return analysis::probability(function, scale, parameters, level); }
};

/// The axis of a proportion that nothing drawn is below. It never ends above 0.45.
Axis proportion_axis(std::string label, double lowest);

/// The axis of a function's level, which contains these levels.
Axis level_axis(std::string label, const std::vector<double>& levels, analysis::Scale scale);

/// Adds a curve from `low` to `high`. Below the first and above the last level that was presented it is thin
/// and dashed.
void add_curve(Chart& chart, const DrawnFunction& drawn, double low, double high,
               std::pair<double, double> presented);

/// The proportion that the threshold stands for: that of a person without lapses, as the protocol says it.
double criterion(const DrawnFunction& drawn);
/// The criterion of a threshold in percent, as in the tables: "81.6 %".
std::string in_percent(double criterion);

/// Adds the threshold (or PSE) with its label, which has its criterion, and its interval if there is one: a
/// line from the axis to the curve, in the colour of the function if the chart has several.
void add_threshold(Chart& chart, const DrawnFunction& drawn, const analysis::Interval* interval,
                   const LevelAnalysis& data, const Words& words);

/// Adds the line at the proportion of right answers by guessing, if the task has one. The caption of a figure
/// with several charts says what it is, because a label would take room from the data of some of them.
void add_chance(Chart& chart, const LevelAnalysis& data, int alternatives, const std::string& label);

/// True if a chart of the figure has a rule without a label, such as that of chance.
bool has_silent_chance(const Figure& figure);

/// True if a chart of the figure has a curve beyond the levels presented.
bool goes_beyond(const Figure& figure);

}  // namespace turnpoint::report

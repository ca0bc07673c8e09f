#pragma once
#include <optional>

#include "station/plot/chart.hpp"
#include "station/report/summary.hpp"

namespace turnpoint::report {

/// The figures of a report. Each function returns nothing if there is nothing to show.

/// Proportions by level with Wilson bars, fitted curves with their bands. The area of a marker shows its
/// number of trials.
std::optional<plot::Figure> psychometric_figure(const Summary& summary);
/// Levels in order of presentation, one panel per procedure; open markers are wrong answers.
std::optional<plot::Figure> trace_figure(const Summary& summary);
/// Histograms of response times, one panel per instruction on a common axis.
std::optional<plot::Figure> response_time_figure(const Summary& summary);
/// Settings of a slider in order of presentation with their starting points and their mean.
std::optional<plot::Figure> settings_figure(const Summary& summary);
/// Accuracy against response time: conditional accuracy functions, and the speed-accuracy trade-off by
/// difficulty.
std::optional<plot::Figure> trade_figure(const Summary& summary);

}  // namespace turnpoint::report

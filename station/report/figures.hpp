#pragma once
#include <optional>

#include "station/plot/chart.hpp"
#include "station/report/summary.hpp"

namespace turnpoint::report {

/// The pictures of a report. Each is none where there is nothing to show.

/// Proportions by level with Wilson bars and marker area by trials, fitted curves with their bands.
std::optional<plot::Figure> psychometric_figure(const Summary& summary);
/// Levels in order of presentation, one panel a procedure; open markers are wrong answers.
std::optional<plot::Figure> trace_figure(const Summary& summary);
/// Response-time histograms, one panel an instruction on a common axis.
std::optional<plot::Figure> response_time_figure(const Summary& summary);
/// Settings of a slider in order of presentation beside where it started, with their mean.
std::optional<plot::Figure> settings_figure(const Summary& summary);
/// Accuracy against response time: conditional accuracy functions, and the trade by difficulty.
std::optional<plot::Figure> trade_figure(const Summary& summary);

}  // namespace turnpoint::report

#pragma once
#include <optional>

#include "station/report/chart.hpp"
#include "station/report/summary.hpp"

namespace turnpoint::report {

/// The figures of a report, in the language of its SessionData. Each function returns nullopt if the session
/// has no data for its figure.

/// What all captions of a session's figures begin with: the protocol, whose trials they are, and how many.
std::string of_trials(const SessionData& data, std::size_t trials);

/// Plots the proportion of answers at each level with its Wilson interval, and the fitted curve with its
/// band. The area of a marker is proportional to the number of trials. Each of three or more conditions has a
/// chart of its own, all with the same axes.
std::optional<Figure> psychometric_figure(const Summary& summary);
/// Plots the threshold along the second dimension with its band, one panel per procedure and block. Markers
/// are trials; open markers are answers that were wrong, or not the tracked answer.
std::optional<Figure> threshold_curve_figure(const Summary& summary);
/// Plots the levels in order of presentation, one panel per procedure. Open markers are wrong answers.
std::optional<Figure> trace_figure(const Summary& summary);
/// Draws one histogram of the response times for each instruction. All have the same time axis.
std::optional<Figure> response_time_figure(const Summary& summary);
/// Plots the settings of a slider in order of presentation, with the slider's starting positions and the mean
/// setting.
std::optional<Figure> settings_figure(const Summary& summary);
/// Plots the mean rating, or the geometric mean of the numbers, at each level, with its interval.
std::optional<Figure> judgement_figure(const Summary& summary);
/// Plots the places of the stimuli of a comparison on their scale, with intervals.
std::optional<Figure> scale_figure(const Summary& summary);
/// Plots the level of the measured vibration relative to the planned vibration, in order of presentation.
/// Open markers are trials that are void because of their level.
std::optional<Figure> vibration_figure(const Summary& summary);
/// Plots d' against the response time at each lag of the response signal, and the fitted curve.
std::optional<Figure> signal_figure(const Summary& summary);
/// Plots hits against false alarms for each degree of confidence, with one curve for each level.
std::optional<Figure> roc_figure(const Summary& summary);
/// Plots the serial-dependence curves: how far each stimulus before shifts the answer, with intervals, and
/// the straight line of the regression, in one chart for each condition.
std::optional<Figure> before_figure(const Summary& summary);
/// Plots the share of each answer by stimulus, in one chart for each condition.
std::optional<Figure> confusion_figure(const Summary& summary);
/// Plots accuracy against response time in two panels: the conditional accuracy functions, and one point for
/// the trials of each difficulty.
std::optional<Figure> trade_figure(const Summary& summary);
/// The macro trade: d' over all levels against the median response time, one point for each condition, with
/// intervals in both directions. Empty with fewer than two points.
std::optional<Figure> macro_figure(const Summary& summary);
/// Quantiles of response times over the probability of the answer: right answers on the right, wrong ones on
/// the left, one chart for each condition (Ratcliff & McKoon 2008). Markers are observed, lines predicted.
std::optional<Figure> quantile_probability_figure(const Summary& summary);

/// Plots the normal force and the speed of the finger over the session, with one series for each condition.
/// With more than 40 trials, a marker is the mean of several, with a bar from the smallest to the largest.
std::optional<Figure> finger_figure(const Summary& summary);
/// Plots what the finger met against the planned boundary. The first panel shows the felt minus the planned
/// boundary, the second the friction on both sides; open markers are single trials. A third panel shows the
/// friction along the strip.
std::optional<Figure> friction_figure(const Summary& summary);
/// Plots asked, commanded and felt friction over the place of the finger, in a chart for each scene,
/// condition and direction. Empty if too few intervals have friction anywhere.
std::optional<Figure> followed_figure(const Summary& summary);
/// Plots how far felt is from asked friction over the place of the finger, in a chart for each scene and
/// condition. Empty as followed_figure() is.
std::optional<Figure> deviation_figure(const Summary& summary);
/// True if what was asked for at a place differs clearly between the intervals of one scene and condition.
bool asked_differs(const Summary& summary);
/// Plots friction along the strip beside the planned boundary, with bars of one standard error. Empty without
/// curves.
std::optional<Chart> strip_chart(const std::vector<analysis::FrictionCurve>& curves,
                                 const std::string& language = "en");

}  // namespace turnpoint::report

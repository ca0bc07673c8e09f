#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/confusion.hpp"
#include "station/analysis/course.hpp"
#include "station/analysis/dependence.hpp"
#include "station/analysis/judgements.hpp"
#include "station/analysis/response_signal.hpp"
#include "station/analysis/scaling.hpp"
#include "station/analysis/settings.hpp"
#include "station/analysis/signal_detection.hpp"
#include "station/analysis/trade.hpp"
#include "station/report/session_data.hpp"

namespace turnpoint::report {

/// One psychometric fit, either to all trials or to the trials of one condition.
struct NamedFit {
  std::string name;      ///< name of the condition; "" for all trials
  std::string positive;  ///< the answer whose probability the curve shows
  std::size_t part = 0;  ///< number of its analysis in SessionData::parts
  analysis::PsychometricFit fit;
  analysis::PsychometricIntervals intervals;
};

/// The content of a report. A value that could not be computed is empty, and a statement says why.
struct Summary {
  SessionData data;
  analysis::OutcomeCounts outcomes;
  std::vector<NamedFit> fits;
  std::vector<analysis::Trace> traces;
  std::optional<analysis::Bias> bias;  ///< response bias; only if the task has two answers
  /// confusion matrices; only for three or more answers, or if the answers are categories
  std::vector<analysis::Confusion> confusions;
  std::optional<analysis::Proportion> catch_trials;
  /// proportion of right answers for each degree of confidence
  std::map<int, analysis::Proportion> confidence;
  analysis::Fatigue fatigue;
  analysis::Trade trade;
  std::vector<analysis::CurveDifference> curve_differences;  ///< one for each pair of `curves`
  std::vector<analysis::Detection> detections;               ///< d' and criterion, if the report shows them
  std::vector<analysis::RatedDetection> rocs;  ///< only for yes/no with confidence, if the report shows d'
  std::vector<analysis::Discrimination> discriminations;  ///< d' computed with each model in data.deciding
  /// one for each condition; only with a response signal
  std::vector<analysis::SpeedAccuracyCurve> curves;
  /// for an adjustment task: one entry for each procedure and condition
  std::vector<analysis::Settings> settings;
  /// for ratings and numbers: one entry for each condition
  std::vector<analysis::Judgements> judgements;
  /// for comparisons: one entry for each condition
  std::vector<analysis::StimulusScale> scales;
  /// effects of the trial before, one entry for each condition; empty for three or more answers
  std::vector<analysis::Dependence> dependences;
  /// force and friction of the finger; empty if no force cells recorded data
  std::optional<analysis::Finger> finger;
  /// scenes that follow the finger; empty if none does
  std::vector<analysis::FollowedCondition> followed;
};

/// Returns only the psychometric fits: one to all trials, or one per instruction if there are several
/// instructions. If data.replicates is 0, there are no bootstraps and no bands.
std::vector<NamedFit> fits_of(const SessionData& data);

/// The analysis to which a fit belongs.
const LevelAnalysis& analysis_of(const NamedFit& named, const SessionData& data);

/// True if the report has confusion matrices.
bool has_confusions(const SessionData& data);

/// Returns only the analysis of ratings or numbers; empty for other designs.
std::vector<analysis::Judgements> judgements_of(const SessionData& data);

/// Number of simulated sessions with which a report checks a scale. A study does not check scales.
inline constexpr int kScaleSessions = 499;

/// Returns only the scales from comparisons, checked by so many simulated sessions; empty for other designs.
std::vector<analysis::StimulusScale> scales_of(const SessionData& data, int sessions);

/// How a comparison is scaled; empty for other designs.
std::optional<analysis::ScaleModel> scale_model(Design design, core::Function function);

/// The places of a scale that were estimated, with their stimuli: of differences those between the ends.
std::vector<std::pair<double, analysis::Estimate>> places_of(const analysis::StimulusScale& scale);

// How a study and a power study call the numbers of a scale.
std::string place_name(double stimulus, const std::string& level_unit);
const char* scale_unit(analysis::ScaleModel model);
const char* tendency_unit(analysis::ScaleModel model);
/// What an axis or a column of a scale is called, with its unit if it has one.
core::Phrase place_label(analysis::ScaleModel model);
inline constexpr const char *kPlaceOf = "place of ", *kScaleNoise = "noise of a comparison",
                            *kFavoursSecond = "tendency to answer second", *kNoiseUnit = "SD of the noise";

/// False if the data give only a limit for the slope. The slope then lies on a bound of the
/// maximum-likelihood fit, or the posterior does not determine it.
bool slope_estimated(const NamedFit& named);

/// Says in a sentence or two how the intervals of a fit were computed, and with which prior.
core::Phrase describe_intervals(const NamedFit& named, const SessionData& data);

/// The options for analysing the speed-accuracy trade-off of these data.
analysis::TradeOptions trade_options(const SessionData& data);

/// Speed and accuracy by condition, with what the protocol shows and its corrections.
analysis::Trade trade_of(const SessionData& data, const analysis::TradeOptions& options);

/// The curves at a response signal; empty if the protocol has none or does not show them.
std::vector<analysis::SpeedAccuracyCurve> curves_of(const SessionData& data);

/// The differences of curves, with the corrections of the protocol.
std::vector<analysis::CurveDifference> curve_differences_of(
    const SessionData& data, const std::vector<analysis::SpeedAccuracyCurve>& curves);

/// Analyses one session and computes the parts that the protocol chooses. The result depends only on `data`,
/// seed included. Takes about 0.3 s with 1000 replicates.
Summary summarise(const SessionData& data, int scale_sessions = kScaleSessions);

/// Returns the content of the report as one JSON document. Missing values are null.
std::string to_json(const Summary& summary);
/// The same for a session with several tasks: `tasks` is the list of their reports, without the keys that are
/// about the whole session, which stand beside it.
std::string to_json(const std::vector<Summary>& of_tasks);

}  // namespace turnpoint::report

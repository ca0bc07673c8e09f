#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/course.hpp"
#include "station/analysis/settings.hpp"
#include "station/analysis/signal_detection.hpp"
#include "station/analysis/trade.hpp"
#include "station/report/session_data.hpp"

namespace turnpoint::report {

/// One psychometric fit: of all trials, or of a condition's.
struct NamedFit {
  std::string name;      ///< "" for all
  std::string positive;  ///< what the curve is the probability of
  analysis::PsychometricFit fit;
  analysis::PsychometricIntervals intervals;
};

/// What a report says; whatever could not be had is none, and a statement stands in its place.
struct Summary {
  SessionData data;
  analysis::OutcomeCounts outcomes;
  std::vector<NamedFit> fits;
  std::vector<analysis::Trace> traces;
  std::optional<analysis::Bias> bias;
  std::optional<analysis::Proportion> catch_trials;
  analysis::Fatigue fatigue;
  analysis::Trade trade;
  std::vector<analysis::Detection> detections;  ///< d' and criterion, where they are shown
  std::vector<analysis::Settings> settings;     ///< of an adjustment, one for each procedure and condition
};

/// The psychometric fits alone: of all trials, or of each instruction where there are several. With
/// data.replicates = 0 they come without bootstraps and without bands.
std::vector<NamedFit> fits_of(const SessionData& data);

/// Whether the slope is more than limited: no bound of a maximum-likelihood fit, determined in a posterior.
bool slope_estimated(const NamedFit& named);

/// Which intervals a fit has, and with which prior, in a sentence or two for people.
std::string describe_intervals(const NamedFit& named, const SessionData& data);

/// How the trade of these data is analysed.
analysis::TradeOptions trade_options(const SessionData& data);

/// Analyses one session as far as the protocol wants to see it: deterministic for its seed, about 0.3 s with
/// 1000 replicates.
Summary summarise(const SessionData& data);

}  // namespace turnpoint::report

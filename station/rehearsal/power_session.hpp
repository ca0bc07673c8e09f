#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/analysis/psychometric_fit.hpp"
#include "station/protocol/protocol.hpp"
#include "station/rehearsal/power.hpp"
#include "station/rehearsal/power_truth.hpp"
#include "station/rehearsal/rehearsal.hpp"
#include "station/report/session_data.hpp"
#include "station/report/study.hpp"

namespace turnpoint::rehearsal {

/// One number that the analysis of one session estimated. Source, parameter and unit have the same meaning as
/// in Recovery.
struct Finding {
  std::string source, parameter, unit;
  double value = 0;
  std::optional<analysis::Interval> interval = {};
  std::optional<bool> claimed = {};  ///< of a difference: whether the analysis claims it (Recovery::claimed)
};

using Measures = std::vector<analysis::PersonMeasure>;

/// What the analysis of one simulated session found.
struct SessionOutcome {
  std::vector<Finding> findings;
  GeneratingValues generating;
  /// condition and options of each psychometric fit
  std::vector<std::pair<std::string, analysis::FitOptions>> fits;
  report::Design design = report::Design::forced_choice;
  int presented = 0, scored = 0, right = 0;
  double duration_s = 0;
  std::optional<double> model_p;  ///< analysis::Trade::model_p
  /// for comparisons: whether analysis::ScaleFit::separated is true of one of the scales
  std::optional<bool> separated;
  /// the participant's part of a study; only with PowerOptions::people
  std::optional<report::StudyPerson> person;
  Measures truths;               ///< the true values of this person's measures
  report::SessionData settings;  ///< of session 0: how trials are analysed; without trials
};

/// The blocks of a session in the participant's order, by their names and by the factors that are fixed in
/// them: "main, penalty 1.5 s".
std::vector<std::string> block_labels(const protocol::Protocol& protocol, const protocol::Visit& visit);

/// Answers a question of a trial in the session of this visit.
using VisitAnswerer =
    std::function<simulation::Reply(const protocol::Visit&, const trial::TrialSpec&, simulation::Question)>;

/// Simulates all planned sessions of one participant (from 0) of a study. The observer makes the settings, if
/// the task is an adjustment; `answer` gives all other answers.
std::vector<Rehearsal> planned_sessions(const protocol::Protocol& protocol, std::uint64_t seed,
                                        int participant, const simulation::Observer& observer,
                                        const VisitAnswerer& answer);

/// Simulates session number `session` (from 0) of a study and analyses it. Depends on nothing but its
/// arguments.
SessionOutcome simulate_session(const protocol::Protocol& protocol, const PowerOptions& options, int session);

/// Simulates the sessions of options.part, in order: number - 1, number - 1 + of, number - 1 + 2 of, ... If a
/// stop is requested, there are fewer sessions. Throws like power().
std::vector<SessionOutcome> simulate_sessions(const protocol::Protocol& protocol,
                                              const PowerOptions& options);

/// Summarises sessions 0, 1, 2, ... of a study.
Power power_of(const protocol::Protocol& protocol, const PowerOptions& options,
               const std::vector<SessionOutcome>& outcomes);

/// Completes sessions 0, 1, 2, ... that were read from files of `turnpoint power --part`. The files do not
/// contain the questions of each condition and the options of the fits. To get these, the first session with
/// each condition is simulated again, without intervals.
void complete(const protocol::Protocol& protocol, const PowerOptions& options,
              std::vector<SessionOutcome>& outcomes);

/// Names of the parameters of a curve at a response signal, as in the report of a study.
inline constexpr const char *kAsymptote = "asymptote of d'", *kRate = "rate of d'",
                            *kIntercept = "intercept of d'", *kRateRatio = "ratio of rates of d'";

/// What is true of the person in a session: the measures that the report of a study has, as far as they
/// follow from the person's parameters.
Measures true_measures(const SessionOutcome& outcome, const simulation::Observer& observer,
                       const report::SessionData& settings);

/// Returns the text of Finding::source: `what`, followed by the condition if there is one.
std::string source_of(const std::string& what, const std::string& condition);
/// Returns the text that follows the name of a procedure in Finding::source: ", session 2" for the second of
/// several planned sessions, otherwise "".
std::string session_suffix(const protocol::Protocol& protocol, int number);
/// Returns the name of the parameter d' that was estimated with this model, at this level (with its unit) or
/// over all levels.
std::string d_prime_name(analysis::Deciding model, const std::optional<double>& level,
                         const std::string& unit);
/// "spread" or "slope", whichever the fitted function has.
const char* spread_name(const analysis::FitOptions& options);

}  // namespace turnpoint::rehearsal

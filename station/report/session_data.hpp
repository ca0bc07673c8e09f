#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/analysis/finger.hpp"
#include "station/analysis/followed.hpp"
#include "station/analysis/forced_choice.hpp"
#include "station/analysis/group.hpp"
#include "station/analysis/psychometric_fit.hpp"
#include "station/analysis/speed_accuracy.hpp"
#include "station/analysis/trial_record.hpp"
#include "station/core/texts.hpp"
#include "station/procedure/continuation.hpp"
#include "station/procedure/description.hpp"
#include "station/protocol/meaning.hpp"
#include "station/protocol/protocol.hpp"

namespace turnpoint::report {

using protocol::Design;
using protocol::has_noise;

/// True if the answers are ratings or numbers.
inline bool judges(Design design) { return design == Design::ratings || design == Design::numbers; }

/// True if stimuli are compared with each other, and the answers give a scale.
inline bool scales(Design design) { return design == Design::pairs || design == Design::differences; }

/// A procedure's own estimate from one block, as `turnpoint run` prints it at the end of a session.
struct ProcedureEstimate {
  std::string block, procedure, parameter;
  double mean = 0;           ///< the estimate; a threshold is in the unit of the level
  std::optional<double> sd;  ///< SD of the posterior or of the averaged reversals, or a standard error
  std::string basis;         ///< the data from which it was computed, such as "reversals 5 to 12 of 12"
  std::string unit;          ///< unit of the estimate; "" if it has none
  /// central 95 % credible interval, if the estimate comes from a posterior
  std::optional<analysis::Interval> interval;
  procedure::Choice choice = procedure::Choice::track;  ///< how the procedure chose its levels
  /// the proportion of right (or tracked) answers at the level on which the procedure converges, if known
  std::optional<double> settles_at;
};

/// A procedure that ended although its stopping rules were not met.
struct EarlyEnd {
  std::string block, procedure;
  core::Phrase why;  ///< see procedure::end_in_words()
};

/// The threshold along the second dimension of a procedure in one block, and the answers that it was learned
/// from.
struct ThresholdCurve {
  struct Point {
    double second = 0, threshold = 0;
    analysis::Interval interval;  ///< central 95 % credible interval
  };
  struct Trial {
    double second = 0, level = 0;
    bool one = false;  ///< the answer was right, or the tracked answer
  };
  std::string block, procedure;
  core::Phrase label;   ///< name and unit of the second dimension, for an axis: "Boundary (mm)"
  bool ratios = false;  ///< true if thresholds are compared by their ratio (the procedure's scale)
  std::vector<Point> points;
  std::vector<Trial> trials;
};

/// A name and its text, for the head of a report.
using Fact = std::pair<std::string, std::string>;
/// A fact in a language that is chosen later.
using SpokenFact = std::pair<core::Phrase, core::Phrase>;

/// The measured vibration of a trial's stimuli, compared with the plan.
struct MeasuredTrial {
  int trial_index = 0;
  double level_dB = 0;  ///< measured relative to planned level, of the tone that differs most
  bool counts = true;   ///< false: the vibration was too far from the plan, so the trial is void
};

/// What one analysis of the trials measures, as the protocol decides it (protocol::Meaning).
struct LevelAnalysis {
  std::string name;     ///< "" if the protocol has only one analysis
  std::string meaning;  ///< in words, as `turnpoint check` prints it
  Design design = Design::forced_choice;
  core::Function function = core::Function::weibull;
  analysis::Scale scale = analysis::Scale::linear;
  core::Phrase level_label;  ///< name and unit, for an axis: "Contrast (dB)"
  std::string level_unit;    ///< unit of the level; "" if it has none
  /// If has_noise(): the choice that means "yes". For two sides: the choice that belongs to high levels.
  int positive = 1;
  /// for two sides in 2ifc: the two scenes, of which a trial's interval with one of them is chosen
  std::vector<std::string> scenes;
  double cut = 0;  ///< for two sides: the level at which the right answer changes
  /// for comparisons: the stimuli of each procedure
  std::map<std::string, std::vector<double>> stimuli;
  /// True if the threshold differs between the trials of one condition, because a procedure has a second
  /// dimension. No psychometric function is fitted then.
  bool thresholds_differ = false;
  /// Set if the answers determined the levels: the intervals then come from the posterior under this prior.
  /// Empty if the levels were fixed before the session: the intervals then come from bootstraps.
  std::optional<analysis::Prior> prior;
  /// conditions in the order of the report; each TrialRecord::instruction is one of them
  std::vector<std::string> conditions;
};

/// All data for a report. They come from a database (view/report_data.cpp) or from a simulated session.
struct SessionData : LevelAnalysis {
  /// The analyses, if the protocol has several; TrialRecord::part is a place in this list. What SessionData
  /// itself inherits is then that of the first one, with all conditions.
  std::vector<LevelAnalysis> parts;
  std::string title;  ///< title of the protocol
  std::string task;   ///< "" if the file has one task; otherwise all data are about this one
  std::string participant, session_id, run_mode, status;
  std::string language = "en";  ///< the language of the figures, such as "de"
  std::vector<Fact> facts;      ///< rows for the head of the report: protocol, date, rig, ...
  /// rows for the table "The station": xruns, calibration age, restarts, ...
  std::vector<SpokenFact> health;
  int alternatives = 2;
  /// for 3ifc, 4ifc, ABX and match-to-sample: the models by which the report computes d'
  std::vector<analysis::Deciding> deciding;
  std::vector<std::string> choices;  ///< ids of the choices, in the order of their indices
  /// false for a single-interval task without right answers, such as ratings; the report then leaves out
  /// accuracy
  bool scored = true;
  bool unsure = false;     ///< true if the participant may be unsure instead of guessing
  bool payoff = false;     ///< true if the protocol gives points for answers
  bool signalled = false;  ///< true if a response signal asks for the answers, and so decides when they come
  /// parts of the report that the protocol chooses; if empty, the report has all parts that suit the design
  std::optional<std::vector<std::string>> show;
  std::vector<ProcedureEstimate> estimates;
  std::vector<EarlyEnd> early_ends;
  std::vector<ThresholdCurve> threshold_curves;  ///< empty if no procedure has a second dimension
  std::vector<analysis::TrialRecord> trials;
  /// of a study with several tasks: the trials of the others, by which the rules of exclusion judge the
  /// person
  std::vector<analysis::TrialRecord> other_trials;
  /// answered trials, without practice, in which force cells recorded data; empty if the rig has no force
  /// cells
  std::vector<analysis::FingerTrial> finger;
  /// friction along the strip; empty if no force cells recorded data
  std::vector<analysis::FrictionCurve> strip;
  /// answered trials, without practice, whose scenes follow the finger
  std::vector<analysis::FollowedTrial> followed;
  /// friction over place in these trials; empty if no scene asks for friction, or too few trials have it
  std::vector<analysis::FollowedPlaces> followed_places;
  /// trials repeated because of the finger's movement, by level; empty if the protocol repeats none
  std::vector<analysis::RepeatedTrials> repeats;
  /// measured vibration of each trial; empty if no pick-up measured the surface
  std::vector<MeasuredTrial> measured;
  analysis::TimeExclusion exclusion;
  protocol::Holm holm = protocol::Holm::none;  ///< which comparisons are corrected together
  std::uint64_t seed = 1;                      ///< seed of the bootstraps' random numbers
  int replicates = 1000;
};

/// The data of one analysis: its trials and conditions only. `part` is a place in data.parts; 0 if there are
/// none.
SessionData part_of(const SessionData& data, std::size_t part);

/// True if the report contains this part: "psychometric", "ez", "bis", "lisas", "ies", "caf", "dprime",
/// "response-signal" or "trace", which the protocol may choose, or "points", which a payoff decides. If the
/// protocol does not choose the parts, the report contains all of them, with two exceptions: d' only for
/// yes/no tasks and where `deciding` has a model, and the diffusion model only for two answers that come
/// without a response signal.
bool shows(const SessionData& data, const std::string& part);

/// Corrects the p values of comparisons, each with its measure, as the protocol asks for. All are empty if it
/// does not ask.
std::vector<std::optional<double>> corrected(const SessionData& data, std::vector<analysis::Tested> tests);

}  // namespace turnpoint::report

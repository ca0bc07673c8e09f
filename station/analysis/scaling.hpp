#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/estimate.hpp"
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// How the answers of comparisons follow from the places of the stimuli on a scale.
enum class ScaleModel {
  /// Pairs: the log odds of an answer are the difference of the two values (Bradley & Terry 1952).
  bradley_terry,
  /// Pairs: both are felt with independent normal noise of the same standard deviation, which is the unit of
  /// the scale (Thurstone 1927, case V). A difference of values is a d'.
  thurstone,
  /// Triads and quadruples: the two differences are compared with normal noise (maximum-likelihood difference
  /// scaling, Maloney & Yang 2003). The scale runs from 0 at the first stimulus to 1 at the last.
  differences
};

/// One answered comparison: of two stimuli, of the difference of the first two of three with that of the last
/// two, or of the difference of the first two of four with that of the other two.
struct Compared {
  std::vector<int> stimuli;  ///< indexes in order of presentation; stimuli are numbered in ascending order
  bool second = false;       ///< the answer: the second stimulus, or the second difference
};

/// A scale with intervals by the profile of the penalised likelihood, at 95 %.
struct ScaleFit {
  /// one for each stimulus. Pairs: the mean of all is 0. Differences: 0 at the first stimulus, 1 at the last
  std::vector<Estimate> values;
  /// for differences: standard deviation of the noise with which two differences are compared, in units of
  /// the scale
  std::optional<Estimate> noise;
  /// how much the place of presentation favours the answer "second": in the unit of the values or, for
  /// differences, in standard deviations of the noise; empty if the order of presentation does not tell
  std::optional<Estimate> favours_second;
  double log_likelihood = 0;  ///< of the trials, without the penalty
  /// twice the log likelihood that a model without restrictions has more, over trials of the same
  /// presentation
  double deviance = 0;
  int degrees = 0;  ///< number of different presentations minus number of parameters
  /// True if the answers set no limit to some distance, because no answers contradict each other there: a
  /// stimulus that was always chosen, two groups of stimuli that were never confused, a scale of differences
  /// without an inconsistent answer. Places and the ends of intervals are then finite by the prior alone, and
  /// can miss the truth far more often than they say.
  bool separated = false;
  /// fitted probability of the answer "second" of each trial
  std::vector<double> probabilities;
};

/// Fits a scale of `stimuli` stimuli by maximum likelihood with Jeffreys' prior as a penalty (Firth 1993;
/// Kosmidis & Firth 2021), so that all values are finite, if need be by the prior alone
/// (ScaleFit::separated). Empty if the comparisons do not connect all stimuli or, for differences, if the
/// last stimulus is not reliably above the first. Throws std::invalid_argument for wrong indexes or numbers
/// of stimuli.
std::optional<ScaleFit> fit_scale(const std::vector<Compared>& trials, int stimuli, ScaleModel model);

/// Trials of one presentation, with the number of answers "second" that is expected of an observer.
struct ExpectedComparisons {
  std::vector<int> stimuli;
  double trials = 1, second = 0;
};

/// The scale that unlimited trials with these expected answers would give.
struct LimitingScale {
  std::vector<double> values;
  std::optional<double> noise, favours_second;
};

/// Fits the scale without a penalty. Empty if the trials do not determine it. Throws like fit_scale().
std::optional<LimitingScale> limiting_scale(const std::vector<ExpectedComparisons>& trials, int stimuli,
                                            ScaleModel model);

/// Whether a model describes the answers, by simulated sessions that follow the fit.
struct ScaleCheck {
  double deviance_p = 0;  ///< share of simulated sessions with at least this deviance
  /// Number of runs of answers above or below what was expected, with the trials in ascending order of what
  /// was expected. A scale of the wrong shape has few (Maloney & Yang 2003; Wood 2006).
  int runs = 0;
  double runs_p = 0;  ///< share of simulated sessions with at most so many runs
  /// For quadruples: number of sets of two times three stimuli a < b < c and d < e < f of which the three
  /// trials ab de, bc ef and ac df were presented. Where ab is the larger one of the first two differences,
  /// and bc of the second, so must be ac of the third (Maloney & Yang 2003, six-point property).
  int six_points = 0;
  /// Share of simulated sessions whose answers, in these sets, are at most as likely under their fit; empty
  /// without sets
  std::optional<double> six_points_p;
  int sessions = 0;  ///< number of simulated sessions
};

/// Simulates sessions that follow the fit, and fits each of them.
ScaleCheck check_scale(const std::vector<Compared>& trials, int stimuli, ScaleModel model,
                       const ScaleFit& fit, int sessions = 499);

/// How far the choices between pairs contradict every scale. In a triple a, b, c with a chosen over b and b
/// over c in at least half of the trials, a should be chosen over c in at least half (weak transitivity), as
/// often as in the weaker of the two (moderate), or as in the stronger (strong).
struct Transitivity {
  int triples = 0;                             ///< all of whose pairs were compared
  int circular = 0, moderate = 0, strong = 0;  ///< triples that violate the weak one, and the others
  /// Kendall's coefficient of consistence: 1 without circular triples, 0 with as many as possible; empty if
  /// some pair was not compared
  std::optional<double> consistence;
};

Transitivity transitivity(const std::vector<Compared>& trials, int stimuli);

/// Code of the remark that ScaleFit::separated is true.
inline constexpr const char* kSeparated = "separated";

/// The scale of one condition.
struct StimulusScale {
  std::string condition;
  ScaleModel model = ScaleModel::bradley_terry;
  std::vector<double> stimuli;         ///< values of the factor, ascending
  std::vector<int> chosen, presented;  ///< for pairs: by stimulus
  int trials = 0;
  std::optional<ScaleFit> fit;
  std::optional<ScaleCheck> check;
  std::optional<Transitivity> transitivity;  ///< for pairs
  std::vector<Statement> statements;
};

/// Analyses the answered experimental trials that compared stimuli (TrialRecord::compared), one entry for
/// each condition, checked by so many simulated sessions (0: not checked, as are scales without a degree of
/// freedom). Conditions in `order` come first.
/// `designs` has the stimuli of procedures: all of them belong to the scale of a condition in which the
/// procedure has trials, so that a session that ended early has no scale of fewer stimuli.
std::vector<StimulusScale> scales(const std::vector<TrialRecord>& trials,
                                  const std::vector<std::string>& order, ScaleModel model, int sessions = 499,
                                  const std::map<std::string, std::vector<double>>& designs = {});

}  // namespace turnpoint::analysis

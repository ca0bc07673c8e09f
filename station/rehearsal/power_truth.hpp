#pragma once
#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/analysis/psychometric_fit.hpp"
#include "station/analysis/scaling.hpp"
#include "station/analysis/signal_detection.hpp"
#include "station/protocol/protocol.hpp"
#include "station/simulation/observer.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::rehearsal {

/// The level on which a procedure would converge with this observer in unlimited trials. There is none, and
/// the result is empty, in three cases: for constant stimuli, if a step up takes several wrong answers, or if
/// the probability of the tracked answer does not depend on the level.
std::optional<double> settled_level(const protocol::Protocol& protocol, const procedure::Spec& spec,
                                    const simulation::Observer& observer);

/// True if no fit of the report has the parameters that the procedure estimates: it has a second dimension or
/// a criterion.
bool has_parameters_of_its_own(const procedure::Spec& spec);

/// The true values of the parameters of a procedure with a posterior, as far as the observer has them. The
/// slope and the criterion are only included if the observer's function is of the procedure's family.
std::map<std::string, double> true_parameters(const protocol::Protocol& protocol, const procedure::Spec& spec,
                                              const simulation::Observer& observer);

/// The true values for a fit; empty if the observer has no such value.
struct FitTruth {
  std::optional<double> threshold, slope, level_75;
};

/// Computes the true values that produced the answers of each condition. They come from the observer's own
/// functions. The proportion correct is the mean of the observer's probabilities in the presented trials.
class GeneratingValues {
 public:
  void add(const protocol::Protocol& protocol, const trial::TrialSpec& trial,
           const simulation::Question& question, const simulation::Observer& observer);
  void add(const GeneratingValues& other);

  /// The trials at one lag of the response signal: their number and the sum of the probabilities of "yes", in
  /// trials in which it is wrong and in which it is right; and the sum of the expected times of the answers.
  struct Lag {
    double time_s = 0;
    std::array<double, 2> trials{}, yes{};
  };

  /// Sums over the trials of one condition. Sums of several sessions can be added. They do not contain the
  /// questions that were asked.
  struct Sum {
    double deadline_s = 0;               ///< deadline of the condition's first trial
    std::optional<double> caution = {};  ///< simulation::Question::caution of that trial
    bool one_bound = true;               ///< both are the same in all trials, and there is no response signal
    int trials = 0;
    double correct = 0;
    /// by difficulty: the drift towards the right answer (s = 0.1); NaN if it is not the same in all trials
    std::map<double, double> drifts;
    std::map<double, Lag> lags;  ///< by the time of the response signal
    /// by the stimuli that were compared, in order of presentation: number of trials, and sum of the
    /// probabilities of the answer "second"
    std::map<std::vector<double>, std::array<double, 2>> comparisons;
  };
  std::map<std::string, Sum> sums() const;
  static GeneratingValues of_sums(const std::map<std::string, Sum>& sums);
  /// Copies from `other` the observer's questions for the conditions that both objects have.
  void take_questions(const GeneratingValues& other);
  /// true if all conditions of `other` are also in this object
  bool has_all_of(const GeneratingValues& other) const;

  /// Returns the true values that a fit with these options should find in the answers of this condition (""
  /// means all trials). The slope is set only if the observer's function is of the same family as the fitted
  /// one; a deadline changes the family.
  FitTruth fit(const std::string& condition, const analysis::FitOptions& options,
               const simulation::Observer& observer) const;
  std::optional<double> share_correct(const std::string& condition) const;
  /// The observer's probability of a right answer at one level; only for tasks in which the level decides how
  /// easy the right answer is to find.
  std::optional<double> share_correct_at(const std::string& condition, double level,
                                         const simulation::Observer& observer) const;
  /// The true boundary separation of the diffusion model (with the scaling parameter s = 0.1).
  std::optional<double> boundary(const std::string& condition, const simulation::Observer& observer) const;
  /// The mean over the difficulties of the drift towards the right answer, per s, with s = 0.1. Empty if it
  /// differs between trials of one difficulty.
  std::optional<double> drift(const std::string& condition) const;
  /// Asymptote, rate per s and intercept in s of the curve at a response signal (analysis::limiting_curve()).
  /// The observer's own curve has another shape than the fitted one, so this is the one that fits best.
  std::optional<std::array<double, 3>> curve(const std::string& condition) const;
  /// The true values of a scale, by the names that a study gives them: those that unlimited trials would give
  /// (analysis::limiting_scale()). They contain lapses, and what a deadline does.
  std::map<std::string, double> scale(const std::string& condition, analysis::ScaleModel model,
                                      const std::string& level_unit) const;

 private:
  struct Condition {
    simulation::Question question;  ///< question that the first trial asks the observer
    Sum sum;
    analysis::Detecting detecting = analysis::Detecting::forced_choice;
  };
  static void add(const Sum& more, Sum& sum);
  const Condition* find(const std::string& condition) const;
  std::map<std::string, Condition> conditions_;
};

}  // namespace turnpoint::rehearsal

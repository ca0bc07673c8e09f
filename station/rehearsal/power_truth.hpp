#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/analysis/psychometric_fit.hpp"
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

  /// Sums over the trials of one condition. Sums of several sessions can be added. They do not contain the
  /// questions that were asked.
  struct Sum {
    double deadline_s = 0;  ///< deadline of the condition's first trial
    bool one_deadline = true;
    int trials = 0;
    double correct = 0;
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

 private:
  struct Condition {
    simulation::Question question;  ///< question that the first trial asks the observer
    bool one_deadline = true;
    int trials = 0;
    double correct = 0;
  };
  const Condition* find(const std::string& condition) const;
  std::map<std::string, Condition> conditions_;
};

}  // namespace turnpoint::rehearsal

#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/analysis/psychometric_fit.hpp"
#include "station/observer/observer.hpp"
#include "station/protocol/protocol.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::simulation {

/// The level on which a procedure would converge with this observer and unlimited trials; empty if there is
/// none (constant stimuli, several wrong answers needed for a step up, a tracked answer that does not depend
/// on the level).
std::optional<double> settled_level(const protocol::Protocol& protocol, const procedure::Spec& spec,
                                    const observer::Observer& observer);

/// The true values for a fit; empty if the observer has no such value.
struct FitTruth {
  std::optional<double> threshold, slope, level_75;
};

/// The values that produced the answers, by condition: the observer's own functions and, for the proportion
/// correct, its probabilities in the presented trials.
class GeneratingValues {
 public:
  void add(const protocol::Protocol& protocol, const trial::TrialSpec& trial,
           const observer::Question& question, const observer::Observer& observer);
  void add(const GeneratingValues& other);

  /// True values for a fit with these options to the answers of a condition ("" for all trials). The slope is
  /// set only if the observer's function is of the same family; with a deadline it is not.
  FitTruth fit(const std::string& condition, const analysis::FitOptions& options,
               const observer::Observer& observer) const;
  std::optional<double> share_correct(const std::string& condition) const;
  /// EZ's boundary separation for s = 0.1.
  std::optional<double> boundary(const std::string& condition, const observer::Observer& observer) const;

 private:
  struct Condition {
    observer::Question question;  ///< question of the first trial
    bool one_deadline = true;
    int trials = 0;
    double correct = 0;
  };
  const Condition* find(const std::string& condition) const;
  std::map<std::string, Condition> conditions_;
};

}  // namespace turnpoint::simulation

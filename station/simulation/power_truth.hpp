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

/// The level at which a procedure would settle with this observer and unlimited trials; none where it has no
/// such level (constant stimuli, several answers up, a tracked answer that no level decides).
std::optional<double> settled_level(const protocol::Protocol& protocol, const procedure::Spec& spec,
                                    const observer::Observer& observer);

/// What a fit should find; none where the observer has no such value.
struct FitTruth {
  std::optional<double> threshold, slope, level_75;
};

/// The values that made the answers, by condition: the observer's own functions and, for the proportion
/// correct, its probabilities on the trials that were presented.
class GeneratingValues {
 public:
  void add(const protocol::Protocol& protocol, const trial::TrialSpec& trial,
           const observer::Question& question, const observer::Observer& observer);
  void add(const GeneratingValues& other);

  /// Of a fit with these options to the answers of a condition ("" for all trials). The slope only where the
  /// observer's function is of the same family, which a deadline takes it out of.
  FitTruth fit(const std::string& condition, const analysis::FitOptions& options,
               const observer::Observer& observer) const;
  std::optional<double> share_correct(const std::string& condition) const;
  /// EZ's boundary separation for s = 0.1.
  std::optional<double> boundary(const std::string& condition, const observer::Observer& observer) const;

 private:
  struct Condition {
    observer::Question question;  ///< of the first trial
    bool one_deadline = true;
    int trials = 0;
    double correct = 0;
  };
  const Condition* find(const std::string& condition) const;
  std::map<std::string, Condition> conditions_;
};

}  // namespace turnpoint::simulation

#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/analysis/psychometric_fit.hpp"
#include "station/observer/observer.hpp"
#include "station/protocol/protocol.hpp"
#include "station/session/director.hpp"

namespace turnpoint::app {

/// The level at which a procedure would settle with this observer and unlimited trials; none where it has no
/// such level (constant stimuli, several answers up, a tracked answer that no level decides).
std::optional<double> settled_level(const protocol::Protocol& protocol, const procedure::Spec& spec,
                                    const observer::Observer& observer);

/// What the observer does on the mean at each level that was presented, by instruction.
class ExpectedAnswers {
 public:
  void add(const protocol::Protocol& protocol, const session::TrialSpec& trial,
           const observer::Question& question, const observer::Observer& observer);
  void add(const ExpectedAnswers& other);

  enum class Count { correct, choice };
  /// The fit, with these options, of endless data with the same shares at the same levels. With
  /// Count::choice the answer is counted whose share rises with the level.
  std::optional<analysis::Psychometric> fit(const std::string& instruction,
                                            const analysis::FitOptions& options, Count count) const;

 private:
  struct Sum {
    double trials = 0, correct = 0, second = 0;
  };
  std::map<std::pair<std::string, double>, Sum> sums_;
};

}  // namespace turnpoint::app

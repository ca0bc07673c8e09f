#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/terms/trial.hpp"

namespace turnpoint::analysis {

using terms::Outcome;
using terms::TrialType;

/// One presented trial as an analysis sees it; times in seconds. What was not there is std::nullopt: a
/// timeout has neither response nor response time nor score.
struct TrialRecord {
  int trial_index = 0;  ///< order of presentation within the session, from 0
  int block_index = 0;
  std::string block;
  TrialType type = TrialType::experimental;
  std::string procedure;
  std::optional<double> level;      ///< in the unit of the protocol's factor; signed where it has two sides
  std::optional<int> right_choice;  ///< index of the choice that is right; none where no choice is
  std::optional<int> response;      ///< index of the choice that was made
  std::optional<bool> correct;
  std::optional<double> setting;  ///< of a slider, in the unit of the level, which is where it began
  Outcome outcome = Outcome::answered;
  std::optional<double> response_time_s;
  std::string instruction;           ///< the condition: by what trials are told apart; "" for all alike
  std::optional<double> difficulty;  ///< equal for trials of equal difficulty, |level| as a rule
};

/// The conditions of experimental trials: those of the order first, then others in the order first met.
std::vector<std::string> conditions_of(const std::vector<TrialRecord>& trials,
                                       const std::vector<std::string>& order);

/// Something that must be said beside, or instead of, a number: a stable code and a sentence for people.
struct Statement {
  std::string code;
  std::string text;
};

/// Both ends of an interval at a stated confidence.
struct Interval {
  double low = 0, high = 0;
  double confidence = 0.95;
};

}  // namespace turnpoint::analysis

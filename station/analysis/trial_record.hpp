#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/core/texts.hpp"
#include "station/core/trial.hpp"

namespace turnpoint::analysis {

using core::Outcome;
using core::TrialType;

/// The side from which a slider started: one of the protocol's starts below, or one of its starts above;
/// `none` if the trial has no slider or its start is in neither list.
enum class StartSide { none, below, above };

/// One presented trial as the analysis sees it; times in seconds. Missing values are std::nullopt: a timeout
/// has no response, response time or score.
struct TrialRecord {
  int trial_index = 0;  ///< order of presentation within the session, from 0
  int block_index = 0;
  std::string block;
  TrialType type = TrialType::experimental;
  std::string procedure;
  /// level of the stimulus in the unit of the protocol's factor; signed if it has two sides, such as left and
  /// right
  std::optional<double> level;
  std::optional<int> right_choice;  ///< index of the correct choice; empty if there is none
  std::optional<int> response;      ///< index of the chosen answer
  std::optional<bool> correct;
  bool unsure = false;  ///< the participant did not want to guess; then there is no response
  /// whether there was a signal, in a task in which people rate how sure they are of one; otherwise empty
  std::optional<bool> present;
  /// final position of a slider in the unit of the level; `level` is its starting position
  std::optional<double> setting;
  std::optional<int> confidence;  ///< from 1 for the least sure; empty if the task does not ask
  Outcome outcome = Outcome::answered;
  std::optional<double> response_time_s;
  double duration_s = 0;         ///< length of the whole trial, with the pause after it
  std::optional<double> points;  ///< what the result was worth; empty if the protocol gives no points
  std::optional<double>
      deadline_s;             ///< longest response time that the trial accepted; empty if it had no limit
  double anticipation_s = 0;  ///< an answer before this time is an anticipation
  /// time of the response signal, counted from the zero of response times (response_zero); empty if there is
  /// none
  std::optional<double> signal_s;
  /// the condition by which the analysis groups trials; "" if there is only one
  std::string instruction;
  /// a number that is the same for trials of equal difficulty; usually the absolute value of the level
  std::optional<double> difficulty;
  StartSide start_side = StartSide::none;
  /// For two intervals of which the level decides which one is right: the number of the chosen and of the
  /// right scene; empty if no interval was right, or without an answer.
  std::optional<int> chosen_scene, right_scene;
  /// the stimuli of a comparison in order of presentation, as levels; empty if the task compares none. The
  /// answer is then 0 for the first stimulus or difference, 1 for the second
  std::vector<double> compared = {};
  std::size_t part = 0;   ///< number of the analysis to which the trial belongs; 0 if there is only one
  int segment_index = 1;  ///< number of the program run, from 1; a session that was resumed has several
};

/// Whether `now` was presented just after `before`, in the same block and without an interruption of the
/// session.
inline bool follows(const TrialRecord& before, const TrialRecord& now) {
  return now.block_index == before.block_index && now.segment_index == before.segment_index &&
         now.trial_index == before.trial_index + 1;
}

/// Whether an analysis of answers counts the trial: it is no practice and no catch trial, and was answered.
inline bool counted(const TrialRecord& trial) {
  return trial.type == TrialType::experimental && trial.outcome == Outcome::answered;
}

/// Returns the conditions of the experimental trials: first those in `order`, then the others in the order in
/// which they first occur.
std::vector<std::string> conditions_of(const std::vector<TrialRecord>& trials,
                                       const std::vector<std::string>& order);

/// A remark that the report shows beside a number or instead of it: a stable code and a sentence for people.
struct Statement {
  std::string code;
  core::Phrase text;
};

/// Both ends of an interval at a given confidence.
struct Interval {
  double low = 0, high = 0;
  double confidence = 0.95;
};

}  // namespace turnpoint::analysis

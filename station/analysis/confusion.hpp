#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/course.hpp"
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// How often each answer was given to one kind of stimulus.
struct ConfusionRow {
  std::optional<int> stimulus;      ///< the choice that is right; empty if no choice is right
  std::optional<double> level;      ///< the presented level; set if no choice is right
  std::vector<int> answers;         ///< number of trials with each answer, by index of the choice
  int trials = 0;                   ///< sum of `answers`
  std::optional<Proportion> right;  ///< proportion correct; empty if no choice is right
};

/// The confusion matrix of one condition.
struct Confusion {
  std::string condition;
  std::vector<ConfusionRow> rows;   ///< in the order of the choices, or in ascending order of the level
  std::optional<Proportion> right;  ///< proportion correct of all trials with a right answer
};

/// Counts the answers in answered experimental trials, with one row for each right choice or, in trials
/// without a right choice, for each level. Returns one matrix for each condition; conditions in `order` come
/// first.
std::vector<Confusion> confusions(const std::vector<TrialRecord>& trials,
                                  const std::vector<std::string>& order, int choices);

}  // namespace turnpoint::analysis

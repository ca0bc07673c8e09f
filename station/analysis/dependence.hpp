#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/estimate.hpp"
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// What the answers of a task are, for serial_dependence().
enum class Answers {
  sides,       ///< two choices, of which the right one tells on which side of a stimulus the other one is
  choices,     ///< two choices, one of which becomes more frequent as the level rises
  values,      ///< ratings
  settings,    ///< settings of a slider; the level is its start
  logarithms,  ///< numbers in proportion to a sensation: their logarithm, and that of the level
};

struct DependenceOptions {
  Answers answers = Answers::choices;
  int positive = 1;  ///< the choice whose frequency is described
  /// the level from which evidence for either choice counts (sides); evidence of another kind is the level
  /// itself
  double cut = 0;
  bool decibel = false;  ///< the level is 20 log10 of a physical quantity, which is then used instead of it
  bool after_error =
      false;  ///< whether to estimate Dependence::after_error; only if levels were fixed before
  /// where another choice than `positive` is right there was no signal, whatever the level: the stimulus is 0
  bool noise = false;
};

/// What the answers are after one stimulus before, or after a group of stimuli that are close to each other.
struct AfterStimulus {
  double stimulus = 0;  ///< the stimulus before; of a group the mean
  int pairs = 0;        ///< number of pairs of trials
  /// how far it shifts the answers from the mean of all such shifts, beyond what the present stimulus and the
  /// answer before explain, in log odds or in the unit of the answer
  Estimate shift;
};

/// How the answers of one condition depend on the trial before, beyond what the present stimulus explains.
///
/// For two choices: a logistic regression of the answer on the present stimulus, on that of the trial before,
/// and on the answer before. Penalised likelihood (Firth 1993, Biometrika 80:27-38), because a steep observer
/// would otherwise have no estimate, with 95 % profile intervals (Heinze & Schemper 2002, Stat. Med.
/// 21:2409-2419). All are in log odds. Stimuli count in the unit of the level; on two sides, positive if they
/// speak for `positive`.
///
/// For other answers: a linear regression with 95 % intervals by Student's t. Each level has its own mean for
/// values and logarithms, so `stimulus` is empty. Settings of all conditions together, each of which has its
/// own mean, have a slope over the slider's start.
struct Dependence {
  std::string condition;  ///< of the present trial; "" for all together
  DependenceOptions how;
  std::string analysis;  ///< its name; "" if there is only one
  std::string answer;    ///< the choice whose log odds are estimated; "" for other answers
  std::string unit;      ///< of the level; "" if it has none
  int pairs = 0;         ///< number of trials whose trial before counts as well
  std::optional<Estimate> stimulus;
  std::optional<Estimate> previous_stimulus;
  /// Two choices: log odds of the answer given before, less those without it; above 0 for people who repeat
  /// themselves. Otherwise: the slope over the previous answer.
  std::optional<Estimate> previous_answer;
  /// how much more a unit of the stimulus weighs after an error than after a right answer, beside a shift of
  /// the answers after errors
  std::optional<Estimate> after_error;
  /// The serial-dependence curve, which need not be straight as `previous_stimulus` is, in ascending order:
  /// one entry for each stimulus before, or for each of up to 7 groups of equal size if there are more than
  /// 12 stimuli or fewer than 8 pairs with one. Empty with fewer than 3 groups of 15 pairs, or if the pairs
  /// do not determine it, and for settings. For `sides` a stimulus has the sign of its side; for `logarithms`
  /// it is the logarithm of the level (base 10).
  std::vector<AfterStimulus> curve;
  std::vector<Statement> statements;
};

/// The coefficients of a regression.
struct Regression {
  std::vector<Estimate> coefficients;  ///< empty if the predictors are dependent, or if no maximum was found
  bool dependent = false;              ///< the predictors are linearly dependent
};

/// The first `wanted` coefficients of a logistic regression by Firth's penalised likelihood, with 95 %
/// profile intervals and p values of the penalised likelihood ratio. Each of `rows` has the predictors of one
/// answer, with a 1 for the constant if there is one. An end of an interval that is not found is infinite.
Regression penalised_logistic(const std::vector<std::vector<double>>& rows, const std::vector<bool>& answers,
                              std::size_t wanted);

/// Returns one entry for each condition of the experimental trials, and one for settings; conditions in
/// `order` come first. Counts pairs of answered experimental trials that follow each other (see follows()).
/// `trials` are in the order of presentation. Estimates are empty with fewer than 50 pairs of choices, or
/// fewer than 10 of other answers beyond the number of predictors, or if the pairs do not determine them.
/// `after_error` is also empty after fewer than 5 errors.
std::vector<Dependence> serial_dependence(const std::vector<TrialRecord>& trials,
                                          const std::vector<std::string>& order,
                                          const DependenceOptions& options);

}  // namespace turnpoint::analysis

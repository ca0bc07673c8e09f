#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/core/psychometric.hpp"
#include "station/procedure/spec.hpp"

namespace turnpoint::protocol {

struct Protocol;

/// How the answers of a task relate to the level.
enum class AnswerKind {
  right_answer,  ///< one of the choices is right; the level determines how easy it is to find
  side,          ///< two answers: one belongs to the levels below a cut, the other to the levels above
  /// two answers: one is right if the level is zero, the other if it is not (for same-different: zero means
  /// that both scenes are the same)
  presence,
  category,  ///< the level decides which of the answers is right (identification)
};

struct AnswerRule {
  AnswerKind kind = AnswerKind::right_answer;
  /// index of a choice. For `side`: the answer that belongs to levels above the cut. For `presence`: the
  /// answer that is right for every level except zero
  int positive = 1;
  /// for `category`: for each choice, the mean of the presented levels at which it is right
  std::vector<double> categories = {};
  double cut = 0;     ///< for `side`: the level at which the right answer changes
  bool size = false;  ///< true if only the magnitude of the level decides which answer is right
};

/// What the trials of one level factor measure. The report fits a different function for each.
enum class Design {
  forced_choice,  ///< accuracy rises with the level; the guess rate is 1 / alternatives
  /// two answers, one below a cut and one above, such as left and right: the fit gives the PSE and the spread
  two_sided,
  yes_no,  ///< "yes" becomes more frequent as |level| rises; trials at level 0 have no signal
  /// like yes_no: "different" counts as "yes", and pairs of identical stimuli have no signal
  same_different,
  categories,   ///< the level decides which of several answers is right, or no answer is right
  ratings,      ///< ratings on points or on a line; the report has their mean at each level
  numbers,      ///< magnitude estimation: geometric means, and the exponent of Stevens' law
  pairs,        ///< comparisons of two stimuli: a scale of Bradley and Terry, or of Thurstone
  differences,  ///< comparisons of differences of three or four stimuli: difference scaling
  adjustment,   ///< the participant sets a slider; no psychometric function is fitted
};

/// True if some trials have no signal, so that "yes" is a false alarm in them.
inline bool has_noise(Design design) { return design == Design::yes_no || design == Design::same_different; }

/// What one analysis of a protocol measures, and how: the one decision that the check, the report, the report
/// of a study and the power study share. It follows from the protocol alone, so it is the same for every
/// participant, whichever trials they had. Trials of one level factor belong to one analysis, except those of
/// procedures that set other factors to other values.
struct Meaning {
  /// name of the analysis; "" if the protocol has only one
  std::string name;
  std::vector<std::string> blocks;  ///< blocks with its trials, without practice, in the order of the plan
  std::vector<std::string> procedures;  ///< procedures that present its levels; empty for fixed levels
  std::string level;                    ///< the factor
  std::vector<std::string> against;     ///< for comparisons: the factors of the other stimuli
  AnswerRule rule;
  Design design = Design::forced_choice;
  bool scored = true;  ///< false if no answer is right or wrong
  /// true if the sign of the level is left out: the analysis is over the size of the level
  bool size = false;
  int alternatives = 2;
  core::Function function = core::Function::weibull;
  bool log_axis = false;  ///< true if the function is fitted to the logarithm of the level
  /// the lowest and the highest level that the trials can present, after `size`
  std::pair<double, double> levels{0, 0};
  /// factor of a second dimension along which the threshold changes within the analysis; "" if there is none.
  /// No function of the level is fitted then
  std::string along;
  double middle = 1;  ///< middle_level() of `level`
};

/// The analysis to which trials of this procedure (or, without one, of this block) belong: an index of
/// Protocol::meanings.
std::size_t meaning_of(const Protocol& protocol, const std::string& procedure, const std::string& block);

/// The name of a condition in an analysis: the name of the analysis and of the condition, if they have names.
std::string condition_in(const Meaning& meaning, const std::string& condition);

/// All conditions of all analyses, in the order of the protocol.
std::vector<std::string> analysed_conditions(const Protocol& protocol);

/// The factor whose levels all procedures set; empty if there are no procedures, or if they set different
/// ones.
std::optional<std::string> common_level(const Protocol& protocol);

/// Returns the proportion of right answers that a threshold means, for a participant without lapses. Empty if
/// the analysis has no threshold of right answers.
std::optional<double> threshold_proportion(const Meaning& meaning);

/// Says in one line what is measured: "PSE and spread of `distance_mm` around 20, cumulative normal".
std::string in_words(const Meaning& meaning, const Protocol& protocol);

/// The same line after the names of the blocks, and of the analysis if the protocol has several: "main: ...".
std::string line_of(const Meaning& meaning, const Protocol& protocol);

}  // namespace turnpoint::protocol

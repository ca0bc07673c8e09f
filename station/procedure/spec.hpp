#pragma once
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "station/core/psychometric.hpp"
#include "station/core/texts.hpp"
#include "station/core/toml.hpp"
#include "station/procedure/order.hpp"

namespace turnpoint::procedure {

/// All kinds of procedures, in the order of pages and forms. Each is the name of its Description, which one
/// of the files of this folder defines. The kinds could not register themselves: a linker leaves out an
/// object file of a static library if nothing refers to it.
#define TURNPOINT_PROCEDURES(KIND)           \
  KIND(constant_stimuli)                     \
  KIND(up_down)                              \
  KIND(weighted_up_down)                     \
  KIND(quest_plus)                           \
  KIND(psi)                                  \
  KIND(psi_marginal)                         \
  KIND(zest)                                 \
  KIND(best_pest)                            \
  KIND(adjustment)                           \
  KIND(accelerated_stochastic_approximation) \
  KIND(limits)                               \
  KIND(program)                              \
  KIND(comparisons)

#define TURNPOINT_ENUMERATOR(kind) kind,
enum class Kind { TURNPOINT_PROCEDURES(TURNPOINT_ENUMERATOR) };
#undef TURNPOINT_ENUMERATOR

using core::Function;
enum class Scale { linear, log10, dB };
enum class Shuffle { within_repeat, within_block, none };
enum class StopRule {
  any,  ///< "or": the procedure ends when one rule is met
  all   ///< "and": the procedure ends when all rules are met
};
/// The order of the ascending and descending series of the method of limits.
enum class Directions {
  alternate,  ///< the first direction is drawn
  random      ///< shuffled, each direction equally often
};
enum class Select { min_expected_entropy };

/// The values of one axis of a grid, computed when the file is read: from-to-step, log_from-log_to-count, or
/// a list. If `tied` is "lapse", this parameter always equals the lapse.
struct Grid {
  std::vector<double> values;
  std::string tied;
};

/// Prior over the values of a grid. It is uniform if both members are empty.
struct Prior {
  std::optional<std::pair<double, double>> normal;  ///< mean and sd of a normal distribution
  std::vector<double> weights;                      ///< one weight for each value of the grid
};

/// The second dimension of the stimuli of a procedure with a posterior: another factor that it sets.
struct Second {
  std::string level;  ///< the factor
  Grid stimuli;       ///< its values; each is combined with each level
  double origin = 0;  ///< the value of the factor at which the threshold is that of `grid.threshold`
};

struct Stop {
  std::optional<int> trials, reversals, min_trials;
  std::optional<double> threshold_sd, entropy_nats;
  /// ends the procedure when this many of the last `of_last` answers were 1; both are set, or neither
  std::optional<int> right, of_last;
  StopRule rule = StopRule::any;
  std::optional<int> max_trials;   ///< the most trials, whatever `rule` says; see most_trials()
  std::optional<int> limit_steps;  ///< see steps_at_limit()
};

/// Returns the number of trials after which a procedure ends, whichever of its rules are not met:
/// `max_trials` or, if that is not given, 400 or four times what the other rules ask for, if that is more.
/// 10 trials are reckoned for each reversal.
int most_trials(const Stop& stop);
/// Returns the number of steps in a row that the end of the range stops and after which a track ends:
/// `limit_steps`, or 10. The rules of `stop` could then often not be met at all.
inline int steps_at_limit(const Stop& stop) { return stop.limit_steps.value_or(10); }

/// Starting levels of the series in one direction. Either a list, of which each is used equally often, or an
/// interval, from which each series draws one. If both are empty, there are no series in this direction.
struct SeriesStarts {
  std::vector<double> values;
  std::optional<std::pair<double, double>> uniform;
  bool empty() const { return values.empty() && !uniform; }
  /// The lowest and the highest level; must not be called if it is empty.
  std::pair<double, double> ends() const;
};

/// A separate program that chooses the levels (station/session).
struct Program {
  std::string file;           ///< as written in the protocol: absolute, or as seen from the protocol's folder
  core::Place place;          ///< of the key "program"
  double limit_s = 2;         ///< longest time from a question to the program to its reply
  core::Value settings = {};  ///< a table that the program gets as it is
};

/// The content of a [[procedure]] table, including the keys that it copies from another procedure. Members
/// that the kind does not use are empty.
struct Spec {
  std::string name;
  Kind kind = Kind::constant_stimuli;
  std::string level;  ///< the factor that the procedure sets
  /// the probability that a guess is right, if the participant may be unsure instead of guessing
  std::optional<double> guess_rate;
  std::string tracks;  ///< the answer that counts as 1; "" if right answers count as 1
  Scale scale = Scale::linear;
  /// the values that some factors have in all trials of this procedure
  std::map<std::string, std::variant<double, std::string>> with;
  /// true if the procedure goes on from its state in the participant's earlier sessions
  bool continues = false;
  /// name of the table from which `for_each` has made this procedure; "" if it was not made by `for_each`
  std::string family;

  // The following members are for constant stimuli; `values` are the levels.
  std::vector<double> values;
  int repeats = 1;
  std::vector<std::string> balance;
  Shuffle shuffle = Shuffle::within_repeat;
  /// The largest number of trials in a row that may have the same value of a factor or, for kRightAnswer, the
  /// same right answer. It holds over all trials of a block in which the procedure runs.
  std::map<std::string, int> max_run;
  /// factors whose values follow each other equally often, and how many trials back
  std::vector<std::string> after_each_other;
  int back = 1;
  core::Value never_after = {};  ///< the table of pairs of values, as written
  /// the same rules, with numbers: factor 0 is the level, with the places of `values` (the first of equal
  /// ones); the others are those of `balance`, with the places of their levels
  OrderRules rules;

  /// for comparisons, which also use `values` and `repeats`: the factors of the other stimuli of a trial, in
  /// order of presentation; one for pairs, two for triads, three for quadruples
  std::vector<std::string> against;

  // The following members are for procedures that move one level up and down. `start` is the first level; the
  // level stays between `min` and `max`.
  std::optional<double> start, min, max;
  /// sizes of the steps; each reversal switches to the next size, until the last size is reached
  std::vector<double> step, step_down, step_up;
  /// for weighted staircases: the proportion of answers of 1 on which the staircase converges
  std::optional<double> target;
  int n_down = 1, n_up = 1;
  /// number of right answers in a row that cause a step down, until the first reversal
  std::optional<int> initial_down;
  int discard_reversals = 0;  ///< number of reversals at the start that the estimate leaves out

  // The following members are for the method of limits, which also uses `step` (one step), `min` and `max`.
  // Adjustments use the first two, for the starts from below and from above.
  SeriesStarts ascending, descending;
  int series = 0;  ///< number of series in both directions together
  /// a series ends when the answer that differs from its first ones has come this many times in a row
  int n_change = 1;
  Directions directions = Directions::alternate;

  // The following members are for procedures with a posterior. The grids of gradient and floor are only used
  // if there is a second dimension, and the grid of the criterion only if there is a criterion.
  Function function = Function::weibull;
  /// true for function = "signal-detection": the answers follow from d' and a criterion (detection_rate());
  /// `function` is then not used
  bool signal_detection = false;
  std::optional<Second> second;
  Grid stimuli, threshold, gradient, floor, slope, criterion, guess, lapse;
  Prior prior_threshold, prior_gradient, prior_floor, prior_slope, prior_criterion, prior_guess, prior_lapse;
  /// nuisance parameters (psi-marginal): the posterior is summed over them before the entropy is computed
  std::vector<std::string> nuisance;
  Select select = Select::min_expected_entropy;

  Program program;  ///< only for programs, which also use `min` and `max`

  Stop stop;
};

/// The key of Spec::max_run that stands for the right answer.
inline constexpr const char* kRightAnswer = "right";

/// A parameter of a procedure with a posterior: its name, and its grid and prior in a specification.
struct ParameterKeys {
  const char* name;
  Grid Spec::*grid;
  Prior Spec::*prior;
};

/// All parameters, in the order in which Posterior counts its grid points. The first three determine the
/// threshold at each stimulus, the next two the shape of the function, and the last two its asymptotes.
inline constexpr std::array<ParameterKeys, 7> kParameters{
    {{"threshold", &Spec::threshold, &Spec::prior_threshold},
     {"gradient", &Spec::gradient, &Spec::prior_gradient},
     {"floor", &Spec::floor, &Spec::prior_floor},
     {"slope", &Spec::slope, &Spec::prior_slope},
     {"criterion", &Spec::criterion, &Spec::prior_criterion},
     {"guess", &Spec::guess, &Spec::prior_guess},
     {"lapse", &Spec::lapse, &Spec::prior_lapse}}};

/// True if the rule `right` of `of_last` is set and met. `answer_at(i)` says whether the i-th of `answers`
/// answers was 1.
template <class AnswerAt>
bool enough_right(const Stop& stop, std::size_t answers, const AnswerAt& answer_at) {
  if (!stop.right || answers < static_cast<std::size_t>(*stop.of_last)) return false;
  int right = 0;
  for (std::size_t i = answers - static_cast<std::size_t>(*stop.of_last); i < answers; ++i)
    right += answer_at(i) ? 1 : 0;
  return right >= *stop.right;
}

const char* name(Kind kind);  ///< the kind's name in a protocol: "constant-stimuli", "up-down", ...
std::optional<Kind> parse_kind(const std::string& text);
std::vector<std::string> kind_names();

/// Returns the number of trials in a list.
inline std::size_t list_trials(const Spec& spec) {
  if (spec.kind == Kind::comparisons) {
    const auto n = spec.values.size();
    const auto repeats = static_cast<std::size_t>(spec.repeats);
    if (n < 1 + spec.against.size()) return 0;
    return repeats * (spec.against.size() == 1   ? n * (n - 1)
                      : spec.against.size() == 2 ? n * (n - 1) * (n - 2) / 6
                                                 : n * (n - 1) * (n - 2) * (n - 3) / 24);
  }
  const auto trials = spec.values.size() * static_cast<std::size_t>(spec.repeats);
  return spec.rules.equally.empty() ? trials : trials + spec.rules.back;
}

/// Returns about how many trials the method of limits takes. Assumes that the answers change half-way between
/// the ascending and the descending starts. If all series have one direction, the limit `min` or `max` stands
/// for the missing starts.
double series_trials(const Spec& spec);

/// One problem of a specification: the key, what is wrong, and what is allowed.
struct Problem {
  std::string key;
  core::Phrase what, allowed;
};

/// Returns all problems of a specification; empty if a procedure can run with it.
std::vector<Problem> validate(const Spec& spec);
/// Returns warnings about settings that work but are probably mistakes: a grid with only one stimulus, steps
/// that miss the target, a lapse grid whose only value is 0.
std::vector<Problem> advise(const Spec& spec);

}  // namespace turnpoint::procedure

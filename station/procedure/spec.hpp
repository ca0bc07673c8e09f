#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/terms/psychometric.hpp"

namespace turnpoint::procedure {

enum class Kind {
  constant_stimuli,
  up_down,
  weighted_up_down,
  quest_plus,
  psi,
  psi_marginal,
  adjustment,
  accelerated_stochastic_approximation
};
using terms::Function;
enum class Scale { linear, log10, dB };
enum class Shuffle { within_repeat, within_block, none };
enum class StopRule { any, all };  ///< "or", "and"
enum class Select { min_expected_entropy };

/// Values of one axis of a grid, made explicit when the file is read: from-to-step, log_from-log_to-count, or
/// a list. `tied` = "lapse": this parameter always equals that one.
struct Grid {
  std::vector<double> values;
  std::string tied;
};

/// Prior over a grid's values; none: uniform.
struct Prior {
  std::optional<std::pair<double, double>> normal;  ///< mean, sd
  std::vector<double> weights;                      ///< one a value
};

struct Stop {
  std::optional<int> trials, reversals, min_trials;
  std::optional<double> threshold_sd, entropy_nats;
  StopRule rule = StopRule::any;
};

/// What a [[procedure]] table says, after `copy`. Keys that the kind does not use are empty.
struct Spec {
  std::string name;
  Kind kind = Kind::constant_stimuli;
  std::string level;   ///< the factor that it sets
  std::string tracks;  ///< "": correctness; else the answer that counts as 1
  Scale scale = Scale::linear;

  // constant stimuli
  std::vector<double> values;
  int repeats = 1;
  std::vector<std::string> balance;
  Shuffle shuffle = Shuffle::within_repeat;
  std::optional<int> max_run;

  // staircases
  std::optional<double> start, min, max;
  std::vector<double> step, step_down, step_up;  ///< on each reversal the next; the last one stays
  std::optional<double> target;                  ///< weighted: the probability it converges on
  int n_down = 1, n_up = 1;
  std::optional<int> initial_down;  ///< so many right answers step down until the first reversal
  int discard_reversals = 0;        ///< so many of the first ones are left out of the estimate

  // adaptive by a posterior
  Function function = Function::weibull;
  Grid stimuli, threshold, slope, guess, lapse;
  Prior prior_threshold, prior_slope, prior_guess, prior_lapse;
  std::vector<std::string> nuisance;  ///< parameters summed over before entropy is taken (psi-marginal)
  Select select = Select::min_expected_entropy;

  Stop stop;
};

const char* name(Kind kind);  ///< "constant-stimuli", "up-down", ...
std::optional<Kind> parse_kind(const std::string& text);
std::vector<std::string> kind_names();

/// One thing wrong with a spec: the key it concerns, what is wrong, what is allowed.
struct Fault {
  std::string key, what, allowed;
};

/// Everything wrong with a spec, whatever file it came from; empty when it can run.
std::vector<Fault> validate(const Spec& spec);
/// Things that run but are probably not meant: a one-point grid of stimuli, steps that miss the target, a
/// grid whose only lapse is 0.
std::vector<Fault> advise(const Spec& spec);

}  // namespace turnpoint::procedure

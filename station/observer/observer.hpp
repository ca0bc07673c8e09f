#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "station/random/draws.hpp"

namespace turnpoint::observer {

/// How a simulated observer decides. Each answer is the first passage of a diffusion (first_passage.hpp)
/// whose drift is such that, with the full bound, answers follow a psychometric function of the level:
///  - where one answer is right: a Weibull function with the exponent `slope`;
///  - where the sign of the level decides: a normal distribution about `bias` (of |level - bias|^slope);
///  - yes/no and ratings: d' grows as level^slope, and the criterion lies at `criterion`.
/// The threshold is in the unit of the level. Lapses are answers at random.
struct Parameters {
  /// The |level| (of a signed level: the distance from the bias) at which 75 % of two alternatives are right,
  /// and yes/no answers have d' = 1.349, which is 75 % right with the default criterion. None: the middle of
  /// the levels that the protocol presents.
  std::optional<double> threshold;
  double slope = 1;  ///< exponent of level over threshold; for levels in dB, of the amplitude ratio
  double lapse = 0.02;
  double bias = 0;  ///< the level at which a signed task seems balanced
  double criterion =
      0.67448975019608171;   ///< yes/no: SDs above the mean of noise; false alarms Phi(-criterion)
  double bound = 0.85;       ///< half the separation, square root of s: EZ's a is 0.2 times it
  double residual_s = 0.35;  ///< time outside the decision, without `travel_s`
  double travel_s = 0.15;    ///< from the surface to the answer
  // Variability between trials (Ratcliff & McKoon 2008); none as a rule.
  double drift_sd = 0;          ///< normal, per square root of a second: EZ's eta is 0.1 times it
  double start_range = 0;       ///< uniform about the middle, as a share of the separation, 0 to below 1
  double residual_range_s = 0;  ///< uniform about residual_s; at most twice that
  double anticipation = 0;      ///< share of trials answered before anything could be felt
};

/// Reads `sim` or `sim:threshold=6,slope=1.2,lapse=0.02,bias=0,...`. Throws terms::UsageError naming the
/// part and what is allowed.
Parameters parse(const std::string& text);

/// What an answer depends on.
enum class Decides {
  right_answer,  ///< there is a right answer, easier to find with a stronger level
  side,          ///< two answers, one on each side of the bias
  presence,  ///< two answers, whether there was a signal; or ratings, from the surest no to the surest yes
};

/// What is asked, without what only the station knows but the level.
struct Question {
  double level = 0;
  bool decibel = false;  ///< the level is 20 log10 of a strength
  Decides decides = Decides::right_answer;
  int positive = 1;            ///< side: the answer that fits a level above zero; presence of two: "yes"
  bool absent = false;         ///< presence: this trial has no signal, whatever its level
  std::optional<int> correct;  ///< right_answer: the right one; none: there is none
  int answers = 2;
  double default_threshold = 1;  ///< where the parameters have none
  double deadline_s = 0;  ///< 0: none; an observer decides sooner, and worse, when there is little time
  random::Key key;        ///< of the trial; the stream is the observer's
};

struct Reply {
  std::optional<int> choice;
  double response_time_s = 0;  ///< from the moment that counts; may be negative for an anticipation
};

/// A slider to be set: where it starts, and what it can be set to.
struct Adjustment {
  double start = 0, low = 0, high = 1;
  random::Key key;
};

struct Move {
  double time_s = 0;  ///< from the moment that counts
  double value = 0;
};

struct Setting {
  std::vector<Move> moves;  ///< in time; the last one is the setting
  double done_s = 0;        ///< when Done is pressed
};

/// A simulated participant. Stateless: the same question gets the same reply, on every machine.
class Observer {
 public:
  explicit Observer(const Parameters& parameters) : parameters_(parameters) {}
  const Parameters& parameters() const { return parameters_; }
  /// Probability that an answer (not anticipated) is `choice`, lapses included: what answer() does on the
  /// mean.
  double share(const Question& question, int choice) const;
  Reply answer(const Question& question) const;
  /// The bound with this deadline (0: none), square root of s. Where time is short it is so low that even
  /// with nothing felt all but 4 % of the decisions are made in time.
  double bound(double deadline_s) const;
  /// Mean time outside the decision, s.
  double nondecision_s() const { return parameters_.residual_s + parameters_.travel_s; }
  /// Moves the slider to where things seem equal, in ever smaller steps: settings scatter about the bias with
  /// the normal whose 75 % point is the threshold (none: a tenth of the range), a lapse sets it anywhere.
  Setting adjust(const Adjustment& adjustment) const;

 private:
  double strength(const Question& question, double from) const;
  double drift(const Question& question) const;
  double sensitivity(const Question& question) const;
  Parameters parameters_;
};

}  // namespace turnpoint::observer

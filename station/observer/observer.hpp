#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "station/random/draws.hpp"

namespace turnpoint::observer {

/// The parameters of a simulated observer. Each answer is the first passage of a diffusion
/// (first_passage.hpp). Its drift is chosen so that, with the full bound, answers follow a psychometric
/// function of the level:
/// - if one answer is right: a Weibull function with the exponent `slope`;
/// - if the sign of the level decides: a normal distribution around `bias` (of |level - bias|^slope);
/// - yes/no and ratings: d' grows as level^slope, and the criterion lies at `criterion`.
/// The threshold is in the unit of the level. Lapses are random answers.
struct Parameters {
  /// The |level| (for a signed level: the distance from the bias) at which 75 % of answers between two
  /// alternatives are right. For yes/no it gives d' = 1.349, which is 75 % right with the default criterion.
  /// Empty: the middle of the levels that the protocol presents.
  std::optional<double> threshold;
  double slope = 1;  ///< exponent of level / threshold; for levels in dB, of the amplitude ratio
  double lapse = 0.02;
  double bias = 0;  ///< the level at which a signed task seems balanced
  /// yes/no: in SDs above the mean of noise; the false-alarm rate is Phi(-criterion)
  double criterion = 0.67448975019608171;
  double bound = 0.85;       ///< half the boundary separation, square root of s; EZ's a is 0.2 times this
  double residual_s = 0.35;  ///< non-decision time, without `travel_s`
  double travel_s = 0.15;    ///< time to move from the surface to the answer
  // Variability between trials (Ratcliff & McKoon 2008); usually none.
  double drift_sd = 0;  ///< normal, per square root of a second; EZ's eta is 0.1 times this
  /// uniform around the middle, as a fraction of the separation, from 0 to below 1
  double start_range = 0;
  double residual_range_s = 0;  ///< uniform around residual_s; at most twice residual_s
  double anticipation = 0;      ///< share of trials answered before anything can be felt
};

/// Reads `sim` or `sim:threshold=6,slope=1.2,lapse=0.02,bias=0,...`. Throws terms::UsageError naming the
/// part and what is allowed.
Parameters parse(const std::string& text);

/// What an answer depends on.
enum class Decides {
  right_answer,  ///< one answer is right, and a stronger level makes it easier to find
  side,          ///< two answers, one on each side of the bias
  presence,      ///< two answers: was there a signal; or ratings, from the surest no to the surest yes
};

/// The question in a trial. It contains the level, but nothing else that only the station knows.
struct Question {
  double level = 0;
  bool decibel = false;  ///< true if the level is 20 log10 of a strength
  Decides decides = Decides::right_answer;
  int positive = 1;            ///< side: the answer that fits a level above zero; presence of two: "yes"
  bool absent = false;         ///< presence: this trial has no signal, whatever its level
  std::optional<int> correct;  ///< right_answer: the right one; empty if there is none
  int answers = 2;
  double default_threshold = 1;  ///< used if the parameters have no threshold
  double deadline_s = 0;         ///< 0: none; with little time an observer decides sooner and less accurately
  random::Key key;               ///< key of the trial; the stream is always the observer's
};

struct Reply {
  std::optional<int> choice;
  double response_time_s = 0;  ///< from response_zero; may be negative for an anticipation
};

/// A slider to adjust: its start and its range.
struct Adjustment {
  double start = 0, low = 0, high = 1;
  random::Key key;
};

struct Move {
  double time_s = 0;  ///< from response_zero
  double value = 0;
};

struct Setting {
  std::vector<Move> moves;  ///< in order of time; the last one is the setting
  double done_s = 0;        ///< time at which Done is pressed
};

/// A simulated participant. Stateless: the same question gets the same answer on every machine.
class Observer {
 public:
  explicit Observer(const Parameters& parameters) : parameters_(parameters) {}
  const Parameters& parameters() const { return parameters_; }
  /// Probability that an answer (not anticipated) is `choice`, lapses included. This is the average of what
  /// answer() does.
  double share(const Question& question, int choice) const;
  Reply answer(const Question& question) const;
  /// The bound with this deadline (0: none), square root of s. With little time it is so low that, even if
  /// nothing is felt, only 4 % of the decisions are late.
  double bound(double deadline_s) const;
  /// Mean non-decision time, s.
  double nondecision_s() const { return parameters_.residual_s + parameters_.travel_s; }
  /// Moves the slider in ever smaller steps to where things seem equal. Settings scatter around the bias with
  /// the normal distribution whose 75 % point is the threshold (without a threshold: a tenth of the range). A
  /// lapse sets the slider anywhere.
  Setting adjust(const Adjustment& adjustment) const;

 private:
  double strength(const Question& question, double from) const;
  double drift(const Question& question) const;
  double sensitivity(const Question& question) const;
  Parameters parameters_;
};

}  // namespace turnpoint::observer

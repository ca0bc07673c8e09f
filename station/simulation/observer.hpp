#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/core/draws.hpp"

namespace turnpoint::simulation {

/// The parameters of a simulated observer. Each answer is the first passage of a diffusion
/// (first_passage.hpp). The drift is chosen so that, with the full bound, the answers follow a psychometric
/// function of the level:
/// - If one answer is right, a Weibull function with the exponent `slope`. If one of several intervals
///   differs, or one of two matches a third, this is the function for two intervals; it gives d', and d'
///   gives the proportion correct of an observer who makes one noisy observation of each interval (see
///   Finding).
/// - If the sign of the level decides, a normal distribution function of |level - bias|^slope, with the sign
///   of level - bias.
/// - For yes/no and ratings, d' grows as level^slope, and the criterion lies at `criterion`.
/// - In comparisons of stimuli (Question::compared), a normal distribution function of the difference on the
///   observer's own scale, which is a power function with the exponent `slope` over their range.
/// - For categories, the level that is felt has a normal distribution around the level presented. The answer
///   is the category whose level is nearest; of two categories one threshold apart, 75 % are told apart.
/// The threshold is in the unit of the level. In a lapse the observer gives a random answer.
struct Parameters {
  /// The |level| at which 75 % of answers between two alternatives are right; for a signed level, its
  /// distance from the bias. For yes/no, d' is 1.349 at the threshold, which gives 75 % right answers with
  /// the default criterion. If empty: the middle of the levels that the protocol presents.
  std::optional<double> threshold;
  /// Change of the threshold (of the bias, if the sign of the level decides) for each unit of a procedure's
  /// second dimension; Question::log_step says in which unit it is.
  double gradient = 0;
  std::optional<double> floor;  ///< the threshold never falls below it
  double slope = 1;  ///< exponent of level / threshold; for levels in dB, exponent of the amplitude ratio
  double lapse = 0.02;
  double bias = 0;  ///< the level at which a signed task seems balanced
  /// criterion of yes/no tasks, in SDs above the mean sensation without a signal; the false-alarm rate is
  /// Phi(-criterion)
  double criterion = 0.67448975019608171;
  /// half the distance between the two decision boundaries of the diffusion, in square roots of a second; the
  /// boundary a of EZ-diffusion is 0.2 times this
  double bound = 0.85;
  double residual_s = 0.35;  ///< non-decision time without `travel_s`
  double travel_s = 0.15;    ///< time to move the finger from the surface to the answer
  // The next three parameters are the ranges over which the diffusion varies between trials (Ratcliff &
  // McKoon 2008). With the defaults it does not vary.
  double drift_sd = 0;  ///< SD of the drift (normal), per square root of a second; EZ's eta is 0.1 times this
  /// range of the starting point (uniform around the middle), as a fraction of the distance between the
  /// boundaries, from 0 to below 1
  double start_range = 0;
  /// range of the non-decision time (uniform around residual_s); at most twice residual_s
  double residual_range_s = 0;
  /// SD of the judgements; if the answers are numbers (magnitude estimation), of their decimal logarithm
  double scatter = 0.1;
  /// fraction of the guesses that the observer admits, where a question allows it: answers that would be
  /// right only by chance
  double unsure = 0.5;
  /// probability with which the observer asks for the intervals again instead of answering, each time that it
  /// may. It judges all presentations together as it would judge one: asking again costs time and helps
  /// nothing
  double again = 0;
  double anticipation = 0;  ///< fraction of trials answered before anything can be felt
};

/// Reads `sim` or `sim:threshold=6,slope=1.2,lapse=0.02,bias=0,...`. Throws core::UsageError that names the
/// wrong part and says what is allowed.
Parameters parse(const std::string& text);

/// How much people differ in the parameters of an observer, by their names in parse(). The standard deviation
/// of `threshold`, `gradient`, `floor`, `bias` and `criterion` is in their own unit, that of all others is
/// the standard deviation of the natural logarithm.
using Spread = std::map<std::string, double>;

/// Reads `threshold=0.03,bound=0.15,residual=0.1`. Throws core::UsageError.
Spread parse_spread(const std::string& text);

/// Draws a person from people whose middle is `middle`. A threshold keeps its sign, and is never nearer to 0
/// than a tenth of the middle. Throws core::UsageError if a parameter is to vary that `middle` leaves open.
Parameters draw_person(const Parameters& middle, const Spread& spread, core::Draws& draws);

/// What decides which answer is given.
enum class Decides {
  right_answer,  ///< one of the answers is right; a stronger level makes it easier to find
  side,          ///< there are two answers, one for each side of the bias
  presence,      ///< yes or no, whether there was a signal; or ratings, from the surest no to the surest yes
  category,      ///< each answer stands for a level; the nearest one is chosen
};

/// How the observer finds the right answer. It decides how the proportion correct follows from the level.
enum class Finding {
  weibull,  ///< Weibull's function, from the guess rate 1 / answers
  largest,  ///< the interval with the largest of independent observations
  nearest,  ///< ABX: the one of two observations that is nearer to a third (differencing)
};

/// An answer that is a number from `low` to `high`, a multiple of 10^-decimals.
struct ValueQuestion {
  /// true: the answer is a magnitude, which follows Stevens' power law with the exponent `slope`; false: it
  /// is a place on a line
  bool typed = false;
  double low = 0, high = 1;
  int decimals = 0;
  double modulus = 10;  ///< the magnitude that the observer states at its threshold
};

/// The level at which the observer gives the middle of a rating scale. For `criterion`, ratings grow with the
/// sensation, from noise through the criterion, as in yes/no tasks. For `threshold`, they grow with the
/// logarithm of level / threshold. For `bias`, they grow with the distance of the level from the bias.
enum class Middle { criterion, threshold, bias };

/// The question that a trial asks: everything in the trial on which a simulated observer's answer depends.
struct Question {
  double level = 0;
  bool decibel = false;  ///< true if the level is in dB, that is, 20 log10 of a strength
  /// how far the trial's value of the second dimension is above its origin; 0 if there is no second dimension
  double second = 0;
  /// 0: gradient * second is added to the threshold; otherwise the threshold is multiplied by
  /// exp(log_step * gradient * second)
  double log_step = 0;
  Decides decides = Decides::right_answer;
  /// for `side`: the answer that belongs to levels above the cut; for `presence` with two answers: "yes"
  int positive = 1;
  double cut = 0;              ///< for `side`: the level from which the observer's bias counts
  bool absent = false;         ///< for `presence`: true if the trial has no signal, whatever its level
  std::optional<int> correct;  ///< for `right_answer`: the right answer; empty if no answer is right
  Finding finding = Finding::weibull;   ///< for `right_answer`: how the observer finds the right answer
  std::vector<double> categories = {};  ///< for `category`: the level for which each answer stands
  /// for `side`, if stimuli are compared with each other: two, or the three or four whose differences are
  /// compared, in order of presentation, as places between the lowest (0) and the highest (1) of the range.
  /// `level` is then the difference on a straight scale
  std::vector<double> compared = {};
  double range = 0;  ///< of these stimuli, in the unit of the level
  int answers = 2;
  /// for `right_answer`: true if the observer may say that it would guess; `choice` is then `answers`
  bool unsure = false;
  int again = 0;        ///< how often the observer may ask for the intervals again
  bool rating = false;  ///< true if the answers are the points of a scale, from low to high levels
  Middle middle = Middle::criterion;
  std::optional<ValueQuestion> value;  ///< set if the answer is a number
  int confidence = 0;                  ///< number of degrees of confidence; 0 if confidence is not asked for
  double default_threshold = 1;        ///< threshold that is used if the observer's parameters give none
  /// deadline of the answer; 0 if there is none. If time is short, the observer decides sooner and makes more
  /// errors
  double deadline_s = 0;
  /// If set, the observer's decision boundaries lie so many times as far apart as Parameters::bound says,
  /// whatever the deadline is. The drift stays, so the observer trades speed for accuracy.
  std::optional<double> caution = {};
  /// If set, a signal asks for the answer at this time. The observer then gives the answer on which it has
  /// decided or, if it has not decided yet, the answer to which the evidence points so far. Because the
  /// answer is prepared, the observer then needs only half of its residual time, and the time to move; less
  /// if the deadline comes sooner.
  std::optional<double> signal_s = {};
  core::DrawKey key;  ///< key of the trial's random draws; the observer sets the key's stream
};

struct Reply {
  std::optional<int> choice;
  std::optional<double> value;    ///< set if the question asks for a number; `choice` is then 0
  std::optional<int> confidence;  ///< from 1; how far the evidence is from the criterion
  double response_time_s =
      0;  ///< time of the answer after response_zero; may be negative for an anticipation
  double confidence_time_s = 0;  ///< time from the answer to the statement of confidence
  /// time for which the finger was away from the surface before the answer; 0 if that is not known
  double travel_s = 0;
  int again = 0;  ///< how often the observer asks for the intervals again before it answers
};

/// A slider to be adjusted: its starting position and its range, and the setting at which the stimuli are
/// equal.
struct Adjustment {
  double start = 0, low = 0, high = 1;
  double equal = 0;
  /// time from the onset of the scene that the slider changes until the setting must be made; 0: as long as
  /// the observer likes
  double within_s = 0;
  int again = 0;  ///< how often the observer may ask for the standard again
  core::DrawKey key;
};

struct Move {
  double time_s = 0;  ///< time after the onset of the scene that the slider changes
  double value = 0;
};

struct Setting {
  std::vector<Move> moves;  ///< in order of time; the last one is the setting
  double done_s = 0;        ///< time at which the participant presses Done
  /// how often the participant asks for the standard again before it moves the slider, and at which time
  int again = 0;
  double again_s = 0;
};

/// A simulated participant. It keeps no state: it gives the same answer to the same question, on every
/// machine.
class Observer {
 public:
  explicit Observer(const Parameters& parameters) : parameters_(parameters) {}
  const Parameters& parameters() const { return parameters_; }
  /// Returns the probability that answer() gives `choice`. Lapses are included, anticipations are not.
  double share(const Question& question, int choice) const;
  Reply answer(const Question& question) const;
  /// Returns the bound for this question's deadline, in square roots of a second. If time is short, the bound
  /// is so low that only 4 % of the decisions come too late, even if nothing can be felt.
  double bound(const Question& question) const;
  /// Returns the mean non-decision time, in s.
  double nondecision_s() const { return parameters_.residual_s + parameters_.travel_s; }
  /// Returns the shortest and the longest non-decision time, in s.
  std::pair<double, double> nondecision_range_s() const {
    const double half = 0.5 * parameters_.residual_range_s;
    return {nondecision_s() - half, nondecision_s() + half};
  }
  /// Returns the mean time from the response signal to the answer, in s.
  double latency_s(const Question& question) const;
  /// Returns the mean drift in s^-1/2. What a positive drift leads to depends on question.decides: the right
  /// answer (right_answer), the answer that is right for levels above the observer's bias (side), "yes"
  /// (presence), or the category that contains the level rather than its nearest neighbour (category).
  double drift(const Question& question) const;
  /// Moves the slider in ever smaller steps to where the stimuli seem equal: the bias away from where they
  /// are. The settings follow a normal distribution around that place; its 75 % point is one threshold above
  /// it (without a threshold: a tenth of the range). In a lapse, the setting is anywhere in the range. If
  /// time is short, the observer moves the slider faster, and the setting is the same.
  Setting adjust(const Adjustment& adjustment) const;

 private:
  /// Returns the probability that the evidence decides for the upper boundary.
  double upper(const Question& question, double drift) const;
  double threshold(const Question& question) const;
  double level(const Question& question) const;
  double bias(const Question& question) const;
  double strength(const Question& question, double from) const;
  double sensitivity(const Question& question) const;
  double centre(const Question& question) const;
  double category_sd(const Question& question) const;
  double value(const Question& question, core::Draws& draws) const;
  int confidence(const Question& question, int choice, core::Draws& draws) const;
  int asks_again(core::DrawKey key, int most) const;
  Parameters parameters_;
};

/// Who answers in a simulated session: an Observer, or a separate program (station/session), whose functions
/// may throw core::ProgramFailed.
struct Respondent {
  std::function<Reply(const Question&)> answer;
  std::function<Setting(const Adjustment&)> adjust;

  Respondent(std::function<Reply(const Question&)> answers, std::function<Setting(const Adjustment&)> adjusts)
      : answer(std::move(answers)), adjust(std::move(adjusts)) {}
  Respondent(const Observer& observer)
      : answer([observer](const Question& question) { return observer.answer(question); }),
        adjust([observer](const Adjustment& adjustment) { return observer.adjust(adjustment); }) {}
};

}  // namespace turnpoint::simulation

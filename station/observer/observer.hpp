#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "station/random/draws.hpp"

namespace turnpoint::observer {

/// How a simulated observer decides. Threshold: the |level| at which 75 % of two alternatives are right
/// (none: the protocol's middle level); slope: exponent of level over threshold (for levels in dB, of the
/// amplitude ratio); bias: the level at which a signed task seems balanced; times in seconds.
struct Parameters {
  std::optional<double> threshold;
  double slope = 1, lapse = 0.02, bias = 0;
  double bound = 0.85;       ///< A' of Palmer, Huk & Shadlen (2005)
  double residual_s = 0.35;  ///< tR
  double travel_s = 0.15;    ///< from the surface to the answer
  double spread = 0.25;      ///< of the decision time, SD of its logarithm
  double anticipation = 0;   ///< share of trials answered before anything could be felt
};

/// Reads `sim` or `sim:threshold=6,slope=1.2,lapse=0.02,bias=0,...`. Throws std::invalid_argument naming the
/// part and what is allowed.
Parameters parse(const std::string& text);

/// What is asked, without what only the station knows but the level.
struct Question {
  double level = 0;
  bool decibel = false;        ///< the level is 20 log10 of a strength
  bool signed_level = false;   ///< two answers, one on each side of zero
  int negative_answer = 0;     ///< for a signed level: the answer that fits a level below zero
  std::optional<int> correct;  ///< otherwise: the right answer
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

/// A proportional-rate diffusion observer (Palmer, Huk & Shadlen 2005): accuracy 1 / (1 + exp(-2 A' k x)),
/// mean decision time (A' / kx) tanh(A' k x). Stateless: the same question gets the same reply.
class Observer {
 public:
  explicit Observer(const Parameters& parameters) : parameters_(parameters) {}
  /// Probability that an answer (not anticipated) is `choice`, lapses included: what answer() does on the
  /// mean.
  double share(const Question& question, int choice) const;
  Reply answer(const Question& question) const;
  /// Moves the slider to where things seem equal, in ever smaller steps: settings scatter about the bias with
  /// the normal whose 75 % point is the threshold (none: a tenth of the range), a lapse sets it anywhere.
  Setting adjust(const Adjustment& adjustment) const;

 private:
  Parameters parameters_;
};

/// Accuracy and mean decision time for k x, by the closed forms; the limits at 0 are 1/2 and A'^2.
double accuracy(double bound, double kx);
double mean_decision_s(double bound, double kx);

}  // namespace turnpoint::observer

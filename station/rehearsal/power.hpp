#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "station/analysis/course.hpp"
#include "station/protocol/protocol.hpp"
#include "station/simulation/observer.hpp"

namespace turnpoint::rehearsal {

/// One of `of` parts of a study, so that several machines can simulate it. Part `number` (from 1) has every
/// of-th session, beginning with session number - 1. So the sessions with bootstrap intervals are spread
/// evenly over the parts.
struct Part {
  int number = 1, of = 1;
};
int sessions_of(const Part& part, int observers);  ///< number of sessions in a part

struct PowerOptions {
  int observers = 1000;
  std::size_t task = 0;  ///< of a file with several tasks: the number of the one whose numbers are estimated
  simulation::Parameters observer;
  /// 0: each session stands alone. Otherwise so many sessions, by different people around `observer`, make a
  /// study; its findings are those of the report of a study. `observers` must be a multiple.
  int people = 0;
  simulation::Spread between;  ///< how much these people differ
  /// simulation::Question::caution in each block, by its block_labels()
  std::map<std::string, double> cautions;
  std::uint64_t seed = 1;  ///< session i runs with seed + i, at place i of the counterbalancing
  /// Number of sessions with bootstrap intervals, which take most of the time. With a procedure
  /// that chooses levels by the answers, intervals come from a posterior instead. That is fast, so every
  /// session gets them.
  int interval_sessions = 200;
  int replicates = 200;  ///< number of resamples for each bootstrap interval, at least 40
  int threads = 2;
  std::function<void(int done, int of)> progress;  ///< called from any of the threads, one at a time
  Part part;
  /// Once a stop is requested, no further session is begun. The result then covers fewer observers.
  std::stop_token stop;
};

/// How well sessions recover one number. `truth` is a parameter of the simulated observer, or is computed
/// from such parameters; it is never an estimate.
/// - Procedure: the truth is the level at which the observer gives the proportion of answers on which the
///   procedure converges. For a posterior's threshold, that proportion lies at a fixed fraction of the way
///   between the asymptotes; for a staircase, it is the target of its rule and steps.
/// - Fit: the truth is the level at which the observer's own function has the value that the fitted function
///   has at its threshold. The slope has a truth only if both functions are of the same family.
/// - Difference between conditions: the truth is the difference of the probabilities, boundaries and times
///   that produced the answers.
/// - Curve at a response signal: the truth is the curve of the fitted shape that describes the observer's own
///   answers best (analysis::limiting_curve()).
/// - Study: the truth is the mean over all simulated people.
/// - Response times, and scores computed from them, have no truth.
struct Recovery {
  std::string source;     ///< "procedure upper", "fit", "fit speed", "accuracy - speed"
  std::string parameter;  ///< "threshold", "PSE", "spread", "75 % point", "proportion correct", ...
  std::string unit;       ///< unit of the estimates; "" if the protocol's level has no unit
  std::optional<double> truth;
  /// the estimates, in the order of the sessions; sessions without an estimate are left out
  std::vector<double> estimates;
  int sessions = 0;           ///< number of sessions analysed, with or without an estimate
  bool heavy_tailed = false;  ///< true for slopes and spreads: use median and quartiles, not mean and SD
  double mean = 0, sd = 0;
  double median = 0, lower_quartile = 0, upper_quartile = 0;
  std::optional<double> bias;                    ///< mean - truth; if heavy-tailed, median - truth
  std::optional<analysis::Proportion> coverage;  ///< proportion of 95 % intervals that contain the truth
  std::optional<double> interval_width;          ///< median width of the 95 % intervals
  /// of a difference: proportion of sessions (or studies) that claim it, because its interval excludes 0 (of a
  /// ratio: 1) or its corrected p value is below 0.05. The power; if the truth is 0, the false alarms
  std::optional<analysis::Proportion> claimed;
};

/// The results of simulated sessions of a protocol with one observer as the participant.
struct Power {
  int observers = 0, interval_sessions = 0;
  int asked = 0;                   ///< PowerOptions::observers; after a stop it is larger than `observers`
  double trials = 0, minutes = 0;  ///< number of trials and duration, averaged over the simulated sessions
  std::optional<double> accuracy;  ///< proportion correct of all scored experimental answers
  /// proportion of the sessions with intervals in which the check of the diffusion model finds a misfit (p
  /// below 0.05): false alarms, if the observer is a diffusion without variability
  std::optional<analysis::Proportion> misfits;
  /// for comparisons: proportion of the sessions with a scale of which the prior decides some places, because
  /// the answers set them no limit (analysis::ScaleFit::separated)
  std::optional<analysis::Proportion> separated;
  int people = 0;  ///< PowerOptions::people; Recovery::sessions are then studies
  std::vector<Recovery> recoveries;
};

/// Simulates sessions and analyses each as its report would. The result depends only on the options, except
/// `threads`. If a stop is requested before the first session is done, the result has no sessions. Throws
/// std::invalid_argument for options out of range, and UsageError if there is nothing to estimate.
Power power(const protocol::Protocol& protocol, const PowerOptions& options);

}  // namespace turnpoint::rehearsal

#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/course.hpp"
#include "station/observer/observer.hpp"
#include "station/protocol/protocol.hpp"

namespace turnpoint::simulation {

struct PowerOptions {
  int observers = 1000;
  observer::Parameters observer;
  std::uint64_t seed = 1;  ///< session i runs with seed + i and sequence index i
  /// Number of sessions that also get bootstrap intervals, which take most of the time. Posterior intervals
  /// (used if the answers chose the levels) are cheap, so every session gets them.
  int interval_sessions = 200;
  int replicates = 200;  ///< for each interval's bootstrap, at least 40
  int threads = 2;
  std::function<void(int done, int of)> progress;  ///< called from any of the threads, one at a time
};

/// How well sessions recover one number. `truth` is a parameter of the observer, or follows only from such
/// parameters, and is never an estimate.
/// For a procedure it is the level at which the observer's answers have the proportion on which the procedure
/// converges (a posterior's threshold: a fixed share of the way between the asymptotes; a staircase: the
/// target of its rule and steps).
/// For a fit it is the level at which the observer's own function reaches the value that the fitted function
/// has at its threshold, and its slope if both functions are of the same family.
/// For a difference between conditions it is the difference of the probabilities, boundaries and times that
/// produced the answers.
/// It is empty for response times and the scores computed from them.
struct Recovery {
  std::string source;     ///< "procedure upper", "fit", "fit speed", "accuracy - speed"
  std::string parameter;  ///< "threshold", "PSE", "spread", "75 % point", "proportion correct", ...
  std::string unit;       ///< "" if the protocol's level has no unit
  std::optional<double> truth;
  std::vector<double> estimates;  ///< from the sessions that had one, in order
  int sessions = 0;               ///< number of sessions that could have had one
  bool heavy_tailed = false;      ///< for slopes and spreads: use median and quartiles, not mean and SD
  double mean = 0, sd = 0;
  double median = 0, lower_quartile = 0, upper_quartile = 0;
  std::optional<double> bias;                    ///< mean - truth; if heavy-tailed, median - truth
  std::optional<analysis::Proportion> coverage;  ///< share of 95 % intervals that contain the truth
  std::optional<double> interval_width;          ///< their median width
};

/// What sessions of a protocol would find with this observer.
struct Power {
  int observers = 0, interval_sessions = 0;
  double trials = 0, minutes = 0;  ///< mean over the sessions
  std::optional<double> accuracy;  ///< proportion correct of scored experimental answers
  std::vector<Recovery> recoveries;
};

/// Simulates sessions and analyses each as its report would. The same options give the same result with any
/// number of threads. Throws std::invalid_argument for options out of range.
Power power(const protocol::Protocol& protocol, const PowerOptions& options);

}  // namespace turnpoint::simulation

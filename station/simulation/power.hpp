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
  /// So many sessions also get intervals by bootstraps, which cost most of the time. Intervals of posteriors,
  /// where the answers chose the levels, cost little, and every session gets them.
  int interval_sessions = 200;
  int replicates = 200;  ///< of each interval's bootstrap, at least 40
  int threads = 2;
  std::function<void(int done, int of)> progress;  ///< from any of the threads, one at a time
};

/// How well sessions recover one number. `truth` is a value that the observer was made with, or follows from
/// such values alone, never an estimate: of a procedure, the level at which the observer answers as the
/// procedure converges (a posterior's threshold: its function's fixed share of the way between the
/// asymptotes; a staircase: the target of its rule and steps); of a fit, the level at which the observer's
/// own function stands where the fitted one has its threshold, and its slope where both are of one family; of
/// a difference between conditions, that of the probabilities, boundaries and times that made the answers.
/// None where there is no such value: response times and the scores made from them.
struct Recovery {
  std::string source;     ///< "procedure upper", "fit", "fit speed", "accuracy - speed"
  std::string parameter;  ///< "threshold", "PSE", "spread", "75 % point", "proportion correct", ...
  std::string unit;       ///< "" where the protocol's level has none
  std::optional<double> truth;
  std::vector<double> estimates;  ///< of the sessions that had one, in order
  int sessions = 0;               ///< that could have had one
  bool heavy_tailed = false;      ///< slopes and spreads: read median and quartiles, not mean and SD
  double mean = 0, sd = 0;
  double median = 0, lower_quartile = 0, upper_quartile = 0;
  std::optional<double> bias;                    ///< mean - truth; heavy-tailed: median - truth
  std::optional<analysis::Proportion> coverage;  ///< 95 % intervals that hold the truth
  std::optional<double> interval_width;          ///< their median
};

/// What a protocol's sessions would find with this observer.
struct Power {
  int observers = 0, interval_sessions = 0;
  double trials = 0, minutes = 0;  ///< mean over the sessions
  std::optional<double> accuracy;  ///< share right of scored experimental answers
  std::vector<Recovery> recoveries;
};

/// Simulates sessions and analyses each as its report would. The same options give the same result with any
/// number of threads. Throws std::invalid_argument for options out of range.
Power power(const protocol::Protocol& protocol, const PowerOptions& options);

}  // namespace turnpoint::simulation

#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/analysis/course.hpp"
#include "station/analysis/estimate.hpp"
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// How an unbiased observer of signal detection theory derives the answer from one observation for each
/// interval. The observations have normal distributions with a standard deviation of 1, whose means are d'
/// apart.
enum class Deciding {
  largest,  ///< one of m intervals has the signal: choose the largest observation (Green & Swets 1966)
  /// ABX and match-to-sample: which of A and B is the larger, and on which side of the criterion X lies,
  /// are decided independently (Macmillan & Creelman 2005, eq. 9.6)
  independent,
  /// ABX and match-to-sample: X is taken for the nearer of A and B (Macmillan & Creelman 2005, eq. 9.7)
  differencing,
};

/// The name in reports: "largest of m", "independent observations", "differencing".
const char* name(Deciding deciding);

/// Returns the proportion correct of an observer with the sensitivity d'. `intervals` is the m of
/// Deciding::largest, at least 2; the other rules ignore it.
double proportion_correct(Deciding deciding, double d_prime, int intervals);

/// Returns the sensitivity d' of an observer with this proportion correct. For ABX, d' is 0 for all
/// proportions up to 0.5. A proportion of 1 gives infinity, and 0 with `largest` gives minus infinity. Throws
/// std::invalid_argument for a proportion outside of 0 to 1.
double d_prime(Deciding deciding, double proportion, int intervals);

/// The sensitivity in one condition, at one level or over all levels.
struct Discrimination {
  std::string condition;
  std::optional<double> level;  ///< empty for all levels together
  Proportion right;
  /// For each rule in `models`, the d' that follows from the proportion correct with the log-linear
  /// correction. The 95 % interval is that of Clopper and Pearson for the proportion correct, with both ends
  /// turned into d'; an end may be infinite.
  std::vector<std::pair<Deciding, Estimate>> d_primes;
};

/// Analyses answered experimental trials with a score, and computes d' by each of `models`. Results come in
/// the order of detect() (signal_detection.hpp), without levels if there are more than `most_levels`.
std::vector<Discrimination> discriminate(const std::vector<TrialRecord>& trials,
                                         const std::vector<std::string>& order,
                                         const std::vector<Deciding>& models, int intervals,
                                         std::size_t most_levels = 8);

}  // namespace turnpoint::analysis

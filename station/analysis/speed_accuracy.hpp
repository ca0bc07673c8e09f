#pragma once
#include <optional>
#include <vector>

#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// Linear integrated speed-accuracy score in s (Vandierendonck 2017): RTc + PE S_RT / S_PE, with the mean
/// correct time RTc, the proportion of errors PE, and the standard deviations S_RT of times and S_PE of
/// errors. Without any error (S_PE = 0), the score is RTc.
double lisas(double mean_correct_s, double proportion_error, double sd_time_s, double sd_error);

/// Inverse efficiency score in s (Townsend & Ashby 1978): the mean correct time divided by the proportion
/// correct. Empty for a proportion of 0.
std::optional<double> inverse_efficiency(double mean_correct_s, double proportion_correct);

/// Balanced integration score of each cell (Liesefeld & Janczyk 2019, Behav. Res. Methods 51:40-60):
/// z(Pc) - z(RTc). A cell is one participant in one condition. z(Pc) is the z score of the cell's proportion
/// correct, and z(RTc) that of its mean correct time, from the mean and standard deviation (divisor n, as in
/// the authors' own code) over the cells of all participants and conditions. Empty with fewer than three
/// cells, or if all cells have equal accuracy or equal times.
std::optional<std::vector<double>> balanced_integration(const std::vector<double>& proportion_correct,
                                                        const std::vector<double>& mean_correct_s);

/// One bin of the conditional accuracy function.
struct CafBin {
  double mean_time_s = 0, low_s = 0, high_s = 0;
  int trials = 0, correct = 0;
};

/// Returns accuracy as a function of response time, in `bins` (4 to 6) bins with equal numbers of trials.
/// Empty with fewer than 5 scored trials per bin. Element i of `times_s` and of `correct` belong to the same
/// trial.
std::vector<CafBin> conditional_accuracy(const std::vector<double>& times_s, const std::vector<bool>& correct,
                                         int bins = 5);

struct ResponseTimes {
  int count = 0;
  /// mad: median absolute deviation, without the factor 1.4826
  double mean_s = 0, sd_s = 0, median_s = 0, mad_s = 0;
  std::vector<double> deciles_s;  ///< deciles from 10 % to 90 %
};
/// Summarises response times; empty if there are none.
std::optional<ResponseTimes> describe_times(const std::vector<double>& times_s);

/// A rule that decides which response times an analysis keeps.
struct TimeExclusion {
  double below_s = 0;
  std::optional<double> mad;  ///< excludes times further from the median than this multiple of 1.4826 MAD
};

/// Returns true for each time that is kept. Median and MAD (median absolute deviation) are computed from the
/// times of at least `below_s`. If the MAD is 0, the limit of the MAD is not applied.
std::vector<bool> keep_times(const std::vector<double>& times_s, const TimeExclusion& rule);

}  // namespace turnpoint::analysis

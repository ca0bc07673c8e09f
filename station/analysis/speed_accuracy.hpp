#pragma once
#include <optional>
#include <vector>

#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// Linear integrated speed-accuracy score, s (Vandierendonck 2017): RTc + PE S_RT / S_PE. If the whole data
/// set contains no error (S_PE = 0), it is RTc.
double lisas(double mean_correct_s, double proportion_error, double sd_time_s, double sd_error);

/// Inverse efficiency score, s (Townsend & Ashby 1978): RTc / Pc; empty for Pc = 0.
std::optional<double> inverse_efficiency(double mean_correct_s, double proportion_correct);

/// Balanced integration score (Liesefeld & Janczyk 2019), one per cell: z(Pc) - z(RTc) with mean and standard
/// deviation (divisor n - 1) over the given cells. Empty with fewer than three cells, or if accuracy or time
/// is the same in all of them.
std::optional<std::vector<double>> balanced_integration(const std::vector<double>& proportion_correct,
                                                        const std::vector<double>& mean_correct_s);

/// One bin of the conditional accuracy function.
struct CafBin {
  double mean_time_s = 0, low_s = 0, high_s = 0;
  int trials = 0, correct = 0;
};

/// Accuracy as a function of response time, in `bins` (4 to 6) bins of equal counts; empty with fewer than 5
/// scored trials per bin. `times_s` and `correct` are parallel.
std::vector<CafBin> conditional_accuracy(const std::vector<double>& times_s, const std::vector<bool>& correct,
                                         int bins = 5);

struct ResponseTimes {
  int count = 0;
  double mean_s = 0, sd_s = 0, median_s = 0, mad_s = 0;  ///< mad: median absolute deviation, unscaled
  std::vector<double> deciles_s;                         ///< deciles from 10 % to 90 %
};
/// empty if there are no times
std::optional<ResponseTimes> describe_times(const std::vector<double>& times_s);

/// A rule that decides which response times an analysis keeps.
struct TimeExclusion {
  double below_s = 0;
  std::optional<double> mad;  ///< excludes times further from the median than this multiple of 1.4826 MAD
};

/// True for each time that is kept. The median is taken over the times not below `below_s`. If the MAD is 0,
/// it excludes nothing.
std::vector<bool> keep_times(const std::vector<double>& times_s, const TimeExclusion& rule);

}  // namespace turnpoint::analysis

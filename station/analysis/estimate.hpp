#pragma once
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// Half the width of a 95 % interval, in standard errors.
inline constexpr double kZ95 = 1.959963984540054;

/// An estimated number and its confidence or credible interval.
struct Estimate {
  double value = 0;
  Interval interval;
};

}  // namespace turnpoint::analysis

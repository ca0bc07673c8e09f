#pragma once
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// An estimated number and its confidence or credible interval.
struct Estimate {
  double value = 0;
  Interval interval;
};

}  // namespace turnpoint::analysis

#pragma once
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// A number and its interval.
struct Estimate {
  double value = 0;
  Interval interval;
};

}  // namespace turnpoint::analysis

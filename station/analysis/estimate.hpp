#pragma once
#include <cmath>
#include <optional>

#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// Half the width of a 95 % interval, in standard errors.
inline constexpr double kZ95 = 1.959963984540054;

/// An estimated number and its confidence or credible interval.
struct Estimate {
  double value = 0;
  Interval interval;
  /// two-sided p value of the hypothesis that the true value is 0; empty where nothing can be compared with 0
  std::optional<double> p = {};
};

/// The interval of `b - a` from the intervals of two independent estimates (MOVER; Donner & Zou 2002).
inline Estimate difference_of(const Estimate& a, const Estimate& b) {
  const double gap = b.value - a.value;
  return {gap,
          {gap - std::hypot(b.value - b.interval.low, a.interval.high - a.value),
           gap + std::hypot(b.interval.high - b.value, a.value - a.interval.low), a.interval.confidence}};
}

}  // namespace turnpoint::analysis

#pragma once
#include <vector>

#include "station/procedure/spec.hpp"

/// The values from, from + step, ... up to and including `to`.
inline std::vector<double> range(double from, double to, double step) {
  std::vector<double> values;
  for (int i = 0; from + i * step <= to + 1e-9; ++i) values.push_back(from + i * step);
  return values;
}

/// Returns Example 1 of Watson (2017), "QUEST+: a general multidimensional Bayesian adaptive psychometric
/// method", Journal of Vision 17(3):10: the threshold of a Weibull function in dB.
inline turnpoint::procedure::Spec watson_1() {
  turnpoint::procedure::Spec spec;
  spec.name = "watson";
  spec.level = "contrast_dB";
  spec.kind = turnpoint::procedure::Kind::quest_plus;
  spec.stimuli.values = spec.threshold.values = range(-40, 0, 1);
  spec.slope.values = {3.5};
  spec.guess.values = {0.5};
  spec.lapse.values = {0.02};
  spec.stop.trials = 64;
  return spec;
}

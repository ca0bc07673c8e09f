#pragma once
#include <cstddef>
#include <vector>

#include "station/simulation/one_cue.hpp"

namespace turnpoint::simulation {

/// A value of a cue, the answer that is right there, and the weight of such trials.
struct Weighed {
  double value = 0;
  int answer = 0;
  double weight = 0;
};

/// Divides the values into neighbouring ranges, each with one answer, so that as much weight as possible gets
/// its right answer. There are at most `answers` + 1 ranges. Neighbouring values that differ by `grain` or
/// less from the first of them are never divided.
std::vector<CueRange> best_ranges(std::vector<Weighed> values, std::size_t answers, double grain);

}  // namespace turnpoint::simulation

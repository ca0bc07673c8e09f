#pragma once
#include <cstddef>
#include <vector>

#include "station/rehearsal/one_cue.hpp"

namespace turnpoint::rehearsal {

/// A value of a cue (a property of the stimulus that could give the answer away), the right answer at this
/// value, and the weight of such trials.
struct Weighed {
  double value = 0;
  int answer = 0;
  double weight = 0;
};

/// Divides the values into neighbouring ranges, each with one answer, so that the values that get their right
/// answer have the largest possible total weight. There are at most `answers` + 1 ranges. Neighbouring values
/// that differ by `grain` or less from the first of them are never divided.
std::vector<CueRange> best_ranges(std::vector<Weighed> values, std::size_t answers, double grain);

}  // namespace turnpoint::rehearsal

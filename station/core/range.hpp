#pragma once
#include "station/core/texts.hpp"

namespace turnpoint::core {

/// The allowed range of a number in a file. `ends` says which ends are excluded (open). The unit appears only
/// in messages ("mm").
struct Range {
  double low = 0, high = 0;
  enum class Ends { closed, open_low, open_high, open } ends = Ends::closed;
  const char* unit = "";
};

/// Describes a range for people: `from 0 to 1 mm`, `above 0 um`, ...
Phrase describe(const Range& range);
/// True if the value is finite and within the range.
bool inside_range(double value, const Range& range);

}  // namespace turnpoint::core

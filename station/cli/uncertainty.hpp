#pragma once
#include <string>

#include "station/text/number.hpp"

namespace turnpoint::cli {

/// Formats the uncertainty of a boundary (one standard deviation) for a line of text.
inline std::string uncertainty_in_words(double uncertainty_m) {
  if (!(uncertainty_m > 0)) return "uncertainty not known: the rig file states no standard deviations";
  return "uncertain by " + text::number(1e3 * uncertainty_m, 3) +
         " mm (SD) because of the rig's parameters; see `turnpoint map --budget`";
}

}  // namespace turnpoint::cli

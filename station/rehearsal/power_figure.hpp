#pragma once
#include "station/rehearsal/power.hpp"
#include "station/report/chart.hpp"

namespace turnpoint::rehearsal {

/// Draws a histogram of the estimates of each recovered number, with its true value as a line.
report::Figure figure_of(const Power& power, const std::string& title);

}  // namespace turnpoint::rehearsal

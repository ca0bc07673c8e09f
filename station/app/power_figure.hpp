#pragma once
#include "station/app/power.hpp"
#include "station/plot/chart.hpp"

namespace turnpoint::app {

/// A histogram of the estimates of each recovered number, with its truth as a line.
plot::Figure figure_of(const Power& power, const std::string& title);

}  // namespace turnpoint::app

#pragma once
#include "station/plot/chart.hpp"
#include "station/simulation/power.hpp"

namespace turnpoint::simulation {

/// Draws a histogram of the estimates of each recovered number, with its true value as a line.
plot::Figure figure_of(const Power& power, const std::string& title);

}  // namespace turnpoint::simulation

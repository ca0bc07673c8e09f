#pragma once
#include "station/plot/chart.hpp"
#include "station/simulation/power.hpp"

namespace turnpoint::simulation {

/// A histogram of the estimates of each recovered number, with its truth as a line.
plot::Figure figure_of(const Power& power, const std::string& title);

}  // namespace turnpoint::simulation

#pragma once
// Reads the tables of reference values ("oracles") in tests/physics/oracles.
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "physics/surface.hpp"

namespace turnpoint::physics_test {

// Returns all rows of the file tests/physics/oracles/NAME, split at commas.
inline std::vector<std::vector<std::string>> oracle(const std::string& name) {
  const std::string path = std::string(TURNPOINT_SOURCE_DIR) + "/tests/physics/oracles/" + name;
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream cells(line);
    auto& row = rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
  }
  return rows;
}

// Sets the loss of a surface from the loss of its waves, k (1 - i/2Q), which the tables state; 0 means none.
// The surface itself states what a resonance curve shows, which is half of that in bending.
inline void set_wave_loss(physics::Surface& surface, double frequency_Hz, double wave_quality) {
  surface.quality_factor = std::numeric_limits<double>::infinity();
  if (wave_quality == 0) return;
  const double tension = surface.tension_Pa * surface.thickness_m;
  double share = 1;
  if (physics::bending_modelled(surface)) {
    const double stiffness = physics::bending_stiffness_N_m(surface).value();
    const double inertia = surface.density_kg_m3 * surface.thickness_m * std::pow(2 * M_PI * frequency_Hz, 2);
    const double bent = 0.5 * (std::sqrt(tension * tension + 4 * stiffness * inertia) - tension);
    share = (bent + tension) / (2 * bent + tension);
  }
  surface.quality_factor = share * wave_quality;
}

}  // namespace turnpoint::physics_test

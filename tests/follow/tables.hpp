#pragma once
// What a calibration of the plant would measure: its friction table and the planned field.
#include <vector>

#include "physics/friction.hpp"
#include "station/follow/gain_map.hpp"
#include "tests/follow/plant.hpp"

namespace lab {

using namespace turnpoint;

/// The friction table of a finger, as strokes over the surface would measure it.
inline physics::FrictionMap table_of(const plant::Setup& finger) {
  std::vector<physics::FrictionPoint> points;
  for (int i = 0; i <= 60; ++i) {
    const double um = 0.0025 * i * i;
    points.push_back({um * 1e-6, i == 0 ? 1.0 : plant::relative_friction(finger, um), 0.01});
  }
  return physics::FrictionMap(points);
}

inline follow::GainMap map_of(const plant::Setup& setup, const physics::FrictionMap& friction,
                              double most_gain = 1) {
  std::vector<double> x_m, displacement_m;
  for (int i = 0; i <= 400; ++i) {
    x_m.push_back(setup.length_m * i / 400);
    displacement_m.push_back(1e-6 * plant::field_um(setup, x_m.back()));
  }
  return follow::GainMap(x_m, displacement_m, {}, friction, setup.fingertip_m, most_gain);
}

}  // namespace lab

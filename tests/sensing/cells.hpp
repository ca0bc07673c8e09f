#pragma once
#include <cstddef>
#include <random>

#include "station/sensing/force_calibration.hpp"

namespace turnpoint::sensing {

/// Two cells 160 mm apart below the surface, and a lateral cell. The finger is 8 mm above the pivots of the
/// two cells. The crosstalk between all three cells is random, with a standard deviation of 2 %.
struct Cells {
  double span_mm = 160, height_mm = 8;
  double gain[3] = {0.067, 0.069, 0.065};  // ratio of bridge to reference per newton
  double crosstalk[3][3]{};

  explicit Cells(std::mt19937_64& random) {
    std::normal_distribution<double> normal(0, 0.02);
    for (auto& row : crosstalk)
      for (double& share : row) share = normal(random);
  }
  Readings readings(double normal_N, double lateral_N, double position_mm) const {
    const double forces[3] = {
        normal_N * (1 - position_mm / span_mm) - height_mm * lateral_N / span_mm,
        normal_N * position_mm / span_mm + height_mm * lateral_N / span_mm,
        lateral_N,
    };
    Readings all{};
    for (std::size_t i = 0; i < 3; ++i) {
      all[i] = forces[i];
      for (std::size_t k = 0; k < 3; ++k)
        if (k != i) all[i] += crosstalk[i][k] * forces[k];
      all[i] *= gain[i];
    }
    return all;
  }
};

}  // namespace turnpoint::sensing

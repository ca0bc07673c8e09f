#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "station/sensing/carrier.hpp"

namespace turnpoint::sensing {

/// Force on the surface at one point of the grid. The moment is normal force times position, so the position
/// is moment_Nmm / normal_N. Positions count from the wide edge.
struct Force {
  double normal_N = 0, lateral_N = 0, moment_Nmm = 0;
};
struct ForcePoint {
  std::int64_t index = 0;
  Force force;  ///< NaN where the bridges are
};

/// Readings of the cells a, b and of the lateral cell: bridge / reference, without the tare.
using Readings = std::array<double, bridge_count>;

/// One known load: a weight on the surface, with or without a pull along it by a string over a pulley. The
/// string must pull at the height of the surface, because the moment of that height is part of the fit.
struct DeadWeight {
  double normal_N = 0, lateral_N = 0, position_mm = 0;
  Readings readings{};
};

/// How well the loads are known (one standard deviation). The error of a place is the same for all weights at
/// that place, and the friction of the pulley the same for all pulls in one direction.
struct WeightErrors {
  double place_mm = 0.2;
  double pulley_share = 0.01;
  double mass_share = 2e-4;
  double reading_N = 0.2e-3;  ///< noise and drift of one reading
};

/// Standard deviations of what is measured under one load.
struct ForceSd {
  double normal_N = 0, lateral_N = 0, position_mm = 0, friction = 0;
};

/// The map from readings to forces, and how well it is known.
class ForceCalibration {
 public:
  /// Rows: readings a, b, lateral; columns: normal, lateral, moment.
  using Matrix = std::array<std::array<double, 3>, bridge_count>;

  ForceCalibration(const Matrix& matrix, std::vector<Matrix> changes)
      : matrix_(matrix), changes_(std::move(changes)) {}

  Force force(const Readings& readings) const;
  /// From the errors of the weights; noise of the readings comes on top.
  ForceSd sd(const Readings& readings) const;
  const Matrix& matrix() const { return matrix_; }

 private:
  Matrix matrix_;
  std::vector<Matrix> changes_;  ///< change of the matrix for one standard deviation of each source of error
};

/// What the fit leaves of one weight: measured minus stated.
struct WeightResidual {
  double normal_N = 0, lateral_N = 0, position_mm = 0;
};
struct WeightFit {
  ForceCalibration calibration;
  std::vector<WeightResidual> residuals;  ///< in the order of the weights
  /// Root mean square of the residuals of normal force, lateral force and moment, in units of what
  /// WeightErrors lets expect. If it exceeds 1, the standard deviations are enlarged by it.
  std::array<double, 3> misfit{};
};

/// Fits [normal, lateral, normal x position] = [a, b, lateral] K by weighted least squares. Lateral loads are
/// needed, at two places or more: the finger pulls at a height h above the cells' pivots, which moves the
/// centre of pressure by h T / N. Throws terms::UsageError if the weights do not determine the fit.
WeightFit fit_weights(const std::vector<DeadWeight>& weights, const WeightErrors& errors = {});

enum class TareState {
  ok,
  moved,       ///< more than 5 mN since the tare before: use it, and say so
  stopped,     ///< more than 20 mN: something lies on the surface, or a cell is damaged
  restless,    ///< scatters by 2 mN or more: the surface is touched or shaken
  incomplete,  ///< fewer than 300 ms, missing frames, or a wire fault
};

/// Readings without a finger, and what is wrong with them.
struct Tare {
  TareState state = TareState::incomplete;
  Readings readings{};
  double moved_N = 0;  ///< the larger of the changes of normal and lateral force
  double sd_N = 0;     ///< the larger of their standard deviations
};

/// Takes the mean of all points (300 ms or more) as the tare, and compares it with the tare before.
Tare tare(std::span<const BridgePoint> points, Band band, const ForceCalibration& calibration,
          const Readings& before);

/// Force of a point. NaN if its readings are NaN or it has a wire fault.
ForcePoint force_point(const BridgePoint& point, const ForceCalibration& calibration, const Readings& tare);

}  // namespace turnpoint::sensing

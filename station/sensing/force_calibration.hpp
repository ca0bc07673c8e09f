#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "station/sensing/carrier.hpp"

namespace turnpoint::sensing {

/// Force on the surface at one point in time. `moment_Nmm` is normal force times position, so the position is
/// moment_Nmm / normal_N. Positions count from the wide edge.
struct Force {
  double normal_N = 0, lateral_N = 0, moment_Nmm = 0;
};
struct ForcePoint {
  std::int64_t index = 0;
  Force force;  ///< NaN if the bridge signals are NaN or have a wire fault
};

/// Readings of the force cells (a and b below the surface, then the lateral cell): bridge signal divided by
/// reference signal, after subtracting the tare.
using Readings = std::array<double, bridge_count>;

/// One known load: a weight on the surface, with or without a pull along the surface by a string over a
/// pulley. The string must pull at the height of the surface, as a finger does, because the fitted matrix
/// also corrects for the moment of a pull at this height.
struct DeadWeight {
  double normal_N = 0, lateral_N = 0, position_mm = 0;
  Readings readings{};
};

/// How well the loads are known (one standard deviation). All weights at one place share the error of that
/// place, and all pulls in one direction share the friction of the pulley.
struct WeightErrors {
  double place_mm = 0.2;
  double pulley_share = 0.01;
  double mass_share = 2e-4;
  double reading_N = 0.2e-3;  ///< noise and drift of one reading, as a force
};

/// Standard deviations of the measured forces, position and friction under one load.
struct ForceSd {
  double normal_N = 0, lateral_N = 0, position_mm = 0, friction = 0;
};

/// Converts readings to forces, and states the uncertainty of the forces.
class ForceCalibration {
 public:
  /// Rows: readings a, b, lateral; columns: normal force, lateral force, moment.
  using Matrix = std::array<std::array<double, 3>, bridge_count>;

  ForceCalibration(const Matrix& matrix, std::vector<Matrix> changes)
      : matrix_(matrix), changes_(std::move(changes)) {}

  Force force(const Readings& readings) const;
  /// Uncertainty that comes from the errors of the calibration weights, without the noise of the readings.
  ForceSd sd(const Readings& readings) const;
  const Matrix& matrix() const { return matrix_; }
  const std::vector<Matrix>& changes() const { return changes_; }

 private:
  Matrix matrix_;
  std::vector<Matrix> changes_;  ///< changes of the matrix by one standard deviation of each source of error
};

/// Measured load minus true load of one weight, after the fit.
struct WeightResidual {
  double normal_N = 0, lateral_N = 0, position_mm = 0;
};
struct WeightFit {
  ForceCalibration calibration;
  std::vector<WeightResidual> residuals;  ///< one for each weight, in the order of the weights
  /// Root mean square of the residuals of normal force, lateral force and moment, relative to the value
  /// expected from WeightErrors. A misfit above 1 enlarges the standard deviations by the same factor.
  std::array<double, 3> misfit{};
};

/// Fits the matrix K in [normal, lateral, normal x position] = [a, b, lateral] K by weighted least squares.
/// Lateral loads at two places or more are needed: the finger pulls at a height h above the cells' pivots, so
/// a lateral force T with the normal force N moves the centre of pressure by h T / N. Throws
/// core::UsageError if the weights do not determine the fit.
WeightFit fit_weights(const std::vector<DeadWeight>& weights, const WeightErrors& errors = {});

/// For each weight: how far its load is from what a fit to the other weights gives. The figure is the largest
/// deviation among its normal force, lateral force and moment, in standard deviations that include the
/// scatter of the other weights. 0 if the other weights do not determine a fit.
std::vector<double> deviations(const std::vector<DeadWeight>& weights, const WeightErrors& errors = {});

enum class TareState {
  ok,
  moved,       ///< changed by more than 5 mN since the previous tare: use it, and report the change
  stopped,     ///< changed by more than 20 mN: something lies on the surface, or a cell is damaged
  restless,    ///< standard deviation of 2 mN or more: the surface is touched or shaken
  incomplete,  ///< fewer than 300 ms, missing frames, or a wire fault
};

/// Readings without a finger on the surface, and whether they can be used as the tare.
struct Tare {
  TareState state = TareState::incomplete;
  Readings readings{};
  double moved_N = 0;  ///< change of normal or lateral force since the previous tare, whichever is larger
  double sd_N = 0;     ///< standard deviation of normal or lateral force, whichever is larger
};

/// Takes the mean of all points (300 ms or more) as the new tare, and compares it with `before`, the previous
/// tare.
Tare tare(std::span<const BridgePoint> points, Band band, const ForceCalibration& calibration,
          const Readings& before);

/// The force at a point, after subtracting the tare. NaN if the readings are NaN or have a wire fault.
ForcePoint force_point(const BridgePoint& point, const ForceCalibration& calibration, const Readings& tare);

}  // namespace turnpoint::sensing

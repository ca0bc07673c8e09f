// Tests the whole chain of this layer, from captured samples to the felt step (the place where the finger
// meets the change of friction).
#include <algorithm>
#include <cmath>

#include "station/sensing/felt_step.hpp"
#include "tests/sensing/bridge_signal.hpp"
#include "tests/sensing/cells.hpp"
#include "tests/sensing/finger.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::sensing;

namespace {

constexpr double newton = BridgeSignal::N_per_ratio;

/// Returns the samples that the sound card would capture while a finger exerts the forces of `recording`.
/// `cells` turns each force into a ratio of bridge signal to reference signal.
std::vector<std::int32_t> captured(const Cells& cells, const Finger::Recording& recording) {
  std::vector<Readings> readings;
  for (const auto& point : recording.forces)
    readings.push_back(cells.readings(point.force.normal_N, point.force.lateral_N,
                                      point.force.moment_Nmm / point.force.normal_N));
  BridgeSignal signal;
  signal.noise_V_rtHz = 4e-9;
  signal.forces_N = [&](double t) {
    const auto i = std::min(static_cast<std::size_t>(1000 * t), readings.size() - 2);
    const double share = 1000 * t - static_cast<double>(i);
    Readings forces;
    for (std::size_t k = 0; k < 3; ++k)
      forces[k] = newton * ((1 - share) * readings[i][k] + share * readings[i + 1][k]);
    return forces;
  };
  return signal.frames(0, 192 * (readings.size() - 1));
}

ForceCalibration exact_calibration(const Cells& cells) {
  std::vector<DeadWeight> weights;
  for (const double place : {20.0, 80.0, 140.0})
    for (const double pull : {-0.5, 0.0, 0.5})
      weights.push_back({1, pull, place, cells.readings(1, pull, place)});
  return fit_weights(weights).calibration;
}

struct Result {
  /// root mean square errors of position and (relative) speed, within strokes
  double position_mm = 0, speed_share = 0;
  std::optional<FeltStep> step;
  std::size_t strokes = 0;
};

Result result(const std::vector<BridgePoint>& points, const ForceCalibration& calibration,
              const Finger::Recording& recording) {
  std::vector<ForcePoint> forces;
  for (const auto& point : points) forces.push_back(force_point(point, calibration, {}));
  const auto track = finger_track(forces);
  const auto strokes = find_strokes(track);
  Result result;
  result.strokes = strokes.size();
  double count = 0, speed = 0;
  for (const auto& stroke : strokes)
    for (std::size_t i = stroke.first; i < stroke.end; ++i) {
      const auto truth = recording.smooth_truth(static_cast<std::size_t>(track[i].index));
      result.position_mm += std::pow(track[i].position_mm - truth.position_mm, 2);
      result.speed_share += std::pow(track[i].speed_mm_s - truth.speed_mm_s, 2);
      speed += truth.speed_mm_s * truth.speed_mm_s;
      ++count;
    }
  result.position_mm = std::sqrt(result.position_mm / count);
  result.speed_share = std::sqrt(result.speed_share / speed);
  result.step = felt_step(friction_profile(track, strokes, {44, 2, 36}));
  return result;
}

}  // namespace

TEST_CASE("samples of a finger on the cells become its track and the step that it felt", "[sensing]") {
  std::mt19937_64 random(21);
  const Cells cells(random);
  Finger finger;
  finger.strokes = 6;
  finger.cell_noise_N = 0;
  finger.friction_noise = 0.02;
  const auto recording = finger.record(random);
  const auto samples = captured(cells, recording);
  const auto points = demodulated(bridge_options(), 0, samples);
  const auto calibration = exact_calibration(cells);

  const Result good = result(points, calibration, recording);
  CHECK(good.strokes == 6);
  CHECK(good.position_mm < 0.2);
  CHECK(good.speed_share < 0.03);
  REQUIRE(good.step);
  CHECK(good.step->boundary_mm == Approx(80).margin(0.5));
  CHECK(good.step->friction_below == Approx(0.8).epsilon(0.05));
  CHECK(good.step->friction_above == Approx(0.4).epsilon(0.05));

  // negative control: a calibration that ignores the height of the finger above the cells
  auto matrix = calibration.matrix();
  matrix[2][2] = 0;
  CHECK(result(points, ForceCalibration(matrix, {}), recording).position_mm > 2);

  // A gap of 50 ms divides the third stroke. Only one part of this stroke is long enough to count.
  BridgeDemodulator demodulator(bridge_options());
  std::vector<BridgePoint> with_gap;
  const auto take = [&](const BridgePoint& point) { with_gap.push_back(point); };
  const std::size_t at = 192 * (300 + 2 * 1200 + 500), lost = 192 * 50;
  demodulator.push({std::span(samples).first(4 * at), 4, 0}, take);
  demodulator.push({std::span(samples).subspan(4 * (at + lost)), 4, static_cast<std::int64_t>(at + lost)},
                   take);
  CHECK(with_gap.size() == points.size());
  const Result gap = result(with_gap, calibration, recording);
  CHECK(gap.strokes == 6);
  CHECK(gap.position_mm < 0.2);
  REQUIRE(gap.step);
  CHECK(gap.step->boundary_mm == Approx(80).margin(0.7));
}

#include "station/sensing/force_calibration.hpp"

#include <cmath>
#include <limits>
#include <random>

#include "station/core/usage_error.hpp"
#include "tests/sensing/cells.hpp"
#include "tests/sensing/studies.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::sensing;

namespace {

constexpr double g = 9.80665;

/// Weights of 20 to 200 g at five places; pulls of 20 to 100 g over a pulley in both directions at two
/// places, with 200 g on the surface. The true places differ by 0.2 mm (sd), the true pulls by 1 %.
std::vector<DeadWeight> weights(const Cells& cells, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<DeadWeight> all;
  double off_mm[5], pulley[2];
  for (double& off : off_mm) off = 0.2 * normal(random);
  for (double& share : pulley) share = 0.01 * normal(random);
  const auto put = [&](double grams, double pull_grams, int place) {
    DeadWeight weight{g * grams / 1000, g * pull_grams / 1000, 20 + 30.0 * place, {}};
    const double mass = 1 + 5e-5 * normal(random);
    weight.readings =
        cells.readings(weight.normal_N * mass, weight.lateral_N * (1 + pulley[pull_grams > 0 ? 1 : 0]),
                       weight.position_mm + off_mm[place]);
    for (std::size_t i = 0; i < 3; ++i) weight.readings[i] += cells.gain[i] * 1e-4 * normal(random);
    all.push_back(weight);
  };
  for (int place = 0; place < 5; ++place)
    for (const double grams : {20, 50, 100, 200}) put(grams, 0, place);
  for (const int place : {1, 3})
    for (const double grams : {20, 50, 100})
      for (const double direction : {-1, 1}) put(200, direction * grams, place);
  return all;
}

struct Errors {
  /// root mean square errors of normal force (relative), friction and position
  double normal_share = 0, friction = 0, position_mm = 0;
  /// proportion of errors within 1.96 of the stated standard deviations
  double covered_position = 0, covered_friction = 0;
};

/// Returns the errors over many calibrated stations, each tested with 3 forces at 3 positions and with
/// friction in both directions. Without `with_height`, the calibration ignores the height of the finger above
/// the cells.
Errors errors(int stations, bool with_height) {
  std::mt19937_64 random(11);
  Errors sum;
  double count = 0;
  for (int station = 0; station < stations; ++station) {
    const Cells cells(random);
    auto calibration = fit_weights(weights(cells, random)).calibration;
    if (!with_height) {
      auto matrix = calibration.matrix();
      matrix[2][2] = 0;
      calibration = ForceCalibration(matrix, {});
    }
    for (const double normal_N : {0.2, 0.5, 1.0})
      for (const double position_mm : {30.0, 80.0, 130.0})
        for (const double friction : {-0.6, 0.6}) {
          const auto readings = cells.readings(normal_N, friction * normal_N, position_mm);
          const Force force = calibration.force(readings);
          const ForceSd sd = calibration.sd(readings);
          const double off_mm = force.moment_Nmm / force.normal_N - position_mm,
                       off = force.lateral_N / force.normal_N - friction;
          sum.normal_share += std::pow(force.normal_N / normal_N - 1, 2);
          sum.friction += off * off;
          sum.position_mm += off_mm * off_mm;
          sum.covered_position += std::abs(off_mm) < 1.96 * sd.position_mm ? 1 : 0;
          sum.covered_friction += std::abs(off) < 1.96 * sd.friction ? 1 : 0;
          ++count;
        }
  }
  return {std::sqrt(sum.normal_share / count), std::sqrt(sum.friction / count),
          std::sqrt(sum.position_mm / count), sum.covered_position / count, sum.covered_friction / count};
}

/// Returns 300 ms of points without a finger: a constant offset of the normal force, `normal_N`, and noise.
std::vector<BridgePoint> rest(const Cells& cells, double normal_N, double noise_N) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<BridgePoint> all;
  for (int i = 0; i < 300; ++i)
    all.push_back({.index = i, .ratio = cells.readings(normal_N + noise_N * normal(random), 0, 60)});
  return all;
}

}  // namespace

TEST_CASE("weights calibrate force, friction and position", "[sensing]") {
  const Errors with = errors(repetitions(100), true);
  say("calibrated by weights: N ", 100 * with.normal_share, " %, mu ", with.friction, ", x ",
      with.position_mm, " mm rms; x covered ", 100 * with.covered_position, " %, mu ",
      100 * with.covered_friction, " %");
  CHECK(with.normal_share < 1e-3);
  CHECK(with.friction < 0.006);
  CHECK(with.position_mm < 0.2);
  CHECK(std::abs(with.covered_position - 0.95) < 0.04);
  CHECK(std::abs(with.covered_friction - 0.95) < 0.04);
  const Errors without = errors(5, false);
  say("without the height of the finger: x ", without.position_mm, " mm rms");
  CHECK(without.position_mm > 2);
}

TEST_CASE("residuals show the weight that was put in the wrong place", "[sensing]") {
  std::mt19937_64 random(5);
  const Cells cells(random);
  auto all = weights(cells, random);
  CHECK(fit_weights(all).misfit[2] < 1.5);
  all[10].readings = cells.readings(all[10].normal_N, 0, all[10].position_mm + 3);
  const auto fit = fit_weights(all);
  CHECK(fit.misfit[2] > 1.5);
  std::size_t worst = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (std::abs(fit.residuals[i].position_mm) > std::abs(fit.residuals[worst].position_mm)) worst = i;
  CHECK(worst == 10);
  CHECK(fit.residuals[10].position_mm == Approx(3).margin(0.5));
}

TEST_CASE("weights without a pull along the surface are not enough", "[sensing]") {
  std::mt19937_64 random(5);
  Cells cells(random);
  for (auto& row : cells.crosstalk)
    for (double& share : row) share = 0;
  std::vector<DeadWeight> all;
  for (const double place : {20.0, 80.0, 140.0})
    for (const double force : {0.2, 1.0}) all.push_back({force, 0, place, cells.readings(force, 0, place)});
  CHECK_THROWS_AS(fit_weights(all), core::UsageError);
  CHECK_THROWS_AS(fit_weights({all[0], all[1]}), core::UsageError);
  all.push_back({1, 0.5, 80, cells.readings(1, 0.5, 80)});
  CHECK_NOTHROW(fit_weights(all));
}

TEST_CASE("a tare reports a changed zero, and something that lies on the surface", "[sensing]") {
  std::mt19937_64 random(5);
  const Cells cells(random);
  const auto calibration = fit_weights(weights(cells, random)).calibration;
  const auto state = [&](const std::vector<BridgePoint>& points) {
    return tare(points, Band::force, calibration, {}).state;
  };
  const auto good = tare(rest(cells, 4e-3, 0.3e-3), Band::force, calibration, {});
  CHECK(good.state == TareState::ok);
  CHECK(good.moved_N == Approx(4e-3).epsilon(0.05));
  CHECK(good.sd_N == Approx(0.3e-3).epsilon(0.2));
  CHECK(state(rest(cells, 6e-3, 0.3e-3)) == TareState::moved);
  CHECK(state(rest(cells, -21e-3, 0.3e-3)) == TareState::stopped);
  CHECK(state(rest(cells, 0, 2.4e-3)) == TareState::restless);
  auto points = rest(cells, 0, 0);
  points.pop_back();
  CHECK(state(points) == TareState::incomplete);
  points = rest(cells, 0, 0);
  points[7].ratio[0] = std::numeric_limits<double>::quiet_NaN();
  CHECK(state(points) == TareState::incomplete);
  points[7] = points[8];
  points[9].fault = WireFault::quadrature;
  CHECK(state(points) == TareState::incomplete);
  CHECK(std::isnan(force_point(points[9], calibration, {}).force.normal_N));

  // the tare is subtracted from the force of the next finger
  BridgePoint point{.index = 5, .ratio = cells.readings(0.5 + 4e-3, 0.2, 60)};
  CHECK(force_point(point, calibration, good.readings).force.normal_N == Approx(0.5).margin(1e-3));
  CHECK(force_point(point, calibration, {}).force.normal_N > 0.503);
}

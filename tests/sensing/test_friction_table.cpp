#include "station/sensing/friction_table.hpp"
#include "station/trial/orders.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "station/core/usage_error.hpp"
#include "tests/sensing/studies.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::sensing;

namespace {

const std::vector<double> levels_m{0.2e-6, 0.4e-6, 0.6e-6, 0.8e-6, 1.0e-6, 1.3e-6, 1.7e-6, 2.2e-6};

/// Returns the true relative friction of the simulated skin, which never falls below 0.15.
double truth(double displacement_m) { return 0.15 + 0.85 / (1 + std::pow(displacement_m / 0.65e-6, 2.5)); }
const double true_half_m = 0.65e-6 * std::pow(0.85 / 0.35 - 1, 0.4);

/// Returns simulated strokes with noise of 10 %. The logarithm of the skin's friction rises by nearly `drift`
/// during the measurement.
std::vector<TableStroke> measured(const std::vector<double>& order, std::mt19937_64& random,
                                  double drift = 0.3) {
  std::normal_distribution<double> noise(0, 0.1);
  std::vector<TableStroke> strokes;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double time = static_cast<double>(i) / static_cast<double>(order.size());
    strokes.push_back(
        {order[i], 0.6 * std::exp(drift * (1 - std::exp(-3 * time)) + noise(random)) * truth(order[i])});
  }
  return strokes;
}

struct Study {
  /// root mean square error and largest mean error of ln friction, over all levels
  double rms = 0, worst_bias = 0;
  double covered = 0, least_covered = 1, covered_by_half = 0;
  double half_bias = 0, half_sd = 0, half_covered = 0;
};
Study study(int tables) {
  std::mt19937_64 random(3);
  Study result;
  std::vector<double> bias(8), covered(8);
  double half_square = 0;
  for (int i = 0; i < tables; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    const auto table =
        friction_table(measured(trial::friction_table_order(levels_m, 6, {seed}), random), seed, 300);
    REQUIRE(table.levels.size() == 8);
    for (std::size_t k = 0; k < 8; ++k) {
      const auto& level = table.levels[k];
      const double right = truth(level.displacement_m), error = std::log(level.relative_friction / right);
      result.rms += error * error / 8 / tables;
      bias[k] += error / tables;
      covered[k] += level.interval.low <= right && right <= level.interval.high ? 1.0 / tables : 0;
      const double width = (level.interval.high - level.interval.low) / 4;
      result.covered_by_half += std::abs(level.relative_friction - right) < width ? 1.0 / 8 / tables : 0;
    }
    REQUIRE(table.half_displacement_m);
    const double off = *table.half_displacement_m / true_half_m - 1;
    result.half_bias += off / tables;
    half_square += off * off / tables;
    const auto& interval = table.half_displacement_interval;
    result.half_covered += interval.low <= true_half_m && true_half_m <= interval.high ? 1.0 / tables : 0;
  }
  result.rms = std::sqrt(result.rms);
  result.half_sd = std::sqrt(half_square - result.half_bias * result.half_bias);
  for (std::size_t k = 0; k < 8; ++k) {
    result.worst_bias = std::max(result.worst_bias, std::abs(bias[k]));
    result.covered += covered[k] / 8;
    result.least_covered = std::min(result.least_covered, covered[k]);
    say("level ", 1e6 * levels_m[k], " um: bias ", 100 * bias[k], " %, covered ", 100 * covered[k], " %");
  }
  return result;
}

}  // namespace

TEST_CASE("a friction table is precise, and its intervals have the stated coverage", "[sensing]") {
  const int tables = repetitions(60);
  const bool many = tables >= 400;
  const Study s = study(tables);
  say("levels: ", 100 * s.rms, " % rms, worst bias ", 100 * s.worst_bias, " %, covered ", 100 * s.covered,
      " %, least ", 100 * s.least_covered, " %; by half the interval ", 100 * s.covered_by_half, " %");
  say("half-friction displacement: bias ", 100 * s.half_bias, " %, sd ", 100 * s.half_sd, " %, covered ",
      100 * s.half_covered, " %");
  CHECK(s.rms < 0.06);
  CHECK(s.worst_bias < (many ? 0.02 : 0.035));
  CHECK(s.covered > (many ? 0.90 : 0.88));
  CHECK(s.covered < (many ? 0.98 : 0.995));
  CHECK(s.covered_by_half < 0.85);
  CHECK(std::abs(s.half_bias) < 0.02);
  CHECK(s.half_sd < 0.06);
  CHECK(s.half_covered > (many ? 0.90 : 0.85));
  if (many) {
    CHECK(s.least_covered > 0.90);
    CHECK(s.half_covered < 0.98);
  }
}

TEST_CASE("strokes at rest between the driven ones remove a drift", "[sensing]") {
  std::mt19937_64 random(8);
  auto order = trial::friction_table_order(levels_m, 20, {1});
  // the order that distorts a table most: ascending levels, while the skin's friction falls to a third
  std::vector<double> driven;
  for (const double level : order)
    if (level > 0) driven.push_back(level);
  std::sort(driven.begin(), driven.end());
  order.assign(1, 0);
  for (const double level : driven) order.insert(order.end(), {level, 0});
  const auto strokes = measured(order, random, -1.1);
  const auto table = friction_table(strokes, 1, 100);
  double rest = 0, count = 0, worst_naive = 0;
  for (const auto& stroke : strokes)
    if (stroke.displacement_m == 0) rest += std::log(stroke.friction), ++count;
  for (const auto& level : table.levels) {
    CHECK(std::abs(std::log(level.relative_friction / truth(level.displacement_m))) < 0.08);
    double naive = 0;
    for (const auto& stroke : strokes)
      if (stroke.displacement_m == level.displacement_m) naive += std::log(stroke.friction) / 20;
    worst_naive =
        std::max(worst_naive, std::abs(naive - rest / count - std::log(truth(level.displacement_m))));
  }
  CHECK(worst_naive > 0.3);
}

TEST_CASE("a friction table falls strictly, and a rig can use it", "[sensing]") {
  // the third level measures higher friction than the second, and the first higher than the surface at rest
  std::vector<TableStroke> strokes{{0, 0.5}};
  const double friction[] = {0.52, 0.3, 0.36, 0.2};
  for (int repeat = 0; repeat < 3; ++repeat)
    for (int k = 0; k < 4; ++k) {
      strokes.push_back({1e-6 * (k + 1), friction[k]});
      strokes.push_back({0, 0.5});
    }
  const auto table = friction_table(strokes, 1, 50);
  REQUIRE(table.levels.size() == 4);
  CHECK(table.unused == 0);
  CHECK(table.levels[0].strokes == 3);
  CHECK(table.levels[0].measured == Approx(1.04));
  CHECK(table.levels[0].relative_friction == Approx(1).margin(1e-5));
  CHECK(table.levels[0].relative_friction < 1);
  CHECK(table.levels[1].relative_friction == Approx(std::sqrt(0.6 * 0.72)).epsilon(1e-5));
  CHECK(table.levels[2].relative_friction == Approx(std::sqrt(0.6 * 0.72)).epsilon(1e-5));
  CHECK(table.levels[2].relative_friction < table.levels[1].relative_friction);
  CHECK(table.levels[3].relative_friction == Approx(0.4));
  const physics::FrictionMap map(table.points());
  CHECK(map.relative_friction(4e-6) == Approx(0.4));
  REQUIRE(table.half_displacement_m);
  CHECK(*table.half_displacement_m > 3e-6);
  CHECK(map.relative_friction(*table.half_displacement_m) == Approx(0.5));
}

TEST_CASE(
    "a stroke counts only between valid strokes on the silent surface, and a table of too few strokes is "
    "refused",
    "[sensing]") {
  std::mt19937_64 random(8);
  const auto good = measured(trial::friction_table_order(levels_m, 6, {4}), random);
  CHECK(friction_table(good, 1, 10).unused == 0);
  auto strokes = good;
  // One stroke at rest becomes invalid, so both driven strokes beside it cannot be used.
  strokes[2].friction = std::numeric_limits<double>::quiet_NaN();
  CHECK(friction_table(strokes, 1, 10).unused == 2);
  strokes = good;
  strokes[1].friction = std::numeric_limits<double>::quiet_NaN();
  CHECK(friction_table(strokes, 1, 10).unused == 1);
  int spoiled = 0;
  strokes = good;
  for (auto& stroke : strokes)
    if (stroke.displacement_m == levels_m[3] && spoiled < 4) stroke.friction = 0, ++spoiled;
  CHECK_THROWS_AS(friction_table(strokes, 1, 10), core::UsageError);
  CHECK_THROWS_AS(friction_table({}, 1, 10), core::UsageError);
}

TEST_CASE("every level comes equally often, each between strokes at rest", "[sensing]") {
  const auto order = trial::friction_table_order(levels_m, 6, {5});
  REQUIRE(order.size() == 97);
  for (std::size_t i = 0; i < order.size(); ++i) CHECK((order[i] == 0) == (i % 2 == 0));
  for (const double level : levels_m) CHECK(std::count(order.begin(), order.end(), level) == 6);
  CHECK(order == trial::friction_table_order(levels_m, 6, {5}));
  CHECK(order != trial::friction_table_order(levels_m, 6, {6}));
}

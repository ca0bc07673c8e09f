#include <cmath>
#include <vector>

#include "station/follow/gain_map.hpp"
#include "tests/follow/tables.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using follow::Pattern;

namespace {

/// Friction under the fingertip by the plant's formulas, as the mean over 201 strips of it.
double friction_under(const plant::Setup& s, double place_m, double gain) {
  double sum = 0;
  for (int i = -100; i <= 100; ++i) {
    const double x = std::clamp(place_m + i * s.fingertip_m / 201, 0.0, s.length_m);
    sum += plant::relative_friction(s, gain * plant::field_um(s, x)) / 201;
  }
  return sum;
}

}  // namespace

TEST_CASE("the gain for an asked friction gives it along the strip", "[gain_map]") {
  const plant::Setup s;
  const auto map = lab::map_of(s, lab::table_of(s));
  double worst = 0, worst_back = 0;
  for (double place = 0.006; place < 0.16; place += 0.0013)
    for (double asked = 0.36; asked < 1; asked += 0.01) {
      const double gain = map.gain(place, asked);
      worst = std::max(worst, std::abs(friction_under(s, place, gain) - asked));
      worst_back = std::max(worst_back, std::abs(map.relative_friction(place, gain) - asked));
    }
  CAPTURE(worst, worst_back);
  CHECK(worst < 0.003);
  CHECK(worst_back < 0.002);
  CHECK(map.gain(0.1, 1) == 0);
  CHECK(map.gain(0.1, 1.2) == 0);
  CHECK(map.gain(0.1, 0) == Approx(1));
  CHECK(map.lowest_friction(0.1) == Approx(friction_under(s, 0.1, 1)).margin(0.003));
}

TEST_CASE("the map knows a limit of the gain and the displacement under the finger", "[gain_map]") {
  const plant::Setup s;
  const auto map = lab::map_of(s, lab::table_of(s), 0.5);
  CHECK(map.most_gain() == 0.5);
  CHECK(map.gain(0.1, 0) == Approx(0.5));
  CHECK(map.lowest_friction(0.1) == Approx(friction_under(s, 0.1, 0.5)).margin(0.003));
  const double free_um = plant::field_um(s, 0.1);
  CHECK(map.most_displacement_m(0.1) == Approx(0.5e-6 * free_um).epsilon(0.01));
  CHECK(map.gain_for_displacement(0.1, 0.25e-6 * free_um) == Approx(0.25).epsilon(0.01));
  CHECK(map.gain_for_displacement(0.1, 1e-3) == 0.5);
  CHECK(map.gain_for_displacement(NAN, NAN) == 0);
  CHECK(std::isfinite(map.gain(NAN, 0.5)));
  // nothing moves there, and nothing is asked for
  const std::vector<double> ends{0, 0.1}, still{0, 0};
  const follow::GainMap dead(ends, still, {}, lab::table_of(s), 0.01, 1);
  CHECK(dead.gain_for_displacement(0.05, 0) == 0);
}

TEST_CASE("a finger takes its share of the field under its whole fingertip", "[gain_map]") {
  const plant::Setup s;
  const auto table = lab::table_of(s);
  std::vector<double> x_m, free_m, share;
  for (int i = 0; i <= 800; ++i) {
    x_m.push_back(s.length_m * i / 800);
    free_m.push_back(1e-6 * plant::field_um(s, x_m.back()));
    // it changes by a third within a fingertip
    share.push_back(0.7 + 0.3 * std::sin(2 * 3.14159265358979 * x_m.back() / 0.03));
  }
  const follow::GainMap map(x_m, free_m, share, table, s.fingertip_m, 1);
  double worst = 0, worst_back = 0, most = 0;
  for (std::size_t i = 40; i < 600; i += 7)
    for (double gain = 0.05; gain <= 1; gain += 0.05) {
      const double felt = friction_under(s, x_m[i], gain * share[i]);
      worst = std::max(worst, std::abs(map.relative_friction(x_m[i], gain) - felt));
      worst_back =
          std::max(worst_back, std::abs(map.relative_friction(x_m[i], map.gain(x_m[i], felt)) - felt));
      most = std::max(most, std::abs(felt - friction_under(s, x_m[i], gain)));
    }
  CAPTURE(worst, worst_back, most);
  CHECK(most > 0.3);
  CHECK(worst < 0.006);
  CHECK(worst_back < 0.006);
  CHECK(map.most_displacement_m(x_m[300]) ==
        Approx(share[300] * 1e-6 * plant::field_um(s, x_m[300])).epsilon(0.02));
  CHECK_THROWS(follow::GainMap(x_m, free_m, std::vector<double>{1}, table, s.fingertip_m, 1));
  share[3] = 1.5;
  CHECK_THROWS(follow::GainMap(x_m, free_m, share, table, s.fingertip_m, 1));
}

TEST_CASE("it is said where a pattern cannot be met", "[gain_map]") {
  const plant::Setup s;
  const auto map = lab::map_of(s, lab::table_of(s));
  Pattern pattern;
  pattern.base = 0.5;
  const auto beyond = unmet(pattern, map, 1.0, 0.006, 0.194, 0.01);
  REQUIRE(beyond.size() == 1);
  // the place from which the strip's field no longer reaches 0.5, from the plant's formula
  double first = 0.15;
  while (friction_under(s, first, 1) < 0.51) first += 0.0001;
  CHECK(beyond[0].from_m == Approx(first).margin(0.0006));
  CHECK(beyond[0].to_m == Approx(0.194).margin(0.0002));
  CHECK(beyond[0].asked == 0.5);
  CHECK(beyond[0].least > 0.9);
  CHECK(beyond[0].most == 1.0);
  // friction above that at rest cannot be met anywhere; one event is enough to say so
  follow::Part part;
  part.to = 1.2, part.begin_m = 0.05, part.end_m = 0.06;
  part.trigger.event = follow::Event::force, part.trigger.threshold = 1, part.trigger.delay_s = 0.02;
  add(pattern, part);
  const auto both = unmet(pattern, map, 1.0, 0.006, 0.194, 0.01);
  REQUIRE(both.size() == 2);
  CHECK(both[0].from_m == Approx(0.05).margin(0.0002));
  CHECK(both[0].to_m == Approx(0.06).margin(0.0002));
  CHECK(both[0].asked == 1.2);
  Pattern moves;
  moves.asked = follow::Asked::displacement, moves.base = 1e-6;
  CHECK(unmet(moves, map, 1.0, 0.01, 0.16, 1e-9).empty());
  moves.base = 4e-6;
  CHECK(unmet(moves, map, 1.0, 0.01, 0.16, 1e-9).size() == 1);
}

TEST_CASE("impossible maps are refused", "[gain_map]") {
  const plant::Setup s;
  const auto table = lab::table_of(s);
  const std::vector<double> x{0, 0.1}, bad{1e-6, NAN}, good{1e-6, 1e-6};
  CHECK_THROWS_AS(follow::GainMap(x, bad, {}, table, 0.01, 1), std::invalid_argument);
  CHECK_THROWS_AS(follow::GainMap(x, good, {}, table, 0.01, 0), std::invalid_argument);
  CHECK_THROWS_AS(follow::GainMap(x, good, {}, table, NAN, 1), std::invalid_argument);
  CHECK_THROWS_AS(follow::GainMap(std::vector<double>{0.1, 0.1}, good, {}, table, 0, 1),
                  std::invalid_argument);
  CHECK_THROWS_AS(follow::GainMap(x, std::vector<double>{1e-6}, {}, table, 0.01, 1), std::invalid_argument);
}

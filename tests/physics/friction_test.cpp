#include "physics/friction.hpp"

#include <cmath>

#include "tests/support/catch.hpp"

using namespace turnpoint::physics;

TEST_CASE("the overpressure of a squeeze film has the right limits for small and large excursions",
          "[physics]") {
  CHECK(squeeze_film_overpressure(1e-6) == Approx(1.25e-12).epsilon(1e-9));
  CHECK(squeeze_film_overpressure(0.5) == Approx(std::sqrt(1.375 / 0.75) - 1).epsilon(1e-14));
  CHECK(squeeze_film_overpressure(0) == 0);
  CHECK_THROWS_AS(squeeze_film_overpressure(1), std::invalid_argument);
}

TEST_CASE("the load-sharing model gives the published friction at each amplitude", "[physics]") {
  LoadSharing model;
  model.floor = 0;
  const FrictionMap bare(model);
  const double expected[][2] = {{.25, .91}, {.5, .71}, {.75, .50}, {1, .33}, {1.5, .13}, {2, .04}};
  for (const auto& row : expected) {
    CHECK(bare.relative_friction(row[0] * 1e-6) == Approx(row[1]).margin(0.006));
    if (row[1] > 0.3) CHECK(FrictionMap().relative_friction(row[0] * 1e-6) == Approx(row[1]).margin(0.006));
  }
  CHECK(FrictionMap().relative_friction(1e-3) == Approx(0.1).margin(1e-3));
  CHECK(FrictionMap().illustrative());
}

TEST_CASE("converting an amplitude to friction and back reproduces it to 1e-9", "[physics]") {
  const FrictionMap sharing;
  const FrictionMap table({{0, 1, 0}, {0.3e-6, 0.8, 0.02}, {1e-6, 0.4, 0.03}, {2e-6, 0.3, 0.03}});
  CHECK_FALSE(table.illustrative());
  CHECK(table.sd(1e-6) == Approx(0.03));
  for (const FrictionMap* map : {&sharing, &table}) {
    double last = 1;
    for (double a = 1e-9; a < map->highest_displacement_m(); a *= 1.07) {
      const double mu = map->relative_friction(a);
      CAPTURE(a, mu);
      CHECK(mu < last + 1e-15);
      last = mu;
      REQUIRE(std::abs(map->relative_friction(map->displacement_m(mu).value()) - mu) < 1e-9 * mu);
      if (a > 1e-8) REQUIRE(map->displacement_m(mu).value() == Approx(a).epsilon(1e-9));
    }
    CHECK(map->displacement_m(1).value() == 0);
    CHECK_FALSE(map->displacement_m(map->lowest_friction() * 0.99));
    CHECK_FALSE(map->displacement_m(1.01));
  }
}

TEST_CASE("a friction table must begin with 1 at rest and fall", "[physics]") {
  CHECK_THROWS_AS(FrictionMap(std::vector<FrictionPoint>{{0, 1, 0}}), std::invalid_argument);
  CHECK_THROWS_AS(FrictionMap({{0, 0.9, 0}, {1e-6, 0.5, 0}}), std::invalid_argument);
  CHECK_THROWS_AS(FrictionMap({{0, 1, 0}, {1e-6, 0.5, 0}, {2e-6, 0.6, 0}}), std::invalid_argument);
}

TEST_CASE("averaging over a fingertip multiplies a sine by its sinc and leaves a straight line unchanged",
          "[physics]") {
  std::vector<double> x, line, wave;
  for (int i = 0; i <= 6000; ++i) {
    x.push_back(0.3 * i / 6000);
    line.push_back(2 + x.back());
    wave.push_back(std::sin(2 * M_PI * x.back() / 0.03));
  }
  const auto mean_line = fingertip_average(x, line, 0.01), mean_wave = fingertip_average(x, wave, 0.01);
  const double t = M_PI * 0.01 / 0.03;
  for (std::size_t i = 200; i < 5800; i += 397) {
    CHECK(mean_line[i] == Approx(line[i]).epsilon(1e-12));
    CHECK(mean_wave[i] == Approx(wave[i] * std::sin(t) / t).margin(1e-5));
  }
}

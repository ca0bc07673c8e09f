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

TEST_CASE("a finger that presses harder comes closer to the surface, and its skin stays the same",
          "[physics]") {
  // Relative friction at 1 um from a solution of the two equations by hand: at 5, 15 and 30 kPa the gap at
  // rest is u_s ln(P*/p) = 4.0, 1.80 and 0.416 um.
  const auto friction = [](double pressure_Pa, double displacement_m) {
    LoadSharing model;
    model.pressure_Pa = pressure_Pa;
    model.floor = 0;
    return FrictionMap(model).relative_friction(displacement_m);
  };
  const auto by_bisection = [](double pressure_Pa, double a) {
    const double contact_Pa = 36945.28049465325, length = 2e-6, ambient_Pa = 101325;
    double low = a, high = 1e-4;
    for (int i = 0; i < 200; ++i) {
      const double u = 0.5 * (low + high), e = a / u;
      const double carried =
          contact_Pa * std::exp(-u / length) + ambient_Pa * (std::sqrt((1 + 1.5 * e * e) / (1 - e * e)) - 1);
      (carried > pressure_Pa ? low : high) = u;
    }
    return contact_Pa * std::exp(-low / length) / pressure_Pa;
  };
  for (const double pressure_Pa : {5e3, 15e3, 30e3})
    for (const double a : {0.2e-6, 0.5e-6, 1e-6, 1.5e-6}) {
      CAPTURE(pressure_Pa, a);
      const double expected = by_bisection(pressure_Pa, a);
      if (expected > 0.03) CHECK(friction(pressure_Pa, a) == Approx(expected).epsilon(1e-9));
    }
  CHECK(friction(15e3, 1e-6) == Approx(0.38).margin(0.005));
  CHECK(friction(30e3, 1e-6) == Approx(0.335).margin(0.005));
  LoadSharing crushing;
  crushing.pressure_Pa = 4e4;
  CHECK_THROWS_AS(FrictionMap(crushing), std::invalid_argument);
}

TEST_CASE("the illustrative curve states a standard deviation: that of fingers whose lengths differ by 30 %",
          "[physics]") {
  const FrictionMap map;
  LoadSharing longer, shorter;
  longer.decay_length_m *= 1.01, shorter.decay_length_m *= 0.99;
  for (const double a : {0.3e-6, 0.7e-6, 1e-6, 2e-6}) {
    const double by_length =
        (FrictionMap(longer).relative_friction(a) - FrictionMap(shorter).relative_friction(a)) / 0.02;
    CHECK(map.sd(a) == Approx(0.3 * by_length).epsilon(1e-2));
    CHECK(map.sd(a) > 0);
  }
  CHECK(map.sd(0) == 0);
}

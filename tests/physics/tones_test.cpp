#include <algorithm>
#include <cmath>

#include "physics/centre_line.hpp"
#include "physics/crest.hpp"
#include "physics/field.hpp"
#include "physics/nnls.hpp"
#include "physics/zone.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;

TEST_CASE("the solution of non-negative least squares meets the optimality conditions", "[physics]") {
  // A matrix with correlated columns, the same in every run.
  const std::size_t rows = 60, columns = 12;
  std::vector<double> a, b;
  for (std::size_t j = 0; j < columns; ++j) {
    for (std::size_t i = 0; i < rows; ++i) a.push_back(std::exp(-std::pow((i - 5.0 * j) / 6.0, 2)) + 0.1);
  }
  for (std::size_t i = 0; i < rows; ++i) b.push_back(i < 30 ? 1.0 : -0.2);
  const NnlsResult fit = nnls(a, rows, b);
  std::vector<double> residual = b;
  for (std::size_t j = 0; j < columns; ++j) {
    for (std::size_t i = 0; i < rows; ++i) residual[i] -= fit.x[j] * a[j * rows + i];
  }
  int active = 0;
  for (std::size_t j = 0; j < columns; ++j) {
    double gradient = 0;
    for (std::size_t i = 0; i < rows; ++i) gradient += a[j * rows + i] * residual[i];
    CHECK(fit.x[j] >= 0);
    CHECK(gradient < 1e-9);
    if (fit.x[j] > 0) CHECK(std::abs(gradient) < 1e-9);
    active += fit.x[j] == 0 ? 1 : 0;
  }
  CHECK(active > 0);                          // the constraint holds some values at 0
  CHECK(active < static_cast<int>(columns));  // the constraint does not hold all values at 0
}

TEST_CASE("profiles that fall with x can be designed, and others are reported as not reachable",
          "[physics]") {
  Surface s = seed_brass();
  s.quality_factor = 60;
  const auto residual = [&](auto shape) {
    std::vector<ProfilePoint> target;
    for (int i = 0; i <= 540; ++i) {
      const double x = 0.27 * i / 540;
      target.push_back({x, 1e-6 * std::sqrt(shape(x))});
    }
    return design_profile(s, target, {8000, 45000, 250});
  };
  CHECK(residual([](double x) { return std::max(0.0, 1 - x / 0.25); }).residual < 0.012);
  const ProfileDesign step = residual([](double x) { return x < 0.2 ? 1.0 : 0.0; });
  CHECK(step.residual == Approx(0.10).margin(0.015));
  CHECK(step.reachable);
  CHECK(residual([](double x) { return x < 0.1 ? 1.0 : 0.0; }).residual == Approx(0.19).margin(0.015));
  const ProfileDesign band = residual([](double x) { return x > 0.1 && x < 0.15 ? 1.0 : 0.0; });
  CHECK(band.residual > 0.5);
  CHECK_FALSE(band.reachable);
}

TEST_CASE("a zone has the requested friction inside and ends at the requested boundary", "[physics]") {
  const Surface s = aluminium_plate();
  const FrictionMap friction;
  for (const char* edge : {"turning", "p50", "friction=0.8"}) {
    for (const double boundary : {0.14, 0.18}) {
      ZoneRequest request;
      request.from_m = 0.06;
      request.boundary_m = boundary;
      request.edge = parse_edge(edge);
      request.friction = 0.6;
      request.tones = 3;
      const ZoneDesign design = design_zone(s, friction, request);
      CAPTURE(edge, boundary, design.reason);
      CHECK(design.boundary_m == Approx(boundary).margin(2e-5));
      CHECK(design.friction == Approx(0.6).margin(1e-6));
      REQUIRE(design.tones.size() >= 2);
      for (std::size_t i = 0; i < design.tones.size(); ++i) {
        CHECK(design.tones[i].frequency_Hz >= request.band.low_Hz);
        CHECK(design.tones[i].frequency_Hz <= request.band.high_Hz);
        if (i > 0) CHECK(design.tones[i - 1].frequency_Hz - design.tones[i].frequency_Hz >= 999);
      }
      // Evaluates the tones on the surface with separate code, not the design's.
      const auto x = linspace_points(s, 1201);
      const Field field = evaluate(s, design.tones, x, Model::mode, Normalise::none);
      std::vector<double> mu;
      for (const double a : field.amplitude) mu.push_back(friction.relative_friction(a));
      const auto felt = fingertip_average(x, mu, request.fingertip_m);
      double mean = 0;
      int count = 0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        if (x[i] < request.from_m || x[i] > boundary) continue;
        mean += felt[i];
        ++count;
      }
      CHECK(mean / count == Approx(0.6).margin(2e-3));
      ZoneRequest single = request;
      single.tones = 1;
      // with several tones, the surface moves at a node of one tone because of the other tones
      CHECK(design.residual < 0.75 * design_zone(s, friction, single).residual);
    }
  }
}

TEST_CASE("a zone of another friction that shares its tones is the zone of a new design, bit by bit",
          "[physics]") {
  const Surface s = aluminium_plate();
  const FrictionMap friction;
  ZoneDesigner designer(s, friction);
  ZoneRequest request;
  request.from_m = 0.06;
  for (const char* edge : {"turning", "p50", "friction=0.9", "p50"}) {
    request.edge = parse_edge(edge);
    for (const double wanted : {0.6, 0.8, 0.05, 0.7}) {
      for (const double boundary : {0.15, 0.18}) {
        CAPTURE(edge, wanted, boundary);
        request.friction = wanted, request.boundary_m = boundary;
        if (wanted < friction.lowest_friction()) {
          CHECK_THROWS_AS(designer.design(request), Refused);
          continue;
        }
        const ZoneDesign shared = designer.design(request), alone = design_zone(s, friction, request);
        REQUIRE(shared.tones.size() == alone.tones.size());
        for (std::size_t i = 0; i < alone.tones.size(); ++i) {
          CHECK(shared.tones[i].frequency_Hz == alone.tones[i].frequency_Hz);
          CHECK(shared.tones[i].amplitude_m == alone.tones[i].amplitude_m);
          CHECK(shared.tones[i].phase_rad == alone.tones[i].phase_rad);
        }
        CHECK(shared.friction == alone.friction);
        CHECK(shared.boundary_m == alone.boundary_m);
        CHECK(shared.residual == alone.residual);
      }
    }
  }
}

TEST_CASE("impossible zones are refused, and the message says what is allowed", "[physics]") {
  const Surface s = aluminium_plate();
  ZoneRequest request;
  request.from_m = 0.06;
  request.boundary_m = 0.16;
  request.friction = 0.05;
  CHECK_THROWS_AS(design_zone(s, FrictionMap(), request), std::domain_error);
  request.friction = 0.6;
  request.boundary_m = 0.28;  // a boundary at 280 mm needs more than 45 kHz
  CHECK_THROWS_AS(design_zone(s, FrictionMap(), request), std::domain_error);
  request.boundary_m = 0.16;
  request.edge = Edge::friction(0.5);  // impossible, because the zone's friction is 0.6
  CHECK_THROWS_AS(design_zone(s, FrictionMap(), request), std::domain_error);
  request.edge = Edge::turning();
  request.from_m = 0.2;
  CHECK_THROWS_AS(design_zone(s, FrictionMap(), request), Refused);
}

TEST_CASE("Schroeder's phases lower the crest factor of a comb of tones, which is highest with equal phases",
          "[physics]") {
  for (const int n : {4, 8, 16, 32}) {
    std::vector<Tone> tones;
    for (int i = 0; i < n; ++i) tones.push_back({22400.0 + 700 * i, 1e-6, 0});
    CAPTURE(n);
    CHECK(crest_factor(tones) == Approx(std::sqrt(2.0 * n)).epsilon(0.01));
    assign_phases(tones);
    CHECK(crest_factor(tones) < 2.65);
    CHECK(crest_factor(tones) > 1.4);
  }
  const Tone one{30e3, 1e-6, 0.3};
  CHECK(crest_factor({&one, 1}) == Approx(std::sqrt(2.0)));
}

TEST_CASE("the audible products of two tones are their difference and the third-order products below 20 kHz",
          "[physics]") {
  const Tone tones[] = {{30e3, 1, 0}, {41e3, 1, 0}};
  const auto products = audible_products(tones);
  REQUIRE(products.size() == 2);
  CHECK(products[0].frequency_Hz == Approx(11e3));
  CHECK(products[0].order == 2);
  CHECK(products[1].frequency_Hz == Approx(19e3));
  CHECK(products[1].order == 3);
  const Tone close[] = {{30e3, 1, 0}, {31e3, 1, 0}};
  CHECK(audible_products(close).size() == 1);
}

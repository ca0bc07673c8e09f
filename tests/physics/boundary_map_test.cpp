#include "physics/boundary_map.hpp"

#include <cmath>
#include <vector>

#include "physics/centre_line.hpp"
#include "physics/edge_feature.hpp"
#include "physics/field.hpp"
#include "physics/statement.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;

namespace {

MapOptions edge(const char* text) {
  MapOptions options;
  options.edge = parse_edge(text);
  options.friction = FrictionContext{};
  return options;
}

std::vector<Surface> surfaces() {
  Surface exponential = seed_brass(), table = seed_brass(), cut = seed_brass();
  exponential.taper = ExponentialTaper{0.03, 0.1};
  table.taper = TabulatedTaper{{{0, .03}, {.1, .021}, {.2, .011}, {.3, .004}}};
  cut.length_m = 0.26;
  return {seed_brass(), exponential, table, cut, aluminium_plate()};
}

}  // namespace

TEST_CASE(
    "the map reproduces the turning points of the 1998 paper's example and the last maxima of the exact mode",
    "[physics]") {
  struct Row {
    double f, x0, exact;
  };
  const Row rows[] = {{8000, 51.701, 18.42},
                      {19600, 198.654, 185.07},
                      {20000, 200.680, 187.37},
                      {40000, 250.340, 243.68},
                      {45000, 255.858, 249.94}};
  const Surface s = seed_brass();
  for (const Row& row : rows) {
    CAPTURE(row.f);
    CHECK(BoundaryMap(s, edge("turning")).boundary_m(row.f).value() * 1e3 == Approx(row.x0).margin(6e-4));
    MapOptions options = edge("peak");
    CHECK(BoundaryMap(s, options).boundary_m(row.f).value() * 1e3 == Approx(row.exact).margin(6e-3));
  }
}

TEST_CASE("edges of the exact mode of a wedge lie at the published arguments of its Bessel function",
          "[physics]") {
  const Surface s = seed_brass();
  const double c = wave_speed_m_s(s);
  const double expected[] = {17.8133, 15.8455, 15.0088, 13.750, 12.495};
  const char* names[] = {"peak", "p70", "p50", "p25", "p10"};
  for (int i = 0; i < 5; ++i) {
    const double f = 30e3;
    const double x = BoundaryMap(s, edge(names[i])).boundary_m(f).value();
    CHECK(2 * M_PI * f / c * (0.3 - x) == Approx(expected[i]).margin(6e-4));
  }
}

TEST_CASE("converting a boundary to a frequency and back reproduces it to 1e-9 mm for every edge and taper",
          "[physics]") {
  for (const Surface& s : surfaces()) {
    for (const char* name : {"turning", "peak", "p70", "p50", "p25", "p10"}) {
      if (s.edges == Edges::clamped && std::string(name) != "p50")
        continue;  // for a clamped plate test only p50, because its tables take long to build
      const BoundaryMap map(s, edge(name));
      int found = 0;
      for (double x = 0.003; x < s.length_m; x += 0.0071) {
        const auto f = map.frequency_Hz(x);
        if (!f) continue;
        ++found;
        CAPTURE(name, x, *f);
        REQUIRE(std::abs(map.boundary_m(*f).value() - x) < 1e-12);
      }
      CHECK(found > 20);
    }
  }
}

TEST_CASE("the table of a map agrees with the profiles from which it was made", "[physics]") {
  Surface s = seed_brass();
  s.taper = ExponentialTaper{0.03, 0.1};
  const BoundaryMap map(s, edge("p25"));
  for (const double f : {9.1e3, 17.3e3, 29.9e3, 61e3}) {
    const auto line = make_centre_line(s, f, Model::mode);
    CHECK(std::abs(map.boundary_m(f).value() - line->level_m(0.25).value()) < 1e-9);
    // negative control: the boundary of another level would be detected
    CHECK(std::abs(map.boundary_m(f).value() - line->level_m(0.27).value()) > 1e-5);
  }
}

TEST_CASE("if there is no smooth zone or no last maximum, the map gives the reason", "[physics]") {
  const MapAnswer below = BoundaryMap(seed_brass(), edge("turning")).at_frequency(6000);
  CHECK_FALSE(below.boundary_m);
  CHECK(below.reason.find("no smooth zone") != std::string::npos);
  const MapAnswer early = BoundaryMap(seed_brass(), edge("peak")).at_frequency(6900);
  CHECK_FALSE(early.boundary_m);
  CHECK(early.reason.find("before the drive edge") != std::string::npos);
  CHECK_FALSE(BoundaryMap(seed_brass(), edge("peak")).frequency_Hz(0.31));
  CHECK_FALSE(BoundaryMap(seed_brass(), edge("peak")).at_boundary(-0.01).frequency_Hz);
}

TEST_CASE("a map follows the mode with loss, and states the model's error and the uncertainty separately",
          "[physics]") {
  Surface s = seed_brass();
  s.quality_factor = 30;
  s.sd.tension_Pa = 0.02 * s.tension_Pa;
  const MapAnswer answer = BoundaryMap(s, edge("p50")).at_frequency(20e3);
  const double lossy = make_centre_line(s, 20e3, Model::modes)->level_m(0.5).value();
  CHECK(std::abs(lossy - answer.boundary_m.value()) < answer.error_bound_m + 1e-8);
  // Negative control: the boundary of the same surface without loss lies far outside the stated bound.
  const double lossless = BoundaryMap(seed_brass(), edge("p50")).boundary_m(20e3).value();
  CHECK(std::abs(lossy - lossless) > 2 * answer.error_bound_m + 5e-5);
  // The distance from the apex is proportional to the wave speed: a change of 2 % in tension moves the
  // boundary by 1 % of that distance.
  CHECK(answer.uncertainty_m == Approx(0.01 * (0.3 - *answer.boundary_m)).epsilon(1e-3));
  s.sd = {};
  CHECK(BoundaryMap(s, edge("p50")).at_frequency(20e3).uncertainty_m == 0);
}

TEST_CASE("at the resonances of a lossless membrane, the exact mode is zero at the drive edge", "[physics]") {
  const auto all = resonances_Hz(seed_brass(), 7000, 45000);
  CHECK(all.size() == 26);
  CHECK(nearest_resonance_Hz(seed_brass(), 19600).value() == Approx(19560.4).margin(0.1));
  CHECK(nearest_resonance_Hz(seed_brass(), 40000).value() == Approx(40010.0).margin(0.1));
}

TEST_CASE("the turning points of a clamped aluminium plate follow from the clamped cut-off", "[physics]") {
  const BoundaryMap map(aluminium_plate(), edge("turning"));
  const double expected[][2] = {{22.4e3, 97.2}, {30e3, 147.4}, {40e3, 190.2}, {45e3, 206.0}};
  for (const auto& row : expected) CHECK(map.boundary_m(row[0]).value() * 1e3 == Approx(row[1]).margin(0.06));
}

TEST_CASE("on curved tapers and plates, the edge of the two-dimensional field lies inside the stated bound",
          "[physics]") {
  for (Surface s : surfaces()) {
    s.quality_factor = 60;
    const BoundaryMap map(s, edge("p50"));
    for (const double x : {0.09, 0.15, 0.19}) {
      const auto f = map.frequency_Hz(x);
      if (!f) continue;
      const MapAnswer answer = map.at_boundary(x);
      const auto truth = make_centre_line(s, *f, Model::modes)->level_m(0.5);
      REQUIRE(truth);
      CAPTURE(x, *f, *truth, answer.error_bound_m);
      // `truth` itself has an error of up to 1e-8 m
      CHECK(std::abs(*truth - x) <= answer.error_bound_m + 1e-8);
      CHECK(answer.error_bound_m < 3e-3);
    }
  }
}

TEST_CASE("solving for a single frequency gives the same result as the map", "[physics]") {
  for (const Surface& surface : {seed_brass(), aluminium_plate()}) {
    for (const char* edge : {"turning", "peak", "p50", "friction=0.8"}) {
      MapOptions options;
      options.edge = parse_edge(edge);
      options.friction = FrictionContext{FrictionMap{}, 1.3e-6, 10e-3};
      const BoundaryMap map(surface, options);
      for (const double x : {0.13, 0.16, 0.19}) {
        const auto f = solve_frequency_Hz(surface, options, x);
        CAPTURE(edge, x);
        REQUIRE(f);
        // The map's table is accurate to 2 um for an edge defined by friction, and to 0.3 um for a plate.
        CHECK(std::abs(map.boundary_m(*f).value() - x) < 3e-6);
      }
    }
  }
  MapOptions peak;
  peak.edge = Edge::peak();
  CHECK_FALSE(solve_frequency_Hz(seed_brass(), peak, 0.4));
}

TEST_CASE(
    "solving for a frequency with the model modes puts the edge of that field at the requested position",
    "[physics]") {
  Surface exponential = seed_brass();
  exponential.taper = ExponentialTaper{0.03, 0.1};
  exponential.quality_factor = 60;
  for (const Surface& surface : {aluminium_plate(), exponential}) {
    for (const char* name : {"turning", "peak", "p50", "p10", "friction=0.8"}) {
      MapOptions options = edge(name);
      const double by_mode = solve_frequency_Hz(surface, options, 0.15).value();
      options.model = Model::modes;
      const double f = solve_frequency_Hz(surface, options, 0.15).value();
      const auto line = make_centre_line(surface, f, Model::modes);
      CAPTURE(name, surface.taper.index(), by_mode, f);
      CHECK(std::abs(edge_position_m(surface, f, *line, options).value() - 0.15) < 1e-7);
      CHECK(solve_frequency_Hz(surface, options, 0.15, by_mode).value() == Approx(f).epsilon(1e-9));
      CHECK((f == by_mode) == (options.edge.kind == Edge::Kind::turning));
    }
  }
}

TEST_CASE("maps of long or finely tabulated tapers agree with those of the plain tapers", "[physics]") {
  // The equation is solved only where the surface moves. The solver must not spend steps on the far end, a
  // hundred decay lengths away, or on tabulated points beyond the moving part.
  Surface exponential = seed_brass();
  exponential.quality_factor = 60;
  exponential.taper = ExponentialTaper{0.03, 0.1};
  Surface endless = exponential;
  endless.length_m = 10;
  Surface table = seed_brass();
  table.quality_factor = 60;
  TabulatedTaper points;
  for (int i = 0; i <= 1000; ++i) points.points.push_back({3e-4 * i, 0.03 * std::exp(-3e-3 * i)});
  table.taper = points;
  const BoundaryMap plain(exponential, edge("p50")), long_map(endless, edge("p50")),
      table_map(table, edge("p50"));
  for (const double f : {15e3, 25e3, 40e3}) {
    CAPTURE(f);
    CHECK(std::abs(plain.boundary_m(f).value() - long_map.boundary_m(f).value()) < 1e-10);
    // The cubics of the tabulated taper differ slightly from the exponential.
    CHECK(std::abs(plain.boundary_m(f).value() - table_map.boundary_m(f).value()) < 1e-7);
    CHECK(long_map.at_frequency(f).error_bound_m ==
          Approx(plain.at_frequency(f).error_bound_m).epsilon(1e-3));
    const auto whole = make_centre_line(exponential, f, Model::mode);
    CHECK(std::abs(whole->level_m(0.5).value() - plain.boundary_m(f).value()) < 1e-10);
  }
  const auto steps = [&](double held_m, double f) {
    return TaylorMarch(Taper(endless), best_equation(endless, f, Losses::kept), held_m).steps();
  };
  CHECK(steps(moving_part(endless, 25e3).length_m, 25e3) < 40);
  CHECK(steps(0.6, 25e3) > 100);  // negative control: a solution from farther out takes many steps
}

TEST_CASE("a map of a frequency band agrees with the whole map in this band", "[physics]") {
  MapOptions options;
  options.edge = Edge::percent(0.5);
  const BoundaryMap whole(aluminium_plate(), options);
  options.band = {20e3, 50e3};
  const BoundaryMap band(aluminium_plate(), options);
  for (double f = 20.5e3; f < 50e3; f += 1234.5)
    CHECK(std::abs(band.boundary_m(f).value() - whole.boundary_m(f).value()) < 6e-7);
  CHECK(std::abs(band.boundary_m(band.frequency_Hz(0.15).value()).value() - 0.15) < 1e-12);
  CHECK_FALSE(band.boundary_m(60e3));
  CHECK_FALSE(band.frequency_Hz(0.28));
  options.band = {5e3, 6e3};
  CHECK_THROWS_AS(BoundaryMap(aluminium_plate(), options), std::domain_error);
}

TEST_CASE("the reach of an edge is that of the map, in a band too, and an answer needs no whole map",
          "[physics]") {
  for (const Surface& s : surfaces()) {
    for (const char* name : {"turning", "peak", "p50", "friction=0.7"}) {
      MapOptions options = edge(name);
      for (const bool band : {false, true}) {
        if (band) options.band = {15e3, 45e3};
        CAPTURE(s.taper.index(), s.length_m, s.thickness_m, name, band);
        const BoundaryMap map(s, options);
        const Reach reach = boundary_reach_m(s, options);
        double first = s.length_m, last = 0;
        for (double f = 1e3; f < 2e6; f *= 1.0005) {
          const auto x = map.boundary_m(f);
          if (!x || (band && (f < 15e3 || f > 45e3))) continue;
          first = std::min(first, *x), last = std::max(last, *x);
        }
        CHECK(reach.first_m == Approx(first).margin(1e-3));
        CHECK(reach.last_m == Approx(last).margin(2e-3));  // the frequencies end before the apex
      }
      options.band.reset();
      const BoundaryMap map(s, options);
      for (const double x : {0.02, 0.15, 0.25, 0.4}) {
        const MapAnswer one = answer_at_boundary(s, options, x), other = map.at_boundary(x);
        REQUIRE(one.frequency_Hz.has_value() == other.frequency_Hz.has_value());
        if (one.frequency_Hz) CHECK(*one.frequency_Hz == Approx(*other.frequency_Hz).epsilon(1e-4));
        if (!one.frequency_Hz) CHECK(one.reason.find("no frequency puts this edge at") == 0);
      }
    }
  }
  MapOptions below = edge("p50");
  below.band = {10, 20};
  CHECK_THROWS_AS(boundary_reach_m(seed_brass(), below), Refused);
}

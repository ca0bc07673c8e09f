// Rough sides of a table: how they are smoothed, and whether the bounds hold what is left out.
#include "physics/smooth_sides.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "physics/boundary_map.hpp"
#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/gate.hpp"
#include "physics/modal_field.hpp"
#include "physics/mode_bound.hpp"
#include "physics/taper.hpp"
#include "tests/physics/random_surfaces.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;
using turnpoint::physics_test::Draw;
using turnpoint::physics_test::noisy_points;
using turnpoint::physics_test::tabulated;
using turnpoint::physics_test::tapered_plate;

namespace {

using std::numbers::pi;

// The same sides, but with slopes, so that they are solved as they are, with an element for each piece.
Surface as_they_are(const Surface& surface) {
  Surface exact = surface;
  auto& table = std::get<TabulatedTaper>(exact.taper);
  const Taper taper(surface);
  for (const TaperPoint& point : table.points) table.slopes.push_back(taper.slope(point.x_m));
  return exact;
}

ModalResolution fine() {
  ModalResolution resolution;
  resolution.spare_functions = 9;
  return resolution;
}

struct Change {
  double drive = 0, level_dB = 0, edge_m = 0;
};

// How much smoothing changes the two-dimensional field.
Change change_by_smoothing(const Surface& s, double f) {
  const auto smooth = make_modal_line(s, f, Losses::kept, fine());
  const auto exact = make_modal_line(as_they_are(s), f, Losses::kept, fine());
  const double peak = *smooth->last_peak_m(), other = *exact->last_peak_m();
  Change change;
  double most = 0;
  for (int i = 0; i <= 400; ++i) {
    const double x = s.length_m * i / 400, v = std::exp(exact->value(x).ln_magnitude());
    change.drive = std::max(change.drive, std::abs(std::exp(smooth->value(x).ln_magnitude()) - v));
    most = std::max(most, v);
  }
  change.drive /= most;
  change.level_dB = 8.686 * std::abs(smooth->value(peak).ln_magnitude() - exact->value(other).ln_magnitude());
  for (const double level : {0.7, 0.5, 0.2})
    change.edge_m = std::max(change.edge_m, std::abs(*smooth->level_m(level) - *exact->level_m(level)));
  return change;
}

enum class Side { membrane, clamped, supported };

// How far a strip |y| < W + a cos(q x) is narrower than |y| < W, as the wave at its cut-off sees it. The
// field is a sum of functions that solve its equation exactly; their conditions on the side are met by least
// squares, and the residual tells whether they can be. `root` is the cut-off of the even strip.
double narrower(Side side, double w, double a, double q, double nu, double root, double at_most) {
  constexpr int waves = 8, points = 48;
  const auto residual = [&](double k) {
    const int kinds = side == Side::membrane ? 1 : 2;
    Eigen::MatrixXd m(kinds * points, kinds * waves);
    for (int n = 0; n < waves; ++n) {
      for (int kind = 0; kind < kinds; ++kind) {  // Y'' = p^2 Y - k^2 Y, or + k^2
        const double p = n * q, square = p * p + (kind == 0 ? -k * k : k * k);
        const double rate = std::sqrt(std::abs(square));
        for (int i = 0; i < points; ++i) {
          const double x = (i + 0.5) / points * pi / q, y = w + a * std::cos(q * x);
          const double slope = -a * q * std::sin(q * x), nx = -slope / std::hypot(1, slope),
                       ny = 1 / std::hypot(1, slope);
          const double even = square < 0 ? std::cos(rate * y) : std::cosh(rate * y) / std::cosh(rate * w);
          const double odd =
              square < 0 ? -rate * std::sin(rate * y) : rate * std::sinh(rate * y) / std::cosh(rate * w);
          const double c = std::cos(p * x), d = -p * std::sin(p * x);
          m(i, kinds * n + kind) = even * c;
          if (kinds == 1) continue;
          const double xx = -p * p * even * c, yy = square * even * c, xy = odd * d;
          m(points + i, kinds * n + kind) =
              side == Side::clamped
                  ? (nx * even * d + ny * odd * c) / q
                  : (nu * (xx + yy) + (1 - nu) * (nx * nx * xx + 2 * nx * ny * xy + ny * ny * yy)) / (q * q);
        }
      }
    }
    const Eigen::VectorXd first = m.col(0);  // cos k y, which is 1 on the centre line
    Eigen::MatrixXd others = m.rightCols(m.cols() - 1);
    others.colwise().normalize();
    return (others * others.colPivHouseholderQr().solve(first) - first).norm();
  };
  // The residual falls linearly to 0 on either side of the solution.
  double best = 0, at = HUGE_VAL;
  double low = 0, high = at_most;
  for (int round = 0; round < 3; ++round) {
    const double from = low, step = (high - low) / 40;
    for (int i = 0; i <= 40; ++i) {
      const double by = from + i * step, size = residual(root / (w - by));
      if (size < at) at = size, best = by;
    }
    low = std::max(0.0, best - step), high = best + step;
  }
  return best;
}

}  // namespace

TEST_CASE("sides with a fine corrugation act like a strip that is narrower, but less than the bound",
          "[physics]") {
  for (const Side side : {Side::membrane, Side::clamped, Side::supported}) {
    Surface s = side == Side::membrane ? seed_brass() : aluminium_plate();
    s.edges = side == Side::supported ? Edges::supported : Edges::clamped;
    s.length_m = 0.1;
    const double w = 0.01, q = 20 / w;
    for (const double steepness : {0.04, 0.1}) {
      const double a = steepness / q;
      std::vector<TaperPoint> points;
      for (int i = 0; i <= 764; ++i) points.push_back({0.1 * i / 764, w + a * std::cos(q * 0.1 * i / 764)});
      s.taper = TabulatedTaper{points};
      Surface straight = s;
      straight.taper = LinearTaper{w, 0};
      const double f = cut_off_frequency_Hz(straight, w), root = wavenumber_per_m(straight, f) * w;
      const Surface smooth = smooth_sides(s), narrow = narrowed_sides(s, smooth, f);
      const double found = half_width_m(smooth, 0.05) - half_width_m(narrow, 0.05);
      const double exact = narrower(side, w, a, q, s.poisson, root, 3 * found);
      CAPTURE(static_cast<int>(side), steepness, found, exact, half_width_m(smooth, 0.05) - w);
      CHECK(std::abs(half_width_m(smooth, 0.05) - w) < 0.05 * a);
      CHECK(found >= 1.9 * exact);  // the margin is 2
      CHECK(found <= 2.6 * exact);
    }
  }
}

TEST_CASE("what smoothing changes is inside its bounds, which are not much larger", "[physics]") {
  struct Case {
    const char* name;
    bool thin, thick;
    double error;
    int points;
    bool even;
    double quality, wide;
  };
  const Case cases[]{{"plate", true, false, 3e-3, 400, true, 30, 1},
                     {"plate, uneven, little loss", true, false, 3e-3, 300, false, 300, 1},
                     {"thick plate", false, true, 3e-3, 400, true, 60, 1},
                     {"membrane", false, false, 3e-3, 300, false, 60, 1},
                     {"membrane, second mode near resonance", false, false, 3e-3, 800, true, 3000, 2.4}};
  for (const Case& one : cases) {
    Surface like = one.thin || one.thick
                       ? tapered_plate(one.thick ? PlateTheory::mindlin : PlateTheory::kirchhoff)
                       : seed_brass();
    like.length_m = 0.44;
    like.quality_factor = one.quality;
    if (one.wide > 1) like.drive = DriveShape::piston;
    const Surface s = tabulated(like, noisy_points(one.points, one.error, one.even, one.wide));
    const double f = one.thin || one.thick ? 40e3 : one.wide > 1 ? 20e3 : 30e3;
    const Change change = change_by_smoothing(s, f);
    const SideError bound = side_error(s, f);
    const double conditioning =
        make_centre_line(s, f, Model::mode)->drive_conditioning(wavenumber_per_m(s, f));
    CAPTURE(one.name, change.drive, bound.drive(conditioning), change.level_dB, bound.level_dB(conditioning),
            change.edge_m, bound.position_m, conditioning);
    CHECK(change.drive <= bound.drive(conditioning));
    CHECK(change.level_dB <= bound.level_dB(conditioning));
    CHECK(change.edge_m <= bound.position_m + 1e-9);
    const double part =
        std::max({change.drive / bound.drive(conditioning), change.level_dB / bound.level_dB(conditioning),
                  change.edge_m / bound.position_m});
    CAPTURE(part);
    CHECK(part >= 0.05);
  }
}

TEST_CASE("smoothed sides fall, stay close to the table and are smoothed only once", "[physics]") {
  for (const int count : {100, 400, 2000}) {
    for (const bool even : {true, false}) {
      const Surface s = tabulated(tapered_plate(PlateTheory::kirchhoff), noisy_points(count, 3e-3, even, 1));
      const Surface smooth = smooth_sides(s);
      CHECK_NOTHROW(validate(smooth));
      const Taper rough(s), fine(smooth), twice(smooth_sides(smooth));
      double off = 0;
      for (int i = 0; i <= 2000; ++i) {
        const double x = 0.44 * i / 2000;
        off = std::max(off, std::abs(fine.half_width_m(x) / rough.half_width_m(x) - 1));
        CHECK(fine.slope(x) <= 1e-12);
        CHECK(twice.half_width_m(x) == fine.half_width_m(x));
      }
      CAPTURE(count, even, off);
      CHECK(off < 0.015);
      if (count == 2000) CHECK(std::get<TabulatedTaper>(smooth.taper).points.size() < 250);
    }
  }
  // few points are left as they are
  const Surface few = tabulated(tapered_plate(PlateTheory::kirchhoff), noisy_points(60, 3e-3, true, 1));
  CHECK(std::get<TabulatedTaper>(smooth_sides(few).taper).slopes.empty());
}

TEST_CASE("smoothed sides that end steeply are nowhere narrower than the table's end", "[physics]") {
  constexpr double w = 0.01;
  std::vector<TaperPoint> stepped{{0, w}}, curved = stepped;  // and 60 points in 0.6 half-widths
  for (int i = 1; i <= 60; ++i) {
    const double u = 0.01 * i;
    stepped.push_back({u * w, w * (u < 0.1 ? 1 - 9 * u : 0.101 - 0.01 * u)});
    curved.push_back({u * w, w * std::exp(-u / 0.1)});
  }
  for (const auto& points : {stepped, curved}) {
    Surface s = tabulated(seed_brass(), points);
    s.length_m = points.back().x_m;
    validate(s);
    const Surface smooth = smooth_sides(s);
    CAPTURE(half_width_m(smooth, s.length_m) / w, points.back().half_width_m / w);
    REQUIRE(!std::get<TabulatedTaper>(smooth.taper).slopes.empty());
    CHECK(half_width_m(smooth, s.length_m) >= points.back().half_width_m * (1 - 1e-9));
    CHECK(half_width_m(narrowed_sides(s, smooth, 20e3), s.length_m) > 0);
  }
}

// Rounding would destroy the stiffness of an element as short as this: 28 % of the impedance.
TEST_CASE("two points as close together as is allowed do not spoil the solution", "[physics]") {
  auto points = noisy_points(50, 0, true, 1);
  const Surface clean = tabulated(tapered_plate(PlateTheory::kirchhoff), points);
  const double step = 1.0001 * least_taper_step * 0.44;
  points.insert(points.begin() + 11, {points[10].x_m + step, points[10].half_width_m - 0.03 * step});
  const Surface s = tabulated(tapered_plate(PlateTheory::kirchhoff), points);
  for (const Model model : {Model::mode, Model::modes}) {
    const auto with = make_centre_line(s, 40e3, model), without = make_centre_line(clean, 40e3, model);
    for (const double x : {0.05, 0.1, 0.15, 0.2})
      CHECK(std::abs(with->value(x).ln_magnitude() - without->value(x).ln_magnitude()) < 1e-5);
  }
}

TEST_CASE("a map of rough sides has edges and frequencies that agree", "[physics][map]") {
  for (const int count : {150, 400}) {
    for (const bool plate : {true, false}) {
      Surface like = plate ? tapered_plate(PlateTheory::kirchhoff) : seed_brass();
      like.length_m = 0.44;
      like.quality_factor = 60;
      const Surface s = tabulated(like, noisy_points(count, 3e-3, false, 1));
      MapOptions options;
      options.edge = Edge::percent(0.5);
      options.band = MapOptions::Band{plate ? 20e3 : 12e3, plate ? 45e3 : 30e3};
      const BoundaryMap map(s, options);
      for (double x = 0.13; x < 0.22; x += 0.0173) {
        const auto f = map.frequency_Hz(x);
        const auto solved = solve_frequency_Hz(s, options, x);
        CAPTURE(count, plate, x);
        REQUIRE(f.has_value());
        REQUIRE(solved.has_value());
        CHECK(std::abs(*map.boundary_m(*f) - x) < 1e-9);
        const auto line = make_centre_line(s, *solved, Model::mode);
        if (plate) CHECK(std::abs(*line->level_m(0.5) - x) < 1e-6);
        const MapAnswer answer = map.at_frequency(*solved);
        CHECK(std::abs(*answer.boundary_m - x) <= answer.error_bound_m);
        CHECK(std::abs(*answer.boundary_m - x) < 5e-5);
      }
    }
  }
}

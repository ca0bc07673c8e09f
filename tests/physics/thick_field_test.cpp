#include <array>
#include <cmath>
#include <limits>

#include "physics/boundary_map.hpp"
#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/field.hpp"
#include "physics/planner.hpp"
#include "physics/surface.hpp"
#include "tests/physics/csv_table.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;
using turnpoint::physics_test::oracle;

namespace {

Surface plate_of(PlateTheory theory, double quality_factor) {
  Surface s = aluminium_plate();
  s.theory = theory;
  s.quality_factor = quality_factor > 0 ? quality_factor / 2 : std::numeric_limits<double>::infinity();
  return s;
}

// Returns the largest difference between |v| on `line` and the profile in `row`, at 0, 10, ... mm. Both are
// divided by their last maximum.
double profile_miss(const CentreLine& line, const std::vector<std::string>& row) {
  const double ln_peak = line.value(line.last_peak_m().value()).ln_magnitude();
  double worst = 0, largest = 1;
  for (std::size_t i = 5; i < row.size(); ++i) {
    const double theirs = std::stod(row[i]);
    const double ours = std::exp(line.value(0.01 * static_cast<double>(i - 5)).ln_magnitude() - ln_peak);
    worst = std::max(worst, std::abs(ours - theirs));
    largest = std::max(largest, theirs);
  }
  return worst / largest;
}

}  // namespace

TEST_CASE("the models mode and modes of a Mindlin taper match two-dimensional finite elements", "[physics]") {
  int compared = 0;
  double thin = 0;
  for (const auto& row : oracle("mindlin_taper.csv")) {
    const double f = std::stod(row[0]), q = std::stod(row[1]);
    const Surface s = plate_of(PlateTheory::mindlin, q);
    for (const Model model : {Model::mode, Model::modes}) {
      const auto line = make_centre_line(s, f, model);
      const double within = model == Model::mode ? 0.005e-3 : 0.001e-3;
      CAPTURE(f, q, name(model));
      CHECK(std::abs(line->last_peak_m().value() - std::stod(row[2])) < within);
      CHECK(std::abs(line->level_m(0.5).value() - std::stod(row[3])) < within);
      CHECK(std::abs(line->level_m(0.1).value() - std::stod(row[4])) < within);
      CHECK(profile_miss(*line, row) < (model == Model::mode ? 0.01 : 5e-4));
    }
    const auto kirchhoff = make_centre_line(plate_of(PlateTheory::kirchhoff, q), f, Model::mode);
    thin = std::max(thin, std::abs(kirchhoff->level_m(0.5).value() - std::stod(row[3])));
    ++compared;
  }
  CHECK(compared == 6);
  CHECK(thin > 0.01);  // negative control: the thin plate's boundary is more than 10 mm away
}

TEST_CASE("the elastic plate stops moving where three-dimensional finite elements of the whole plate do",
          "[physics]") {
  Surface s = plate_of(PlateTheory::elastic, 60);
  s.thickness_m = 3e-3;
  s.taper = LinearTaper{15.1e-3, 0.03};
  int compared = 0;
  for (const auto& row : oracle("elastic_taper.csv")) {
    const double f = std::stod(row[0]);
    const auto edges = [&](PlateTheory theory) {
      s.theory = theory;
      const auto line = make_centre_line(s, f, Model::mode);
      return std::array{line->last_peak_m().value(), line->level_m(0.5).value(), line->level_m(0.1).value()};
    };
    const auto elastic = edges(PlateTheory::elastic), mindlin = edges(PlateTheory::mindlin),
               kirchhoff = edges(PlateTheory::kirchhoff);
    s.theory = PlateTheory::elastic;
    PlanRequest request{{Tone{f, 1, 0}}, 10, Edge::percent(0.5), Normalise::drive, {}};
    const double bound_m = estimate(s, request, Model::mode).boundary_bound_m;
    for (std::size_t i = 0; i < elastic.size(); ++i) {
      const double fine = std::stod(row[1 + i]), coarse = std::stod(row[4 + i]);
      // the error of the fine mesh is about half of the change from the coarse to the fine mesh, so
      // extrapolate
      const double limit = fine + 0.5 * (fine - coarse);
      CAPTURE(f, i, 1e3 * (elastic[i] - fine), 1e3 * (elastic[i] - limit));
      CHECK(std::abs(fine - coarse) < 0.1e-3);
      CHECK(std::abs(elastic[i] - limit) < 0.06e-3);
      CHECK(std::abs(elastic[i] - limit) < bound_m);
      CHECK(std::abs(mindlin[i] - limit) < 0.5e-3);
      CHECK(std::abs(kirchhoff[i] - limit) > 15e-3);  // negative control: Kirchhoff's theory is far off
    }
    ++compared;
  }
  CHECK(compared == 3);
}

TEST_CASE("for a thin plate, the fields of the thick-plate theories become Kirchhoff's", "[physics]") {
  for (const auto theory : {PlateTheory::mindlin, PlateTheory::elastic}) {
    // In a plate of 0.1 mm, shear moves the cut-off by only 0.03 mm. If the section were too stiff in
    // bending, the boundaries would move by several mm.
    Surface s = plate_of(PlateTheory::kirchhoff, 60);
    s.thickness_m = 1e-4;
    const double f = 2e3;
    const auto thin = make_centre_line(s, f, Model::mode);
    s.theory = theory;
    const auto thick = make_centre_line(s, f, Model::mode);
    CAPTURE(name(theory));
    CHECK(std::abs(*thick->last_peak_m() - *thin->last_peak_m()) < 0.05e-3);
    CHECK(std::abs(*thick->level_m(0.5) - *thin->level_m(0.5)) < 0.05e-3);
    CHECK(std::abs(*thick->level_m(0.1) - *thin->level_m(0.1)) < 0.06e-3);
  }
}

TEST_CASE("the field of a thick plate continues beyond its last element without NaN", "[physics]") {
  Surface s = plate_of(PlateTheory::mindlin, 60);
  s.taper = LinearTaper{0.03, 0.1};  // the surface runs to its apex
  const auto line = make_centre_line(s, 30e3, Model::mode);
  double last = line->value(0.24).ln_magnitude();
  for (const double x : {0.26, 0.28, 0.29, 0.299}) {
    const double ln = line->value(x).ln_magnitude();
    CHECK(std::isfinite(ln));
    CHECK(ln < last);
    last = ln;
  }
}

TEST_CASE("the map of a thick plate agrees with its field, from frequency to position and back",
          "[physics]") {
  for (const auto theory : {PlateTheory::mindlin, PlateTheory::elastic}) {
    const Surface s = plate_of(theory, 60);
    CAPTURE(name(theory));
    MapOptions options;
    const BoundaryMap turning(s, options);
    CHECK(turning.boundary_m(45e3).value() == Approx(turning_point_m(s, 45e3).value()).margin(1e-9));
    CHECK(turning.frequency_Hz(0.2).value() ==
          Approx(cut_off_frequency_Hz(s, half_width_m(s, 0.2))).epsilon(1e-9));
    options.edge = Edge::percent(0.5);
    options.band = {{25e3, 45e3}};
    const BoundaryMap map(s, options);
    for (const double f : {26e3, 33e3, 44e3}) {
      const double field = make_centre_line(s, f, Model::mode)->level_m(0.5).value();
      const MapAnswer answer = map.at_frequency(f);
      CHECK(std::abs(answer.boundary_m.value() - field) < 3e-6);
      CHECK(map.frequency_Hz(field).value() == Approx(f).margin(1));
      CHECK(answer.shear_shift_m.has_value());
    }
    const auto solved = solve_frequency_Hz(s, options, 0.15);
    REQUIRE(solved);
    CHECK(std::abs(make_centre_line(s, *solved, Model::mode)->level_m(0.5).value() - 0.15) < 1e-6);
  }
}

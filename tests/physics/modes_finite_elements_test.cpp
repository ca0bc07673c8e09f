// Checks the error bounds of the model `modes` on 200 random surfaces against finite elements
// (oracles/make_modes.py).
#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/centre_line.hpp"
#include "physics/planner.hpp"
#include "tests/physics/csv_table.hpp"
#include "tests/physics/random_scenes.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;
using turnpoint::physics_test::median;
using turnpoint::physics_test::oracle;

namespace {

constexpr int points = 20;
// accuracy (m) with which the position of the boundary is read from the finite elements
constexpr double reading_m = 1e-8;

struct Scene {
  Surface surface;
  double frequency_Hz = 0;
  std::vector<double> v;  // |v| at x = 0.025 L, 0.075 L, ..., with |v| = 1 at the drive edge
  double most = 0, peak = 0, edge_m = 0;
  // by how much a coarser mesh changes |v| (relative to `most`), the peak (relative to itself) and the
  // position of the boundary
  double v_off = 0, peak_off = 0, edge_off_m = 0;
};

Surface material(bool plate) {
  Surface s = plate ? aluminium_plate() : seed_brass();
  if (plate) {
    s.density_kg_m3 = 2700;
    s.modulus_Pa = 69e9;
    s.poisson = 0.33;
    return s;
  }
  s.density_kg_m3 = 1000;  // waves travel at exactly 800 m/s
  s.tension_Pa = 640e6;
  s.bending = Bending::off;
  return s;
}

TaperForm taper_of(const std::string& kind, const std::vector<double>& numbers) {
  if (kind == "linear") return LinearTaper{numbers[0], numbers[1]};
  if (kind == "exponential") return ExponentialTaper{numbers[0], numbers[1]};
  TabulatedTaper table;
  for (std::size_t i = 0; i < numbers.size(); i += 2) table.points.push_back({numbers[i], numbers[i + 1]});
  return table;
}

Scene scene_of(const std::vector<std::string>& row) {
  Scene scene;
  scene.surface = material(row[0] == "clamped");
  scene.surface.drive = row[1] == "piston" ? DriveShape::piston : DriveShape::cosine;
  std::vector<double> n;
  for (std::size_t i = 3; i < row.size(); ++i) n.push_back(std::stod(row[i]));
  auto next = n.begin();
  scene.frequency_Hz = *next++;
  const double q = *next++;
  scene.surface.length_m = *next++;
  const auto count = static_cast<std::ptrdiff_t>(*next++);
  scene.surface.taper = taper_of(row[2], {next, next + count});
  turnpoint::physics_test::set_wave_loss(scene.surface, scene.frequency_Hz, q);
  next += count;
  scene.v.assign(next, next + points);
  next += points;
  for (double* one :
       {&scene.most, &scene.peak, &scene.edge_m, &scene.v_off, &scene.peak_off, &scene.edge_off_m})
    *one = *next++;
  return scene;
}

double ln_at(const CentreLine& line, double x) { return line.value(x).ln_magnitude(); }

// Returns the largest difference between |v| of `line` and of the finite elements, relative to the largest
// |v|.
double amplitude_error(const Scene& scene, const CentreLine& line, Normalise normalise) {
  const bool drive = normalise == Normalise::drive;
  const double unit = ln_at(line, drive ? 0 : line.last_peak_m().value()), true_unit = drive ? 1 : scene.peak;
  double worst = 0;
  for (int i = 0; i < points; ++i) {
    const double x = scene.surface.length_m * (0.025 + 0.05 * i);
    worst = std::max(
        worst, std::abs(std::exp(ln_at(line, x) - unit) - scene.v[static_cast<std::size_t>(i)] / true_unit));
  }
  return worst * true_unit / scene.most;
}

}  // namespace

TEST_CASE("the error of the model modes lies inside its bound on 200 surfaces solved by finite elements",
          "[physics][oracle]") {
  std::vector<double> off;
  int compared = 0;
  for (const auto& row : oracle("modes.csv")) {
    const Scene scene = scene_of(row);
    const auto line = make_centre_line(scene.surface, scene.frequency_Hz, Model::modes);
    REQUIRE(line->last_peak_m().has_value());
    CAPTURE(compared, row[0], row[1], row[2], row[4], row[5]);
    ++compared;
    if (row[0] == "membrane") off.push_back(scene.v_off);
    for (const Normalise normalise : {Normalise::peak, Normalise::drive}) {
      PlanRequest request;
      request.tones = {Tone{scene.frequency_Hz, 1, 0}};
      request.points = points;
      request.edge = Edge::percent(0.5);
      request.normalise = normalise;
      const RungEstimate bound = estimate(scene.surface, request, Model::modes);
      const double drive_off = scene.v_off + (normalise == Normalise::peak ? scene.peak_off : 0);
      CHECK(amplitude_error(scene, *line, normalise) <= bound.amplitude_bound + drive_off);
      const double level = ln_at(*line, *line->last_peak_m()) - ln_at(*line, 0) - std::log(scene.peak);
      CHECK(8.686 * std::abs(level) <= bound.level_bound_dB + 8.686 * scene.peak_off);
      const auto edge = line->level_m(0.5);
      REQUIRE(edge.has_value());
      CHECK(std::abs(*edge - scene.edge_m) <= bound.boundary_bound_m + scene.edge_off_m + reading_m);
    }
  }
  CHECK(compared == 200);
  CHECK(median(off) < 1e-5);  // the finite elements' own error, estimated with a coarser mesh
}

// The simulated rig and the rigs of the boards have the same plate. These tests check what its dimensions
// must achieve.
#include <cmath>

#include "physics/boundary_budget.hpp"
#include "physics/boundary_map.hpp"
#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "station/scene/planner.hpp"
#include "station/scene/under_finger.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::scene;

namespace {

rig::Rig shipped(const std::string& name) {
  return rig::load(std::string(TURNPOINT_SOURCE_DIR) + "/deploy/rigs/" + name + ".toml");
}

constexpr double kLowest_m = 0.100, kHighest_m = 0.205, kLowest_Hz = 22.4e3, kHighest_Hz = 48e3;

/// Position of the boundary p50 (at 50 % of the amplitude) according to three-dimensional elasticity of the
/// cross-section, and its standard deviation.
struct Edge {
  double at_m, sd_m;
};
Edge edge_at(const rig::Rig& rig, double frequency_Hz) {
  auto surface = surface_of(rig);
  surface.theory = physics::PlateTheory::elastic;
  const double at_m =
      physics::make_centre_line(surface, frequency_Hz, physics::Model::mode)->level_m(0.5).value();
  return {at_m, physics::boundary_budget(surface, frequency_Hz, at_m).total_m};
}

/// True if boundaries from 100 to 205 mm can be reached within the band, even if the plate deviates by two
/// standard deviations.
bool reachable(const rig::Rig& rig) {
  const auto low = edge_at(rig, kLowest_Hz), high = edge_at(rig, kHighest_Hz);
  return low.at_m + 2 * low.sd_m < kLowest_m && high.at_m - 2 * high.sd_m > kHighest_m;
}

Scene tone_at(double boundary_m) {
  Scene scene;
  scene.boundary_m = boundary_m;
  scene.edge = physics::Edge::percent(0.5);
  scene.displacement_m = 1e-6;
  scene.tolerance = {0.5e-3, 0.3, {}};
  return scene;
}

/// Returns the smallest fraction of the displacement at the last maximum that remains under the rig's finger.
double least_share(const rig::Rig& rig) {
  Planner planner(rig);
  double least = 1;
  for (const double boundary_m : {0.100, 0.110, 0.120, 0.135, 0.150, 0.175, 0.205}) {
    const auto under = planner.under_finger(planner.plan(tone_at(boundary_m)));
    least = std::min(least, under.displacement_m / under.free_m);
  }
  return least;
}

}  // namespace

TEST_CASE("boundaries from 100 to 205 mm are inside the band, whatever the plate's uncertainty", "[scene]") {
  for (const char* name : {"simulated", "raspberry-pi-aluminium", "pc-usb"}) {
    auto rig = shipped(name);
    CAPTURE(name);
    CHECK(rig.surface.plate_theory == rig::PlateTheory::automatic);
    CHECK(surface_of(rig).theory == physics::PlateTheory::mindlin);
    CHECK(reachable(rig));
    CHECK(rig.transducers[0].low_Hz <= kLowest_Hz);
    CHECK(rig.transducers[0].high_Hz >= kHighest_Hz);
    // Plans use a theory whose boundary is within 0.5 mm of that of the elastic cross-section.
    const auto surface = surface_of(rig);
    for (const double f : {kLowest_Hz, 30e3, kHighest_Hz}) {
      const double at_m = physics::make_centre_line(surface, f, physics::Model::mode)->level_m(0.5).value();
      CHECK(std::abs(at_m - edge_at(rig, f).at_m) < 0.5e-3);
    }
    // Where the motion ends, the strip is always wider than a finger (14 mm).
    CHECK(2 * physics::cut_off_half_width_m(surface, kHighest_Hz) > 14e-3);
  }
  // Negative control: the plate's earlier dimensions, which came from the theory of thin plates.
  auto thin = shipped("simulated");
  thin.surface.thickness_m = 2e-3, thin.surface.thickness_sd_m = 0.045e-3;
  thin.surface.taper.half_width_m = 14e-3;
  CHECK_FALSE(reachable(thin));
}

TEST_CASE("a finger leaves a quarter of the displacement or more, and 2 um are possible under it",
          "[scene]") {
  const auto rig = shipped("simulated");
  CHECK(least_share(rig) > 0.25);
  Planner planner(rig);
  for (const double boundary_m : {0.100, 0.125, 0.150, 0.175, 0.205}) {
    auto scene = tone_at(boundary_m);
    const double peak_m = planner.plan(scene).tones.at(0).last_peak_m.value();
    scene.displacement_m.reset();
    scene.under_finger = FingerTarget{2e-6, peak_m};
    CAPTURE(boundary_m);
    const auto plan = planner.plan(scene);  // throws beyond the rig's displacement or full scale
    CHECK(plan.peak_full_scale < 1);
  }
  auto thin = rig;  // negative control: the earlier, thinner plate
  thin.surface.thickness_m = 2e-3;
  thin.surface.taper.half_width_m = 14e-3;
  CHECK(least_share(thin) < 0.2);
}

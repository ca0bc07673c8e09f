#include "station/scene/planner.hpp"

#include <cmath>

#include "physics/centre_line.hpp"
#include "physics/edge_feature.hpp"
#include "station/core/texts.hpp"
#include "station/scene/sound.hpp"
#include "station/scene/under_finger.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::scene;

namespace {

rig::Rig simulated() {
  return rig::load(std::string(TURNPOINT_SOURCE_DIR) + "/tests/support/thin_plate.toml");
}

/// The scene "edge" of protocols/demo.toml, with its boundary at `boundary_m` and without roving.
Scene edge_at(double boundary_m, const char* edge) {
  Scene scene;
  scene.name = "edge";
  scene.boundary_m = boundary_m;
  scene.edge = physics::parse_edge(edge);
  scene.displacement_m = 1e-6;
  scene.tolerance = {0.5e-3, 0.3, {}};
  return scene;
}

physics::MapOptions options_of(const Scene& scene, const rig::Rig& rig) {
  physics::MapOptions options;
  options.edge = scene.edge;
  options.friction =
      physics::FrictionContext{friction_of(rig), *scene.displacement_m, rig.friction.fingertip_m};
  return options;
}

/// Returns the position of the boundary in the two-dimensional field at this frequency.
double edge_of_field_m(const physics::Surface& surface, const physics::MapOptions& options, double f) {
  const auto line = physics::make_centre_line(surface, f, physics::Model::modes);
  return physics::edge_position_m(surface, f, *line, options).value();
}

}  // namespace

TEST_CASE("a planned tone has its edge at the scene's boundary, within the stated bound", "[scene]") {
  const auto rig = simulated();
  Planner planner(rig);
  for (const char* edge : {"p50", "p10", "peak", "friction=0.8"}) {
    for (const double boundary_m : {0.100, 0.125, 0.150, 0.175, 0.200}) {
      auto scene = edge_at(boundary_m, edge);
      scene.tolerance.boundary_m = 0.01e-3;  // less than `mode` can show
      const auto plan = planner.plan(scene);
      REQUIRE(plan.model == physics::Model::modes);
      const double at =
          edge_of_field_m(planner.surface(), options_of(scene, rig), plan.tones.at(0).frequency_Hz);
      CAPTURE(edge, boundary_m, 1e3 * (at - boundary_m), 1e3 * plan.error_bound_m);
      CHECK(std::abs(at - boundary_m) <= plan.error_bound_m);
      CHECK(plan.error_bound_m < 0.01e-3);
    }
  }
}

TEST_CASE("a plan states displacement, friction and boundary under a finger", "[scene]") {
  auto rig = simulated();
  Planner planner(rig);
  const auto plan = planner.plan(edge_at(0.150, "p50"));
  const auto under = planner.under_finger(plan);
  CHECK(under.finger_m == plan.tones[0].last_peak_m.value());
  const double share = under.displacement_m / under.free_m;
  CHECK(share == Approx(physics::finger_load(planner.surface(), plan.tones[0].frequency_Hz, {under.finger_m},
                                             physics::Finger{})[0]
                            .share(physics::Finger{})));
  CHECK(share < 0.5);
  CHECK(under.least_m < under.displacement_m);
  CHECK(under.displacement_m < under.most_m);
  CHECK(under.friction > under.free_friction + 0.2);
  CHECK(under.free_friction == Approx(plan.lowest_friction).epsilon(0.02));
  CHECK(std::abs(under.boundary_shift_m.value()) > 1e-3);
  const auto fingers = finger_shares(rig, {plan.tones[0].frequency_Hz});
  CHECK(fingers->least == Approx(share).epsilon(0.02));

  rig.finger.impedance_Ns_per_m = rig.finger.impedance_sd_Ns_per_m = 0;
  Planner light(rig);
  const auto same = light.under_finger(light.plan(edge_at(0.150, "p50")));
  CHECK(same.displacement_m == same.free_m);
  CHECK(same.lowest_friction == Approx(plan.lowest_friction).epsilon(0.02));
  CHECK(same.boundary_shift_m == 0);
}

TEST_CASE("a planner that has solved for a finger says the same of other levels as a new one", "[scene]") {
  const auto rig = simulated();
  Planner known(rig);
  auto scene = edge_at(0.150, "p50");
  for (const double displacement_m : {1e-6, 0.4e-6}) {
    for (const char* edge : {"p50", "peak"}) {
      scene.displacement_m = displacement_m;
      scene.edge = physics::parse_edge(edge);
      Planner fresh(rig);
      const auto one = known.under_finger(known.plan(scene)), other = fresh.under_finger(fresh.plan(scene));
      CHECK(one.displacement_m == other.displacement_m);
      CHECK(one.free_friction == other.free_friction);
      CHECK(one.profile_friction == other.profile_friction);
      CHECK(one.friction_low == other.friction_low);
      CHECK(one.boundary_shift_m == other.boundary_shift_m);
    }
  }
}

TEST_CASE("a displacement requested under a finger is reached there, and limits apply without the finger",
          "[scene]") {
  auto rig = simulated();
  Planner planner(rig);
  auto scene = edge_at(0.150, "p50");
  scene.displacement_m.reset();
  scene.under_finger = FingerTarget{0.3e-6, 0.130};
  const auto plan = planner.plan(scene);
  const auto under = planner.under_finger(plan);
  CHECK(under.finger_m == 0.130);
  CHECK(under.displacement_m == Approx(0.3e-6).epsilon(1e-6));
  CHECK(plan.tones[0].displacement_m > 0.8e-6);
  CHECK(plan.peak_displacement_m == Approx(plan.tones[0].displacement_m).epsilon(1e-3));
  // The frequency is that of the boundary alone, and roving changes the strength in proportion.
  CHECK(plan.tones[0].frequency_Hz == planner.plan(edge_at(0.150, "p50")).tones[0].frequency_Hz);
  scene.rove_dB = 6;
  CHECK(planner.plan(scene).tones[0].amplitude_m ==
        Approx(plan.tones[0].amplitude_m * std::pow(10, 0.3)).epsilon(1e-6));
  scene.rove_dB = 0;

  // This limit allows the 0.3 um wanted under the finger, but not the plan's peak displacement.
  rig.limits.displacement_m = 0.5 * plan.peak_displacement_m;
  CHECK(rig.limits.displacement_m > 0.3e-6);
  CHECK_THROWS_AS(Planner(rig).plan(scene), Unreachable);
  scene.under_finger->finger_m = 0.29;
  CHECK_THROWS_AS(planner.plan(scene), Unreachable);
  scene.under_finger->finger_m = 0.31;
  CHECK_THROWS_AS(planner.plan(scene), Unreachable);
}

TEST_CASE("under a finger a zone has less contrast to its surroundings", "[scene]") {
  Planner planner(simulated());
  auto scene = edge_at(0.185, "p50");
  scene.displacement_m.reset();
  scene.zone = ZoneTarget{0.1, 0.6, 3, {}};
  scene.tolerance = {};
  const auto plan = planner.plan(scene);
  const auto under = planner.under_finger(plan);
  CHECK(under.zone_friction.value() > plan.zone_friction.value() + 0.1);
  CHECK(under.zone_friction.value() < 1);
}

TEST_CASE("map, plan and field agree on a p50 edge within 0.01 mm", "[scene]") {
  const auto rig = simulated();
  Planner planner(rig);
  const physics::BoundaryMap map(planner.surface(), {physics::Edge::percent(0.5), {}, {}, {}});
  for (const double boundary_m : {0.100, 0.125, 0.150, 0.175, 0.200}) {
    const auto scene = edge_at(boundary_m, "p50");
    const double planned_Hz = planner.plan(scene).tones.at(0).frequency_Hz;
    const double of_field = edge_of_field_m(planner.surface(), options_of(scene, rig), planned_Hz);
    CAPTURE(boundary_m);
    CHECK(std::abs(map.boundary_m(planned_Hz).value() - of_field) < 0.01e-3);
    CHECK(std::abs(of_field - boundary_m) < 0.01e-3);
    CHECK(map.at_boundary(boundary_m).error_bound_m < 0.02e-3);
  }
}

TEST_CASE("a plan states how uncertain its boundary is, whatever its edge", "[scene]") {
  auto rig = simulated();
  Planner planner(rig);
  const physics::BoundaryMap map(planner.surface(), {physics::Edge::percent(0.5), {}, {}, {}});
  const double stated_m = map.at_boundary(0.150).uncertainty_m;
  CHECK(stated_m > 7e-3);
  auto zone = edge_at(0.150, "p50");
  zone.displacement_m.reset();
  zone.zone = ZoneTarget{0.030, 0.7, 3, {}};
  auto tones = edge_at(0.150, "p50");
  tones.boundary_m.reset();
  tones.tones = {{0.120, {}, tones.edge, 1e-6, 0}, {0.150, {}, tones.edge, 1e-6, 0}};
  for (const auto& scene : {edge_at(0.150, "p50"), edge_at(0.150, "friction=0.8"), zone, tones})
    CHECK(planner.plan(scene).uncertainty_m == Approx(stated_m).epsilon(0.02));
  rig.surface.clamp_line_sd_m = 0;
  CHECK(Planner(rig).plan(edge_at(0.150, "p50")).uncertainty_m < 0.6 * stated_m);
}

TEST_CASE("the error bound of a zone is that of the first mode, with which the zone is designed", "[scene]") {
  Planner planner(simulated());
  auto scene = edge_at(0.160, "p50");
  scene.displacement_m.reset();
  scene.zone = ZoneTarget{0.030, 0.7, 1, {}};
  const auto plan = planner.plan(scene);
  REQUIRE(plan.model == physics::Model::modes);
  const auto line =
      physics::make_centre_line(planner.surface(), plan.tones.at(0).frequency_Hz, physics::Model::modes);
  const double miss_m = std::abs(line->level_m(0.5).value() - 0.160);
  CAPTURE(1e3 * miss_m, 1e3 * plan.error_bound_m);
  CHECK(miss_m <= plan.error_bound_m);
  CHECK(miss_m > 1e-6);  // negative control: field and first mode do not agree exactly
}

TEST_CASE("roving changes the displacement of a planned tone by exactly the roved decibels", "[scene]") {
  Planner planner(simulated());
  auto scene = edge_at(0.150, "p50");
  scene.rove_dB = -2;
  const auto plan = planner.plan(scene);
  CHECK(plan.tones.at(0).displacement_m == Approx(1e-6 * std::pow(10, -0.1)).epsilon(1e-6));
}

TEST_CASE(
    "a scene of tones is described by the model that computes its field, with the error of its tones' edges",
    "[scene]") {
  const auto rig = simulated();
  Scene scene;
  scene.name = "two";
  for (const double boundary_m : {0.090, 0.150})
    scene.tones.push_back({boundary_m, {}, physics::Edge::peak(), 0.7e-6, 0});
  Planner planner(rig);
  const auto plan = planner.plan(scene);
  CHECK(plan.model == physics::Model::mode);
  CHECK(plan.reason.find("the scene has no tolerance") != std::string::npos);
  CHECK(plan.error_bound_m > 1e-6);
  // Each tone is placed as it would be alone, so the error is at least that of the scene with this boundary
  // alone.
  auto one = edge_at(0.150, "peak");
  one.tolerance = {};
  CHECK(plan.error_bound_m >= 0.999 * Planner(rig).plan(one).error_bound_m);
  const std::vector<physics::Tone> tones(plan.tones.begin(), plan.tones.end());
  const auto edge = sound_bound(rig, tones, physics::Model::edge),
             mode = sound_bound(rig, tones, physics::Model::mode);
  REQUIRE((edge && mode));
  CHECK(edge->level_dB == mode->level_dB);
}

TEST_CASE("what prevents a plan, and what a tolerance lacks, is said in the language of the screen",
          "[scene]") {
  const auto refused_in = [](Scene scene, const char* language) {
    try {
      Planner(simulated()).plan(scene);
    } catch (const Unreachable& refused) {
      return core::say(refused.why(), language);
    }
    return std::string();
  };
  CHECK(refused_in(edge_at(0.5, "peak"), "de").find("keine Frequenz legt den Rand") == 0);
  auto zone = edge_at(0.150, "turning");
  zone.displacement_m.reset();
  zone.zone = ZoneTarget{};
  zone.zone->from_m = 0.2;
  zone.zone->friction = 0.7;
  CHECK(refused_in(zone, "de").find("Bereich von 200 bis 150 mm; erlaubt: innerhalb von 0 bis 300 mm") == 0);
  // the reason is that of the first time, also in a copy of the planner
  Planner planner(simulated());
  CHECK_THROWS_AS(planner.plan(zone), Unreachable);
  for (Planner one : {planner, Planner(planner)}) {
    try {
      one.plan(zone);
    } catch (const Unreachable& refused) {
      CHECK(core::say(refused.why(), "de") == refused_in(zone, "de"));
    }
  }
  auto strict = edge_at(0.150, "p50");
  strict.tolerance = {1e-9, {}, {}};
  const auto plan = Planner(simulated()).plan(strict);
  REQUIRE_FALSE(plan.inside_tolerance);
  CHECK(core::say(plan.beyond_tolerance, "de")
            .find("der Fehler des Modells \u201emodes\u201c kann gr\u00f6\u00dfer sein") == 0);
  CHECK(core::say(plan.beyond_tolerance, "en").find("tolerance 1e-06 mm") != std::string::npos);
}

TEST_CASE(
    "if the rig leaves the plate theory open, the plan uses Kirchhoff's only if its error is within the "
    "tolerance",
    "[scene]") {
  auto rig = simulated();
  auto scene = edge_at(0.150, "p50");
  scene.tolerance = {20e-3, {}, {}};
  rig.surface.plate_theory = rig::PlateTheory::kirchhoff;
  Planner thin(rig);
  const auto by_kirchhoff = thin.plan(scene);
  CHECK(by_kirchhoff.theory == physics::PlateTheory::kirchhoff);
  CHECK(by_kirchhoff.shear_shift_m.value() == Approx(12.2e-3).margin(0.2e-3));

  rig.surface.plate_theory = rig::PlateTheory::automatic;
  Planner planner(rig);
  const auto coarse = planner.plan(scene);
  CHECK(coarse.theory == physics::PlateTheory::kirchhoff);
  CHECK(coarse.tones.at(0).frequency_Hz == by_kirchhoff.tones.at(0).frequency_Hz);
  scene.tolerance.boundary_m = 1e-3;
  const auto fine = planner.plan(scene);
  CHECK(fine.theory == physics::PlateTheory::mindlin);
  CHECK(fine.inside_tolerance);
  CHECK(std::abs(fine.shear_shift_m.value()) < 0.5e-3);
  CHECK(fine.reason.find("shear moves the thin plate's boundary by") != std::string::npos);
  // With shear, the boundary at a given frequency lies farther out, so the same boundary needs a lower
  // frequency.
  CHECK(fine.tones.at(0).frequency_Hz < 0.95 * coarse.tones.at(0).frequency_Hz);
  auto mindlin = planner.surface();
  mindlin.theory = physics::PlateTheory::mindlin;
  const auto line = physics::make_centre_line(mindlin, fine.tones.at(0).frequency_Hz, physics::Model::mode);
  CHECK(std::abs(line->level_m(0.5).value() - 0.150) < 0.03e-3);
  CHECK(planner.profile(fine, 50).displacement_m.size() == 50);
}

TEST_CASE("the tones of a plan have the uncertainty of their level, if the rig states standard deviations",
          "[scene]") {
  auto rig = simulated();
  Planner planner(rig);
  auto plan = planner.plan(edge_at(0.15, "p50"));
  REQUIRE(plan.tones.size() == 1);
  const auto& tone = plan.tones.front();
  CHECK_FALSE(tone.level_sd_dB);
  planner.add_level_uncertainty(plan);
  const double here_dB =
      physics::level_uncertainty(planner.surface(), tone.frequency_Hz, tone.last_peak_m.value()).total_dB;
  CHECK(here_dB > 0.5);
  CHECK(tone.level_sd_dB.value() == Approx(here_dB).epsilon(0.05));
  const auto under = planner.under_finger(plan);
  REQUIRE(under.level);
  CHECK(under.friction_low < under.friction);
  CHECK(under.friction_high > under.friction);
  auto& surface = rig.surface;
  // the largest values that a rig file may have: some surface could not exist, so the level is not known
  const auto stated = surface;
  for (const auto& [sd, largest] : {std::pair(&rig::Surface::half_width_sd_m, 1.0),
                                    {&rig::Surface::slope_sd, 1.0},
                                    {&rig::Surface::quality_factor_sd, 1e6},
                                    {&rig::Surface::thickness_sd_m, 0.1}}) {
    surface = stated;
    surface.*sd = largest;
    Planner vague(rig);
    vague.add_level_uncertainty(plan);
    CHECK_FALSE(plan.tones.front().level_sd_dB);
    CHECK_FALSE(vague.under_finger(plan).level);
    CHECK_FALSE(finger_shares(rig, {plan.tones.front().frequency_Hz})->level_sd_dB);
  }
  surface.thickness_sd_m = surface.modulus_sd_Pa = surface.density_sd_kg_m3 = surface.temperature_sd_K = 0;
  surface.half_width_sd_m = surface.slope_sd = surface.clamp_line_sd_m = surface.quality_factor_sd = 0;
  Planner exact(rig);
  exact.add_level_uncertainty(plan);
  CHECK_FALSE(plan.tones.front().level_sd_dB);
  CHECK_FALSE(exact.under_finger(plan).level);
}

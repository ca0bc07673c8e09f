#include "tests/benchmark/planning.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "physics/centre_line.hpp"
#include "physics/edge.hpp"
#include "physics/field.hpp"
#include "physics/planner.hpp"
#include "station/scene/planner.hpp"
#include "tests/benchmark/stopwatch.hpp"
#include "tests/physics/random_scenes.hpp"
#include "tests/physics/random_surfaces.hpp"

namespace turnpoint::benchmark {

namespace {

constexpr double kBudget_s = 2;

scene::Scene scene_of(double boundary_m) {
  scene::Scene scene;
  scene.boundary_m = boundary_m;
  scene.edge = physics::parse_edge("p50");
  scene.tolerance = {0.5e-3, 0.3, {}};
  return scene;
}

scene::Scene one_tone() {
  auto scene = scene_of(0.15);
  scene.displacement_m = 0.5e-6;
  return scene;
}

scene::Scene zone_of_three_tones() {
  auto scene = scene_of(0.185);
  scene.zone = scene::ZoneTarget{0.04, 0.75, 3, {}};
  return scene;
}

double planning_s(const rig::Rig& rig, const scene::Scene& scene) {
  return best_time(kBudget_s, [&] {
    scene::Planner planner(rig);
    planner.under_finger(planner.plan(scene));
  });
}

/// A membrane, what is asked of its field, and the points of the field.
struct RandomScene {
  physics::Surface surface;
  physics::PlanRequest request;
  std::vector<double> x_m;
};

std::vector<RandomScene> random_scenes(int count) {
  using namespace physics_test;
  constexpr int points = 1000;
  std::vector<RandomScene> scenes;
  for (Draw draw(20261127); static_cast<int>(scenes.size()) < count;) {
    RandomScene scene{random_membrane(draw), {}, {}};
    const double length_m = scene.surface.length_m;
    scene.request.tones = {physics::Tone{frequency_Hz, 1, 0}};
    scene.request.points = points;
    scene.request.tolerance.amplitude = draw.spread(3e-3, 1);
    const auto turning = physics::turning_point_m(scene.surface, frequency_Hz);
    if (!turning || *turning < 0.02 * length_m) continue;
    for (int i = 0; i < points; ++i) scene.x_m.push_back(std::min(length_m, length_m * i / (points - 1)));
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

}  // namespace

Report bench_planner() {
  constexpr int count = 300, repeats = 5;
  const auto scenes = random_scenes(count);
  const auto field = [](const RandomScene& scene, physics::Model model) {
    physics::evaluate(scene.surface, scene.request.tones, scene.x_m, model, scene.request.normalise);
  };
  const auto choice = [](const RandomScene& scene) {
    return physics::choose_model(scene.surface, scene.request).model;
  };
  const auto all = [&scenes](auto work) {
    return [&scenes, work] {
      for (const auto& scene : scenes) work(scene);
    };
  };
  Report report{"planner",
                "Choosing a model and computing a field of 1000 points with it, mean of 300 random membranes",
                {{"what", "time_ms", "ratio"}, {}},
                {}};
  for (const auto& found : compare(
           {{"field by modes", all([&](const RandomScene& scene) { field(scene, physics::Model::modes); })},
            {"choice", all([&](const RandomScene& scene) { choice(scene); })},
            {"choice and field", all([&](const RandomScene& scene) { field(scene, choice(scene)); })}},
           repeats))
    report.table.rows.push_back({found.name, 1e3 * found.time_s / count, found.ratio});
  return report;
}

Report bench_planning() {
  Report report{"planning",
                "A scene's first plan on the simulated rig's plate, with a finger",
                {{"scene", "theory", "time_ms", "ratio"}, {}},
                {}};
  auto rig = rig::load(std::string(TURNPOINT_SOURCE_DIR) + "/deploy/rigs/simulated.toml");
  const std::pair<const char*, scene::Scene> scenes[]{{"one tone", one_tone()},
                                                      {"zone of three tones", zone_of_three_tones()}};
  const std::pair<const char*, rig::PlateTheory> theories[]{{"kirchhoff", rig::PlateTheory::kirchhoff},
                                                            {"mindlin", rig::PlateTheory::mindlin},
                                                            {"elastic", rig::PlateTheory::elastic}};
  for (const auto& [name, scene] : scenes) {
    double baseline_s = 0;
    for (const auto& [theory, value] : theories) {
      rig.surface.plate_theory = value;
      const double s = planning_s(rig, scene);
      if (value == rig::PlateTheory::kirchhoff) baseline_s = s;
      report.table.rows.push_back({std::string(name), std::string(theory), 1e3 * s, s / baseline_s});
    }
  }
  return report;
}

}  // namespace turnpoint::benchmark

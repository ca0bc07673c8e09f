#include "tests/benchmark/planning.hpp"

#include <string>

#include "physics/edge.hpp"
#include "station/scene/planner.hpp"
#include "tests/benchmark/stopwatch.hpp"

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

}  // namespace

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

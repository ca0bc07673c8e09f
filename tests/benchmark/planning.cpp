#include "tests/benchmark/planning.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "physics/centre_line.hpp"
#include "physics/edge.hpp"
#include "physics/field.hpp"
#include "physics/operations.hpp"
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

/// A surface, what is asked of its field, and the points of the field.
struct RandomScene {
  physics::Surface surface;
  physics::PlanRequest request;
  std::vector<double> x_m;
  physics::Model cheapest =
      physics::Model::modes;  ///< the cheapest model whose true error is within the tolerance
};

physics::Surface random_clamped_plate(physics_test::Draw& draw) {
  while (true) {
    auto surface = physics_test::random_thin_plate(draw);
    if (surface.edges == physics::Edges::clamped) return surface;
  }
}

/// `mode` if its error, compared with `modes`, is within the tolerance of |v|, of the level or of the
/// boundary.
physics::Model cheapest(const RandomScene& scene) {
  const auto& [boundary_m, amplitude, level_dB] = scene.request.tolerance;
  const double f = scene.request.tones.front().frequency_Hz;
  const auto one = physics::make_centre_line(scene.surface, f, physics::Model::mode),
             exact = physics::make_centre_line(scene.surface, f, physics::Model::modes);
  bool enough = true;
  if (amplitude) {
    const auto field = [&scene](physics::Model model) {
      return physics::evaluate(scene.surface, scene.request.tones, scene.x_m, model, scene.request.normalise)
          .amplitude;
    };
    const auto a = field(physics::Model::mode), b = field(physics::Model::modes);
    double worst = 0;
    for (std::size_t i = 0; i < b.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
    enough = worst <= *amplitude * *std::ranges::max_element(b);
  }
  const auto peak = one->last_peak_m(), exact_peak = exact->last_peak_m();
  if ((level_dB || boundary_m) && !(peak && exact_peak)) return physics::Model::modes;
  if (level_dB) {
    const auto gain = [](const physics::CentreLine& line, double at_m) {
      return line.value(at_m).ln_magnitude() - line.value(0).ln_magnitude();
    };
    enough = 20 / std::log(10.0) * std::abs(gain(*one, *peak) - gain(*exact, *exact_peak)) <= *level_dB;
  }
  if (boundary_m) {
    const auto at = one->level_m(scene.request.edge.level),
               exact_at = exact->level_m(scene.request.edge.level);
    enough = at && exact_at && std::abs(*at - *exact_at) <= *boundary_m;
  }
  return enough ? physics::Model::mode : physics::Model::modes;
}

std::vector<RandomScene> random_scenes(int count, physics::Surface (*make)(physics_test::Draw&)) {
  using namespace physics_test;
  constexpr int points = 1000;
  std::vector<RandomScene> scenes;
  for (Draw draw(20261127); static_cast<int>(scenes.size()) < count;) {
    RandomScene scene{make(draw), {}, {}};
    const double length_m = scene.surface.length_m;
    scene.request.tones = {physics::Tone{frequency_Hz, 1, 0}};
    scene.request.points = points;
    scene.request.edge = physics::Edge::percent(0.5);
    scene.request.coarsest = physics::Model::mode;  // a field is wanted
    switch (scenes.size() % 3) {
      case 0:
        scene.request.tolerance.amplitude = draw.spread(3e-3, 1);
        break;
      case 1:
        scene.request.tolerance.level_dB = draw.spread(0.03, 3);
        break;
      default:
        scene.request.tolerance.boundary_m = draw.spread(2e-5, 2e-3);
    }
    const auto turning = physics::turning_point_m(scene.surface, frequency_Hz);
    if (!turning || *turning < 0.02 * length_m) continue;
    for (int i = 0; i < points; ++i) scene.x_m.push_back(std::min(length_m, length_m * i / (points - 1)));
    scene.cheapest = cheapest(scene);
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

}  // namespace

namespace {

/// What one scene costs in one of the ways that are compared, and the same divided by the cost of `modes`.
struct Cost {
  std::vector<double> operations, operations_ratio, time_s, time_ratio;
};

double mean(const std::vector<double>& list) {
  return std::accumulate(list.begin(), list.end(), 0.0) / static_cast<double>(list.size());
}

/// The value that 99 % of the scenes do not exceed.
double percentile_99(std::vector<double> list) {
  std::ranges::sort(list);
  return list[(list.size() * 99 + 99) / 100 - 1];
}

double operations_of(const std::function<void()>& run) {
  const double before = physics::operations_done();
  run();
  return physics::operations_done() - before;
}

}  // namespace

Report bench_planner() {
  using physics::Model;
  constexpr int repeats = 3;
  struct Kind {
    const char* name;
    int scenes;
    physics::Surface (*make)(physics_test::Draw&);
  };
  const Kind kinds[]{{"membranes", 300, physics_test::random_membrane},
                     {"clamped thin plates", 100, random_clamped_plate},
                     {"thick plates", 100, physics_test::random_thick_plate}};
  const auto field = [](const RandomScene& scene, Model model, const physics::SolvedLines& solved = {}) {
    physics::evaluate(scene.surface, scene.request.tones, scene.x_m, model, scene.request.normalise, solved);
  };
  Report report{
      "planner",
      "Choosing a model and computing a field of 1000 points with it, on random surfaces, a third each with "
      "tolerances of |v| from 0.3 to 100 %, of the level from 0.03 to 3 dB, and of the boundary (p50) from "
      "0.02 "
      "to 2 mm. operations: floating-point operations of the solvers, mean; ratio: mean divided by that "
      "of modes everywhere; of_oracle: divided by that of the cheapest that suffices, which knows the true "
      "errors; percentile_99: of the single scenes' ratios; time: of the processor; mode_percent: scenes "
      "that "
      "mode presents; taken_percent: of those in which it truly suffices; beyond_percent: scenes that mode "
      "presents although it does not suffice",
      {{"surfaces", "what", "operations_million", "ratio", "of_oracle", "percentile_99", "time_ms",
        "time_ratio", "time_of_oracle", "time_percentile_99", "mode_percent", "taken_percent",
        "beyond_percent"},
       {}},
      {}};
  for (const auto& kind : kinds) {
    const auto scenes = random_scenes(kind.scenes, kind.make);
    std::array<Cost, 3> costs;
    std::array<std::string, 3> names;
    int suffices = 0, taken = 0, right = 0;
    for (const auto& scene : scenes) {
      Model chosen = Model::modes;
      const std::vector<Work> works{
          {"field by modes", [&] { field(scene, Model::modes); }},
          {"field by the cheapest that suffices", [&] { field(scene, scene.cheapest); }},
          {"choice and field", [&] {
             const auto choice = physics::choose_model(scene.surface, scene.request);
             field(scene, choice.model, choice.solved);
             chosen = choice.model;
           }}};
      const auto timed = compare(works, repeats);
      for (std::size_t i = 0; i < works.size(); ++i) {
        Cost& cost = costs[i];
        names[i] = works[i].name;
        cost.operations.push_back(operations_of(works[i].run));
        cost.operations_ratio.push_back(cost.operations.back() / costs[0].operations.back());
        cost.time_s.push_back(timed[i].time_s);
        cost.time_ratio.push_back(timed[i].ratio);
      }
      suffices += scene.cheapest == Model::mode;
      taken += chosen == Model::mode;
      right += chosen == Model::mode && scene.cheapest == Model::mode;
    }
    const double count = static_cast<double>(scenes.size());
    const std::array<double, 3> mode_percent{0, 100 * suffices / count, 100 * taken / count},
        taken_percent{0, 100, 100.0 * right / std::max(1, suffices)},
        beyond_percent{0, 0, 100 * (taken - right) / count};
    for (std::size_t i = 0; i < costs.size(); ++i) {
      const auto of = [&](std::size_t other, std::vector<double> Cost::*what) {
        return mean(costs[i].*what) / mean(costs[other].*what);
      };
      report.table.rows.push_back(
          {std::string(kind.name), names[i], 1e-6 * mean(costs[i].operations), of(0, &Cost::operations),
           of(1, &Cost::operations), percentile_99(costs[i].operations_ratio), 1e3 * mean(costs[i].time_s),
           of(0, &Cost::time_s), of(1, &Cost::time_s), percentile_99(costs[i].time_ratio), mode_percent[i],
           taken_percent[i], beyond_percent[i]});
    }
  }
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

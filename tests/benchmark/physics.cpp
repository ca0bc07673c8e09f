#include "tests/benchmark/physics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "physics/boundary_map.hpp"
#include "physics/centre_line.hpp"
#include "physics/field.hpp"
#include "physics/modal_field.hpp"
#include "tests/benchmark/scipy.hpp"
#include "tests/benchmark/scripts.hpp"
#include "tests/benchmark/solvers.hpp"
#include "tests/benchmark/stopwatch.hpp"

namespace turnpoint::benchmark {

namespace {

using physics::CentreLine;
using physics::Model;
constexpr int kPoints = 1000;

struct Scene {
  std::string name;
  physics::Surface surface;
  double frequency_Hz;
  bool plate = false;
  bool from_python = false;  // true for the scene that is also timed from Python
};

std::vector<Scene> scenes() {
  physics::Surface lossless = physics::seed_brass(), lossy = lossless, curved = lossless;
  lossy.quality_factor = curved.quality_factor = 60;
  curved.taper = physics::ExponentialTaper{0.03, 0.12};
  return {{"seed brass 19.6 kHz, lossless", lossless, 19600},
          {"seed brass 45 kHz, lossless", lossless, 45000},
          {"seed brass 19.6 kHz, Q = 60", lossy, 19600, false, true},
          {"seed brass 45 kHz, Q = 60", lossy, 45000},
          {"exponential taper 30 kHz, Q = 60", curved, 30000},
          {"aluminium plate 30 kHz, Q = 30", physics::aluminium_plate(), 30000, true}};
}

/// Returns the wave's amplitude |v| at the points x, scaled so that its last maximum is one.
std::vector<double> amplitudes(const CentreLine& line, const std::vector<double>& x) {
  const double unit = line.value(line.last_peak_m().value_or(0)).ln_magnitude();
  Solution v(x.size());
  std::vector<double> ln(x.size());
  line.evaluate(x, 1.0, unit, v, ln);
  for (double& one : ln) one = std::exp(std::min(one, 300.0));
  return ln;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0, most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    worst = std::max(worst, std::abs(a[i] - b[i]));
    most = std::max(most, std::abs(b[i]));
  }
  return worst / most;
}

/// A resolution of the model `modes`, and its name in the table: the default, and the coarsest and the finest
/// with which it is compared.
struct Resolution {
  const char* setting;
  physics::ModalResolution resolution;
};

std::vector<Resolution> resolutions() {
  const auto one = [](int degree, double radians, int spare) {
    physics::ModalResolution r;
    r.degree = degree, r.radians = radians, r.spare_functions = spare;
    return r;
  };
  return {{"degree 4, 1 spare", one(4, 2.5, 1)}, {"default", {}}, {"degree 8, 5 spare", one(8, 2.2, 5)}};
}

/// Adds the time of the same call from Python, if the Python package was built and its interpreter is found.
void time_from_python(const Scene& scene, double budget_s, double error, std::vector<PhysicsRow>& rows) {
  const auto printed = run_peer(
      "field_from_python.py", {TURNPOINT_PYTHON_FOLDER, fmt::format("{}", scene.frequency_Hz),
                               fmt::format("{}", scene.surface.quality_factor), fmt::format("{}", budget_s)});
  if (printed.size() == 1)
    rows.push_back({Task::field, scene.name, "mode", "evaluate() from Python", kPoints,
                    std::strtod(printed[0].c_str(), nullptr), error});
}

void bench_field(const Scene& scene, double budget_s, std::vector<PhysicsRow>& rows) {
  const auto x = physics::linspace_points(scene.surface, kPoints);
  physics::ModalResolution fine;
  fine.degree = 10, fine.radians = 1.5, fine.spare_functions = 9;
  const auto solve = [&](const physics::ModalResolution& resolution) {
    return physics::make_modal_line(scene.surface, scene.frequency_Hz, physics::Losses::kept, resolution);
  };
  const auto truth = amplitudes(*solve(fine), x);
  Solution v(x.size());
  std::vector<double> ln(x.size());
  for (const Model model : {Model::mode}) {
    try {
      const auto make = [&] { return make_centre_line(scene.surface, scene.frequency_Hz, model); };
      const double error = largest_difference(amplitudes(*make(), x), truth);
      const double took = best_time(budget_s, [&] { make()->evaluate(x, 1.0, 0.0, v, ln); });
      rows.push_back({Task::field, scene.name, std::string(physics::name(model)), "", kPoints, took, error});
      if (model != Model::mode) continue;
      // Also time evaluate(), the function that users of the library call for this field.
      const physics::Tone tone{scene.frequency_Hz, 1, 0};
      const double called = best_time(budget_s, [&] {
        physics::evaluate(scene.surface, {&tone, 1}, x, model, physics::Normalise::peak);
      });
      rows.push_back({Task::field, scene.name, "mode", "evaluate()", kPoints, called, error});
      if (scene.from_python) time_from_python(scene, budget_s, error, rows);
    } catch (const std::domain_error&) {  // this model cannot describe this scene
    }
  }
  for (const auto& [setting, resolution] : resolutions()) {
    const double error = largest_difference(amplitudes(*solve(resolution), x), truth);
    const double took = best_time(budget_s, [&] { solve(resolution)->evaluate(x, 1.0, 0.0, v, ln); });
    rows.push_back({Task::field, scene.name, "modes", setting, kPoints, took, error});
  }
}

OneModeProblem problem_of(const Scene& scene, const std::vector<double>& x) {
  const auto equation = physics::march_equation(scene.surface, scene.frequency_Hz, physics::Losses::kept);
  OneModeProblem problem;
  problem.k_squared = equation.a;
  problem.b = equation.b;
  problem.c = equation.c;
  problem.length_m = scene.surface.length_m;
  problem.x_m = x;
  if (const auto* linear = std::get_if<physics::LinearTaper>(&scene.surface.taper)) {
    problem.w0 = linear->half_width_m;
    problem.slope = linear->slope;
  } else {
    const auto& curved = std::get<physics::ExponentialTaper>(scene.surface.taper);
    problem.w0 = curved.half_width_m;
    problem.decay_m = curved.decay_length_m;
  }
  return problem;
}

/// Returns the amplitude |v|, scaled to one at point `top`, where the reference has its largest value.
std::vector<double> scaled(const Solution& v, std::size_t top) {
  std::vector<double> a;
  for (const auto& one : v) a.push_back(std::abs(one) / std::abs(v[top]));
  return a;
}

void bench_equation(const Scene& scene, double budget_s, std::vector<PhysicsRow>& rows) {
  const auto x = physics::linspace_points(scene.surface, kPoints);
  const OneModeProblem problem = problem_of(scene, x);
  const Solution exact = reference_solution(problem);
  if (exact.empty()) return;
  const auto top = static_cast<std::size_t>(
      std::max_element(exact.begin(), exact.end(),
                       [](const auto& a, const auto& b) { return std::abs(a) < std::abs(b); }) -
      exact.begin());
  const auto truth = scaled(exact, top);
  const auto add = [&](const std::string& solver, const std::string& setting, double seconds,
                       const Solution& v) {
    rows.push_back({Task::equation, scene.name, solver, setting, kPoints, seconds,
                    largest_difference(scaled(v, top), truth)});
  };
  Solution v(x.size());
  std::vector<double> ln(x.size());
  const auto mode = [&] {
    const auto line = make_centre_line(scene.surface, scene.frequency_Hz, Model::mode);
    line->evaluate(x, 1.0, line->value(x[top]).ln_magnitude(), v, ln);
  };
  const double took = best_time(budget_s, mode);
  add("mode", "", took, v);
  for (const Solver& solver : general_solvers(problem)) {
    const Solution answer = solver.solve(problem);
    add(solver.name, solver.setting, best_time(budget_s, [&] { solver.solve(problem); }), answer);
  }
  for (const ScipyRun& run : run_scipy(problem)) add(run.name, run.setting, run.seconds, run.v);
}

/// Measures error and time of each plate theory on the simulated rig's plate (3 mm thick). The table below
/// holds frequencies and the boundaries that are taken as true there: those of the finer mesh in
/// elastic_taper.csv plus half of their change from the coarse mesh.
void bench_theories(double budget_s, std::vector<PhysicsRow>& rows) {
  using physics::PlateTheory;
  constexpr double reference[][2] = {{22400, 0.076356}, {30000, 0.139949}, {45000, 0.215341}};
  physics::Surface plate = physics::aluminium_plate();
  plate.thickness_m = 3e-3;
  plate.taper = physics::LinearTaper{15.1e-3, 0.03};
  for (const auto& [frequency, boundary] : reference) {
    for (const auto theory : {PlateTheory::kirchhoff, PlateTheory::mindlin, PlateTheory::elastic}) {
      plate.theory = theory;
      for (const Model model : {Model::mode, Model::modes}) {
        if (theory == PlateTheory::elastic && model == Model::modes)
          continue;  // the theory `elastic` has no model `modes`
        const auto p50 = [&] { return make_centre_line(plate, frequency, model)->level_m(0.5).value(); };
        const double error = std::abs(p50() - boundary);
        rows.push_back({Task::theory, fmt::format("3 mm plate, {:g} kHz", frequency / 1000),
                        fmt::format("{}, {}", physics::name(theory), physics::name(model)), "", 1,
                        best_time(budget_s, p50), error});
      }
    }
  }
}

/// Times look-ups in a boundary map in both directions, and measures the largest error of a round trip in
/// metres.
void bench_map(const std::string& name, const physics::Surface& surface, double budget_s,
               std::vector<PhysicsRow>& rows) {
  const auto build = [&] { return physics::BoundaryMap(surface, {physics::Edge::percent(0.5), {}, {}, {}}); };
  const auto map = build();
  constexpr int look_ups = 1000;
  double worst = 0;
  std::vector<double> x, f;
  for (int i = 0; i < look_ups; ++i) {
    const double frequency = 20e3 + 25.0 * i;
    const auto at = map.boundary_m(frequency);
    if (!at) continue;
    x.push_back(*at), f.push_back(frequency);
    worst = std::max(worst, std::abs(map.boundary_m(map.frequency_Hz(*at).value_or(0)).value_or(0) - *at));
  }
  double sum = 0;
  const double forward = best_time(budget_s, [&] {
    for (const double one : f) sum += map.boundary_m(one).value_or(0);
  });
  const double backward = best_time(budget_s, [&] {
    for (const double one : x) sum += map.frequency_Hz(one).value_or(0);
  });
  const int n = static_cast<int>(x.size());
  if (!(sum > 0)) throw std::runtime_error(name + ": the map presents no boundary from 20 to 45 kHz");
  rows.push_back({Task::look_up, name, "position of a frequency", "", n, forward, worst});
  rows.push_back({Task::look_up, name, "frequency of a position", "", n, backward, worst});
  rows.push_back({Task::look_up, name, "building the map", "", 1, best_time(0, build), -1});
}

const char* name(Task task) {
  switch (task) {
    case Task::field:
      return "two-dimensional field";
    case Task::equation:
      return "one-mode equation";
    case Task::theory:
      return "p50 of 3-D elasticity";
    case Task::look_up:
      break;
  }
  return "p50 map";
}

}  // namespace

std::vector<PhysicsRow> measure_physics(double budget_s) {
  std::vector<PhysicsRow> rows;
  const auto all = scenes();
  const double share = budget_s / (20.0 * static_cast<double>(all.size()));
  for (const Scene& scene : all) bench_field(scene, share, rows);
  for (const Scene& scene : all)
    if (!scene.plate) bench_equation(scene, share, rows);
  bench_theories(share, rows);
  bench_map("seed brass", all.front().surface, share, rows);
  bench_map("exponential taper", all[4].surface, share, rows);
  bench_map("aluminium plate", all.back().surface, share, rows);
  physics::Surface table = all.front().surface, endless = table;
  physics::TabulatedTaper points;
  for (int i = 0; i <= 1000; ++i) points.points.push_back({2.9e-4 * i, 0.03 - 2.9e-5 * i});
  table.taper = points, table.length_m = 0.29;
  endless.taper = physics::ExponentialTaper{0.03, 0.01}, endless.length_m = 1;
  bench_map("table of 1001 points", table, share, rows);
  bench_map("exponential taper of 100 decay lengths", endless, share, rows);
  return rows;
}

Report bench_physics(double budget_s) {
  Report report{"physics",
                "Error against time of every model and of general solvers (error: of |v|, largest at one; "
                "p50 and maps: m)",
                {{"against", "scene", "solver", "setting", "points", "time_us", "ns_per_point", "error"}, {}},
                {}};
  const auto rows = measure_physics(budget_s);
  for (const auto& row : rows)
    report.table.rows.push_back({std::string(name(row.task)), row.scene, row.solver, row.setting,
                                 static_cast<double>(row.points), row.seconds * 1e6,
                                 row.seconds * 1e9 / row.points, row.error >= 0 ? Cell(row.error) : Cell()});
  report.pictures = physics_pictures(rows);
  return report;
}

}  // namespace turnpoint::benchmark

#include <algorithm>
#include <map>

#include "tests/benchmark/physics.hpp"

namespace turnpoint::benchmark {

namespace {

/// A series in the figure: all solvers whose names begin with one of these words. The legend lists the series
/// in the order of the vectors below.
struct Series {
  const char* label;
  std::vector<std::string> beginnings;
  bool joined = true;  ///< whether to draw a line through the settings of a solver
};

const std::vector<Series> kRungs{{"mode", {"mode"}}, {"modes, three resolutions", {"modes"}}};
const std::vector<Series> kTheories{{"kirchhoff: mode, modes", {"kirchhoff"}},
                                    {"mindlin: mode, modes", {"mindlin"}},
                                    {"elastic: mode", {"elastic"}}};
const std::vector<Series> kSolvers{{"Turnpoint, mode", {"mode"}},
                                   {"Numerov", {"Numerov"}},
                                   {"Odeint dopri5", {"Boost.Odeint dopri5"}},
                                   {"Odeint Bulirsch-Stoer", {"Boost.Odeint bulirsch"}},
                                   {"SciPy DOP853", {"SciPy DOP853"}},
                                   {"Bessel: Boost, SciPy", {"Boost.Math", "SciPy jv"}, false}};

bool belongs(const std::string& solver, const Series& series) {
  return std::any_of(series.beginnings.begin(), series.beginnings.end(), [&](const std::string& beginning) {
    return beginning == "mode" ? solver == beginning : solver.starts_with(beginning);
  });
}

/// The axes of a figure. Errors below `floor` are drawn at `floor`, because a logarithmic axis needs an end.
struct Axes {
  std::string time, error;
  double floor, top = 1;
};

report::Chart panel_of(const std::string& scene, const std::vector<PhysicsRow>& rows,
                       const std::vector<Series>& series, const Axes& axes) {
  const double floor = axes.floor;
  report::Chart panel;
  panel.title = scene;
  panel.x = {axes.time, 10, 1e5, report::AxisScale::log10};
  panel.y = {axes.error, floor, axes.top, report::AxisScale::log10};
  for (std::size_t s = 0; s < series.size(); ++s) {
    report::Line line;
    line.series = static_cast<int>(s);
    line.name = series[s].label;
    for (const auto& row : rows) {
      if (row.scene != scene || !belongs(row.solver, series[s])) continue;
      line.x.push_back(std::clamp(row.seconds * 1e6, 10.0, 1e5));
      line.y.push_back(std::max(row.error, floor));
    }
    if (line.x.empty()) continue;
    report::Points dots{line.x, line.y, {}, {}, {}, {}, line.series, line.name};
    if (line.x.size() > 1 && series[s].joined) panel.layers.emplace_back(line);
    panel.layers.emplace_back(dots);
  }
  return panel;
}

report::Figure figure_of(const std::string& title, const std::vector<PhysicsRow>& rows, Task task,
                         const std::vector<Series>& series, const Axes& axes) {
  std::vector<PhysicsRow> wanted;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(wanted),
               [task](const PhysicsRow& row) { return row.task == task; });
  report::Figure figure;
  figure.title = title;
  figure.columns = 2;
  figure.chart_width_px = 480;
  figure.chart_height_px = 360;
  for (const auto& row : wanted) {
    const bool known = std::any_of(figure.charts.begin(), figure.charts.end(),
                                   [&](const auto& panel) { return panel.title == row.scene; });
    if (!known) figure.charts.push_back(panel_of(row.scene, wanted, series, axes));
  }
  return figure;
}

}  // namespace

std::vector<Picture> physics_pictures(const std::vector<PhysicsRow>& rows) {
  std::vector<Picture> pictures;
  const auto add = [&](const char* name, report::Figure figure) {
    if (!figure.charts.empty()) pictures.push_back({name, std::move(figure)});
  };
  const std::string profile = "time for 1000 points (\u00b5s)", error = "largest error of |v|";
  add("physics-field", figure_of("Models against the two-dimensional field", rows, Task::field, kRungs,
                                 {profile, error, 1e-8}));
  add("physics-theory",
      figure_of("Plate theories against three-dimensional finite elements", rows, Task::theory, kTheories,
                {"time for one boundary (\u00b5s)", "error of p50 (m)", 1e-6, 0.1}));
  add("physics-equation", figure_of("Solvers of the one-mode equation against extended precision", rows,
                                    Task::equation, kSolvers, {profile, error, 1e-16}));
  return pictures;
}

}  // namespace turnpoint::benchmark

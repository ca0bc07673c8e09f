#include "tests/benchmark/procedures.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <sstream>
#include <utility>

#include "station/procedure/posterior.hpp"
#include "tests/benchmark/scripts.hpp"

namespace turnpoint::benchmark {

namespace {

/// Returns `count` evenly spaced values from `from` to `to`.
std::vector<double> spaced(double from, double to, std::size_t count) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i)
    values[i] =
        count == 1 ? from : from + (to - from) * static_cast<double>(i) / static_cast<double>(count - 1);
  return values;
}

struct Shape {
  std::size_t stimuli, thresholds, slopes, lapses;
  int trials;
};

// A grid of usual size and a fine one for threshold, slope and lapse.
constexpr std::array<Shape, 2> kShapes{{{41, 81, 21, 5, 200}, {81, 101, 41, 11, 60}}};

procedure::Spec spec_of(const Shape& shape) {
  procedure::Spec spec;
  spec.name = "bench";
  spec.level = "contrast_dB";
  spec.kind = procedure::Kind::quest_plus;
  spec.stimuli.values = spaced(-40, 0, shape.stimuli);
  spec.threshold.values = spaced(-40, 0, shape.thresholds);
  spec.slope.values = spaced(0.5, 5, shape.slopes);
  spec.guess.values = {0.5};
  spec.lapse.values = spaced(0.005, 0.04, shape.lapses);
  spec.stop.trials = shape.trials;
  return spec;
}

/// QUEST+ over two dimensions: the grid of Watson's (2017) Example 4, and a finer one with a floor.
struct Surface {
  std::size_t stimuli, seconds, thresholds, gradients, floors;
  int trials;
};

constexpr std::array<Surface, 2> kSurfaces{{{26, 21, 11, 5, 11, 200}, {41, 25, 31, 21, 9, 30}}};

procedure::Spec spec_of(const Surface& surface) {
  procedure::Spec spec = spec_of(Shape{surface.stimuli, surface.thresholds, 1, 1, surface.trials});
  spec.stimuli.values = spaced(-50, 0, surface.stimuli);
  spec.second.emplace();
  spec.second->level = "frequency";
  spec.second->stimuli.values = spaced(0, 40, surface.seconds);
  spec.threshold.values = spaced(-60, -40, surface.thresholds);
  spec.gradient.values = spaced(0.8, 1.6, surface.gradients);
  spec.floor.values = spaced(-50, -30, surface.floors);
  spec.slope.values = {3}, spec.lapse.values = {0.01};
  return spec;
}

/// Signal detection with threshold, slope and criterion.
procedure::Spec detection(int trials) {
  auto spec = spec_of(Shape{2, 2, 1, 3, trials});
  spec.scale = procedure::Scale::log10, spec.signal_detection = true, spec.tracks = "yes";
  spec.guess = {};
  spec.stimuli.values = {0}, spec.threshold.values.clear();
  for (int i = 0; i < 41; ++i) spec.threshold.values.push_back(0.01 * std::pow(32.0, i / 40.0));
  spec.stimuli.values.insert(spec.stimuli.values.end(), spec.threshold.values.begin(),
                             spec.threshold.values.end());
  spec.slope.values = spaced(0.5, 4, 15);
  spec.criterion.values = spaced(-0.5, 2.5, 25);
  return spec;
}

std::vector<Cell> own(const std::string& name, const procedure::Spec& spec, int trials) {
  using clock = std::chrono::steady_clock;
  procedure::Posterior posterior(spec);
  std::vector<double> times;
  for (int trial = 0; trial < trials; ++trial) {
    const auto start = clock::now();
    const auto stimulus = posterior.best_stimulus();
    posterior.update(stimulus, trial % 4 != 3);
    times.push_back(std::chrono::duration<double, std::milli>(clock::now() - start).count());
  }
  std::sort(times.begin(), times.end());
  return {name,
          static_cast<double>(posterior.stimuli().size()),
          static_cast<double>(posterior.size()),
          times[times.size() / 2],
          times[times.size() * 99 / 100],
          static_cast<double>(posterior.memory_bytes()) / 1e6};
}

/// Returns the grid's size as arguments for the scripts of the other programs: stimuli, thresholds, slopes,
/// lapses.
std::vector<std::string> arguments_of(const Shape& shape) {
  return {std::to_string(shape.stimuli), std::to_string(shape.thresholds), std::to_string(shape.slopes),
          std::to_string(shape.lapses)};
}

std::vector<std::string> arguments_of(const Surface& surface) {
  std::vector<std::string> arguments;
  for (const auto count :
       {surface.stimuli, surface.seconds, surface.thresholds, surface.gradients, surface.floors})
    arguments.push_back(std::to_string(count));
  return arguments;
}

/// Makes a row of the table for another program from its output "version median p99". Returns no row if the
/// program is missing.
std::vector<std::vector<Cell>> peer(const std::string& name, std::size_t stimuli, std::size_t parameters,
                                    const std::vector<std::string>& lines) {
  if (lines.empty()) return {};
  std::istringstream words(lines.back());  // use the last line, because a program may print a greeting first
  std::string version;
  double median_ms = 0, p99_ms = 0;
  if (!(words >> version >> median_ms >> p99_ms)) return {};
  return {{name + " " + version, static_cast<double>(stimuli), static_cast<double>(parameters), median_ms,
           p99_ms, Cell{}}};
}

/// Draws the time per trial against the size of the grid, with one series per program.
Picture picture_of_procedures(const Table& table) {
  report::Chart panel;
  panel.title = "One trial of QUEST+: median (marker) to 99th percentile";
  std::vector<double> sizes, times;
  std::vector<std::string> names;
  for (const auto& row : table.rows) {
    const auto& name = std::get<std::string>(row[0]);
    auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      names.push_back(name);
      found = names.end() - 1;
      panel.layers.emplace_back(
          report::Points{{}, {}, {}, {}, {}, {}, static_cast<int>(names.size()) - 1, name});
    }
    auto& dots = std::get<report::Points>(panel.layers[static_cast<std::size_t>(found - names.begin())]);
    const double cells = std::get<double>(row[1]) * std::get<double>(row[2]);
    dots.x.push_back(cells);
    dots.y.push_back(std::get<double>(row[3]));
    dots.low.push_back(std::get<double>(row[3]));
    dots.high.push_back(std::get<double>(row[4]));
    sizes.push_back(cells);
    times.insert(times.end(), {dots.low.back(), dots.high.back()});
  }
  panel.x = report::fitted("stimuli x parameters", sizes, 0.15, report::AxisScale::log10);
  panel.y = report::fitted("time (ms)", times, 0.15, report::AxisScale::log10);
  return {"procedures", {"Time of an adaptive trial", {panel}, 1, 520, 340, ""}};
}

}  // namespace

Report bench_procedures() {
  Report report{"procedures",
                "QUEST+: choosing a stimulus and learning from the answer, per trial",
                {{"program", "stimuli", "parameters", "median_ms", "p99_ms", "memory_MB"}, {}},
                {}};
  for (const auto& shape : kShapes) {
    auto spec = spec_of(shape);
    report.table.rows.push_back(own("turnpoint", spec, shape.trials));
    spec.nuisance = {"lapse"};
    report.table.rows.push_back(own("turnpoint, lapse as nuisance", spec, shape.trials));
    const auto parameters = shape.thresholds * shape.slopes * shape.lapses;
    for (const auto& [name, script] :
         {std::pair("questplus", "questplus_trial.py"), std::pair("jsQuestPlus", "jsquestplus_trial.js")})
      for (auto& row : peer(name, shape.stimuli, parameters, run_peer(script, arguments_of(shape))))
        report.table.rows.push_back(std::move(row));
  }
  for (const auto& surface : kSurfaces) {
    report.table.rows.push_back(own("turnpoint, two dimensions", spec_of(surface), surface.trials));
    for (auto& row : peer("questplus, two dimensions", surface.stimuli * surface.seconds,
                          surface.thresholds * surface.gradients * surface.floors,
                          run_peer("questplus_surface_trial.py", arguments_of(surface))))
      report.table.rows.push_back(std::move(row));
  }
  report.table.rows.push_back(own("turnpoint, criterion", detection(200), 200));
  report.pictures.push_back(picture_of_procedures(report.table));
  return report;
}

}  // namespace turnpoint::benchmark

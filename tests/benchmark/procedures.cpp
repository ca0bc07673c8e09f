#include "tests/benchmark/procedures.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <sstream>

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

std::vector<Cell> own(const std::string& name, const procedure::Spec& spec, const Shape& shape) {
  using clock = std::chrono::steady_clock;
  procedure::Posterior posterior(spec);
  std::vector<double> times;
  for (int trial = 0; trial < shape.trials; ++trial) {
    const auto start = clock::now();
    const auto stimulus = posterior.best_stimulus();
    posterior.update(stimulus, trial % 4 != 3);
    times.push_back(std::chrono::duration<double, std::milli>(clock::now() - start).count());
  }
  std::sort(times.begin(), times.end());
  return {name,
          static_cast<double>(shape.stimuli),
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

/// Makes a row of the table for another program from its output "version median p99". Returns no row if the
/// program is missing.
std::vector<std::vector<Cell>> peer(const std::string& name, const Shape& shape,
                                    const std::vector<std::string>& lines) {
  if (lines.empty()) return {};
  std::istringstream words(lines.back());  // use the last line, because a program may print a greeting first
  std::string version;
  double median_ms = 0, p99_ms = 0;
  if (!(words >> version >> median_ms >> p99_ms)) return {};
  return {{name + " " + version, static_cast<double>(shape.stimuli),
           static_cast<double>(shape.thresholds * shape.slopes * shape.lapses), median_ms, p99_ms, Cell{}}};
}

/// Draws the time per trial against the size of the grid, with one series per program.
Picture picture_of_procedures(const Table& table) {
  plot::Chart panel;
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
          plot::Points{{}, {}, {}, {}, {}, {}, static_cast<int>(names.size()) - 1, name});
    }
    auto& dots = std::get<plot::Points>(panel.layers[static_cast<std::size_t>(found - names.begin())]);
    const double cells = std::get<double>(row[1]) * std::get<double>(row[2]);
    dots.x.push_back(cells);
    dots.y.push_back(std::get<double>(row[3]));
    dots.low.push_back(std::get<double>(row[3]));
    dots.high.push_back(std::get<double>(row[4]));
    sizes.push_back(cells);
    times.insert(times.end(), {dots.low.back(), dots.high.back()});
  }
  panel.x = plot::fitted("stimuli x parameters", sizes, 0.15, plot::AxisScale::log10);
  panel.y = plot::fitted("time (ms)", times, 0.15, plot::AxisScale::log10);
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
    report.table.rows.push_back(own("turnpoint", spec, shape));
    spec.nuisance = {"lapse"};
    report.table.rows.push_back(own("turnpoint, lapse as nuisance", spec, shape));
    for (auto& row : peer("questplus", shape, run_peer("questplus_trial.py", arguments_of(shape))))
      report.table.rows.push_back(std::move(row));
    for (auto& row : peer("jsQuestPlus", shape, run_peer("jsquestplus_trial.js", arguments_of(shape))))
      report.table.rows.push_back(std::move(row));
  }
  report.pictures.push_back(picture_of_procedures(report.table));
  return report;
}

}  // namespace turnpoint::benchmark

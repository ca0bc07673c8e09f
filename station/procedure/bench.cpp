#include "station/procedure/bench.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <sstream>

#include "station/procedure/posterior.hpp"

namespace turnpoint::procedure {

namespace {

/// from ... to in `count` equal steps.
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

// A threshold, a slope and a lapse to learn: a usual grid and a fine one.
constexpr std::array<Shape, 2> kShapes{{{41, 81, 21, 5, 200}, {81, 101, 41, 11, 60}}};

Spec spec_of(const Shape& shape) {
  Spec spec;
  spec.name = "bench";
  spec.level = "contrast_dB";
  spec.kind = Kind::quest_plus;
  spec.stimuli.values = spaced(-40, 0, shape.stimuli);
  spec.threshold.values = spaced(-40, 0, shape.thresholds);
  spec.slope.values = spaced(0.5, 5, shape.slopes);
  spec.guess.values = {0.5};
  spec.lapse.values = spaced(0.005, 0.04, shape.lapses);
  spec.stop.trials = shape.trials;
  return spec;
}

BenchRow own(const Shape& shape) {
  using clock = std::chrono::steady_clock;
  Posterior posterior(spec_of(shape));
  std::vector<double> times;
  for (int trial = 0; trial < shape.trials; ++trial) {
    const auto start = clock::now();
    const auto stimulus = posterior.best_stimulus();
    posterior.update(stimulus, trial % 4 != 3);
    times.push_back(std::chrono::duration<double, std::milli>(clock::now() - start).count());
  }
  std::sort(times.begin(), times.end());
  return {"turnpoint",
          shape.stimuli,
          posterior.size(),
          times[times.size() / 2],
          times[times.size() * 99 / 100],
          posterior.memory_bytes()};
}

/// Python that prints "version median p99" (ms) for the same grid and answers.
std::string questplus_program(const Shape& shape) {
  std::ostringstream text;
  text << "import time, numpy as np, questplus as q\n"
       << "from importlib.metadata import version\n"
       << "p = q.QuestPlus(stim_domain=dict(intensity=np.linspace(-40, 0, " << shape.stimuli << ")),"
       << "param_domain=dict(threshold=np.linspace(-40, 0, " << shape.thresholds << "),"
       << "slope=np.linspace(.5, 5, " << shape.slopes << "), lower_asymptote=[.5],"
       << "lapse_rate=np.linspace(.005, .04, " << shape.lapses << ")),"
       << "outcome_domain=dict(response=['Y', 'N']), func='weibull', stim_scale='dB')\n"
       << "t = []\n"
       << "for i in range(8):\n"
       << "    a = time.perf_counter(); s = p.next_stim\n"
       << "    p.update(stim=s, outcome=dict(response='N' if i % 4 == 3 else 'Y'))\n"
       << "    t.append(1e3 * (time.perf_counter() - a))\n"
       << "print(version('questplus'), np.median(t), max(t))\n";
  return text.str();
}

/// A row for questplus; none where python3 or the package is absent.
std::vector<BenchRow> questplus(const Shape& shape) {
  const auto command = "python3 -W ignore -c \"" + questplus_program(shape) + "\" 2>/dev/null";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  if (!pipe) return {};
  std::array<char, 256> line{};
  if (!std::fgets(line.data(), static_cast<int>(line.size()), pipe.get())) return {};
  std::istringstream words(line.data());
  std::string version;
  BenchRow row{"questplus ", shape.stimuli, shape.thresholds * shape.slopes * shape.lapses, 0, 0, 0};
  if (!(words >> version >> row.median_ms >> row.p99_ms)) return {};
  row.what += version;
  return {row};
}

}  // namespace

std::vector<BenchRow> bench() {
  std::vector<BenchRow> rows;
  for (const auto& shape : kShapes) {
    rows.push_back(own(shape));
    for (auto& row : questplus(shape)) rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace turnpoint::procedure

#include "tests/benchmark/synth.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tests/benchmark/oscillators.hpp"

namespace turnpoint::benchmark {

namespace {

report::Chart panel_of(const char* title, const SynthBenchmark& measured, std::size_t from, std::size_t to) {
  report::Chart panel;
  panel.title = title;
  for (std::size_t m = from; m < std::min(to, measured.methods.size()); ++m) {
    const auto& method = measured.methods[m];
    report::Line line;
    line.series = static_cast<int>(m - from);
    line.name = fmt::format("{}: {:.2g} ns", method.name, method.ns_per_tone_frame);
    for (std::size_t i = 1; i < method.error_dB.size(); ++i) {
      line.x.push_back(measured.times_s[i]);
      line.y.push_back(method.error_dB[i]);
    }
    panel.layers.emplace_back(line);
  }
  panel.x = {"time since the start (s)", 1, 1e5, report::AxisScale::log10};
  panel.y = {"largest error (dB re full scale)", -340, 20, report::AxisScale::linear};
  return panel;
}

/// Draws the error against the time since the start. The legend gives the cost per tone and frame.
Picture picture_of_synth(const SynthBenchmark& measured) {
  // The first methods are the station's own and others whose error does not grow with time.
  constexpr std::size_t exact = 5;
  report::Figure figure;
  figure.title = "Ways of making a sinusoid";
  figure.columns = 2;
  figure.chart_width_px = 480;
  figure.chart_height_px = 400;
  figure.charts = {panel_of("phase from the frame's number", measured, 0, exact),
                   panel_of("phase or time that runs on", measured, exact, measured.methods.size())};
  figure.caption =
      fmt::format("{} Hz at {} Hz; nanoseconds per tone and frame.", measured.frequency_Hz, measured.rate_Hz);
  return {"synth", figure};
}

}  // namespace

Report bench_synth() {
  const auto measured = benchmark_synthesis();
  Report report{"synth",
                fmt::format("A tone of {} Hz at {} Hz: largest error (dB re full scale) after "
                            "a time, and cost",
                            measured.frequency_Hz, measured.rate_Hz),
                {{"method", "ns_per_tone_frame"}, {}},
                {picture_of_synth(measured)}};
  for (const double time : measured.times_s)
    report.table.columns.push_back(fmt::format("error_dB_{}_s", time));
  for (const auto& method : measured.methods) {
    std::vector<Cell> row{method.name, method.ns_per_tone_frame};
    row.insert(row.end(), method.error_dB.begin(), method.error_dB.end());
    row.resize(report.table.columns.size());
    report.table.rows.push_back(std::move(row));
  }
  return report;
}

}  // namespace turnpoint::benchmark

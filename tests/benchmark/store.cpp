#include "tests/benchmark/store.hpp"

#include "tests/benchmark/durable_trial.hpp"

namespace turnpoint::benchmark {

namespace {

Picture picture_of_store(const Table& table) {
  report::Chart panel;
  panel.title = "A durable trial: median (marker) to 99th percentile";
  std::vector<double> times;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto& row = table.rows[i];
    const double median = std::get<double>(row[2]), p99 = std::get<double>(row[3]);
    panel.layers.emplace_back(report::Points{{static_cast<double>(i + 1)},
                                             {median},
                                             {median},
                                             {p99},
                                             {},
                                             {},
                                             static_cast<int>(i),
                                             std::get<std::string>(row[0])});
    times.insert(times.end(), {median, p99});
  }
  panel.x = {"way of writing", 0, static_cast<double>(table.rows.size() + 1), report::AxisScale::linear};
  panel.y = report::fitted("time per trial (ms)", times, 0.1, report::AxisScale::log10);
  return {"store", {"Cost of a durable trial", {panel}, 1, 520, 340, ""}};
}

}  // namespace

Report bench_store(const std::string& directory, int trials) {
  Report report{"store",
                "A trial with its tones and events, durable before the next, on the disk of " + directory,
                {{"way", "trials", "median_ms", "p99_ms", "ratio"}, {}},
                {}};
  for (const auto& row : time_durable_trials(directory, trials))
    report.table.rows.push_back(
        {row.what, static_cast<double>(row.trials), row.median_ms, row.p99_ms, row.ratio});
  report.pictures.push_back(picture_of_store(report.table));
  return report;
}

}  // namespace turnpoint::benchmark

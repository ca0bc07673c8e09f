#include <fmt/ostream.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "station/report/chart.hpp"
#include "station/system/progress.hpp"
#include "station/system/stop_signals.hpp"
#include "station/system/write_file.hpp"
#include "tests/benchmark/follow.hpp"
#include "tests/benchmark/intervals.hpp"
#include "tests/benchmark/physics.hpp"
#include "tests/benchmark/planning.hpp"
#include "tests/benchmark/procedures.hpp"
#include "tests/benchmark/sensing.hpp"
#include "tests/benchmark/store.hpp"
#include "tests/benchmark/synth.hpp"

namespace turnpoint::benchmark {

namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::vector<std::string> what;
  std::string out, disk = std::filesystem::temp_directory_path().string();
  double seconds = 8;
  int trials = 200;
  bool json = false, progress = false;
};

const std::vector<std::string> kAll{"physics",   "planner", "planning", "synth", "procedures",
                                    "intervals", "sensing", "follow",   "store"};

Report measure(const std::string& what, const Options& options) {
  if (what == "physics") return bench_physics(options.seconds);
  if (what == "planner") return bench_planner();
  if (what == "planning") return bench_planning();
  if (what == "synth") return bench_synth();
  if (what == "procedures") return bench_procedures();
  if (what == "intervals") return bench_intervals();
  if (what == "sensing") return bench_sensing();
  if (what == "follow") return bench_follow();
  return bench_store(options.disk, options.trials);
}

Json to_json(const Report& report) {
  Json rows = Json::array();
  for (const auto& row : report.table.rows) {
    Json one = Json::object();
    for (std::size_t i = 0; i < row.size(); ++i) {
      auto& cell = one[report.table.columns[i]];
      if (const auto* text = std::get_if<std::string>(&row[i])) cell = *text;
      if (const auto* value = std::get_if<double>(&row[i]); value && std::isfinite(*value)) cell = *value;
    }
    rows.push_back(std::move(one));
  }
  return {{"title", report.title}, {"rows", std::move(rows)}};
}

std::vector<std::string> write(const Report& report, const std::string& folder) {
  std::filesystem::create_directories(folder);
  const auto path = [&](const std::string& file) {
    return (std::filesystem::path(folder) / ("bench-" + file)).string();
  };
  std::vector<std::string> files{path(report.name + ".csv")};
  system::write_file(files.back(), to_csv(report.table));
  for (const auto& picture : report.pictures) {
    files.push_back(path(picture.name + ".svg"));
    system::write_file(files.back(), report::render(picture.figure));
  }
  return files;
}

/// Runs the benchmarks and returns the exit status. The first stop signal ends the program after the table
/// that is being measured.
int bench(const Options& options) {
  Json document = Json::object();
  const auto tables = options.what.empty() ? kAll : options.what;
  std::atomic<bool> stop = false;
  system::Progress progress(options.progress ? system::ShowProgress::always
                                             : system::ShowProgress::on_terminal);
  const system::OnStopSignal on_signal([&](const std::string& signal) {
    fmt::print(stderr, "turnpoint-bench: {}: ends after this table; a second {} ends it now\n", signal,
               signal);
    stop = true;
  });
  int done = 0;
  for (const auto& what : tables) {
    if (stop) break;
    progress.show("tables", done++, static_cast<int>(tables.size()));
    const Report report = measure(what, options);
    progress.clear();
    std::vector<std::string> files;
    if (!options.out.empty()) files = write(report, options.out);
    if (options.json) {
      document[what] = to_json(report);
      if (!files.empty()) document[what]["files"] = files;
      continue;
    }
    fmt::print("{}: {}\n{}\n", what, report.title, to_text(report.table));
    for (const auto& file : files) fmt::print("wrote {}\n", file);
    std::fflush(stdout);
  }
  if (options.json) std::cout << document.dump(2) << "\n";
  if (stop) fmt::print(stderr, "turnpoint-bench: stopped after {} of {} tables\n", done, tables.size());
  return stop ? system::StopSignals::exit_status() : 0;
}

}  // namespace

}  // namespace turnpoint::benchmark

int main(int argc, char** argv) {
  using namespace turnpoint::benchmark;
  Options options;
  CLI::App app{"Speed against accuracy on this machine, as tables and plots"};
  app.add_option("what", options.what,
                 "physics | planner | planning | synth | procedures | intervals | sensing | follow | store; "
                 "otherwise all")
      ->check(CLI::IsMember(kAll));
  app.add_option("--out", options.out, "Folder for CSV tables and SVG plots");
  app.add_option("--seconds", options.seconds, "About how long physics may measure")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--disk", options.disk, "Folder on the disk that store measures")->capture_default_str();
  app.add_option("--trials", options.trials, "Trials that store writes each way")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_flag("--json", options.json, "Print one JSON document on standard output");
  app.add_flag("--progress", options.progress,
               "Show the progress on standard error even if it is not a terminal");
  app.footer("Example: turnpoint-bench physics --out bench");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    return bench(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "turnpoint-bench: {}\n", error.what());
    return 1;
  }
}

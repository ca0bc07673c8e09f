#include <fmt/ostream.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>

#include "station/benchmark/intervals.hpp"
#include "station/benchmark/physics.hpp"
#include "station/benchmark/procedures.hpp"
#include "station/benchmark/store.hpp"
#include "station/benchmark/synth.hpp"
#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/text/write_file.hpp"

namespace turnpoint::cli {

namespace {

using benchmark::Report;

struct Options {
  std::vector<std::string> what;
  std::string out, disk = std::filesystem::temp_directory_path().string();
  double seconds = 8;
  int trials = 200;
};

const std::vector<std::string> kAll{"physics", "synth", "procedures", "intervals", "store"};

Report measure(const std::string& what, const Options& options) {
  if (what == "physics") return benchmark::bench_physics(options.seconds);
  if (what == "synth") return benchmark::bench_synth();
  if (what == "procedures") return benchmark::bench_procedures();
  if (what == "intervals") return benchmark::bench_intervals();
  return benchmark::bench_store(options.disk, options.trials);
}

Json to_json(const Report& report) {
  Json rows = Json::array();
  for (const auto& row : report.table.rows) {
    Json one = Json::object();
    for (std::size_t i = 0; i < row.size(); ++i) {
      auto& cell = one[report.table.columns[i]];
      if (const auto* text = std::get_if<std::string>(&row[i])) cell = *text;
      if (const auto* value = std::get_if<double>(&row[i])) cell = json_number(*value);
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
  text::write_file(files.back(), benchmark::to_csv(report.table));
  for (const auto& picture : report.pictures) {
    files.push_back(path(picture.name + ".svg"));
    text::write_file(files.back(), plot::render(picture.figure));
  }
  return files;
}

void bench(const Options& options, Context& context) {
  Json document = Json::object();
  for (const auto& what : options.what.empty() ? kAll : options.what) {
    const Report report = measure(what, options);
    std::vector<std::string> files;
    if (!options.out.empty()) files = write(report, options.out);
    if (context.json) {
      document[what] = to_json(report);
      if (!files.empty()) document[what]["files"] = files;
      continue;
    }
    fmt::print(context.out, "{}: {}\n{}\n", what, report.title, benchmark::to_text(report.table));
    for (const auto& file : files) fmt::print(context.out, "wrote {}\n", file);
    context.out.flush();
  }
  if (context.json) context.out << document.dump(2) << "\n";
}

}  // namespace

void add_bench(CommandLine& app, Context& context) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("bench", "Speed against accuracy on this machine, as tables and plots");
  command
      ->add_option("what", options->what, "physics | synth | procedures | intervals | store; otherwise all")
      ->check(one_of(kAll));
  command->add_option("--out", options->out, "Folder for CSV tables and SVG plots");
  command->add_option("--seconds", options->seconds, "About how long physics may measure")
      ->check(positive())
      ->capture_default_str();
  command->add_option("--disk", options->disk, "Folder on the disk that store measures")
      ->capture_default_str();
  command->add_option("--trials", options->trials, "Trials that store writes each way")
      ->check(positive())
      ->capture_default_str();
  add_json(*command, context);
  command->footer("Example: turnpoint bench physics --out bench");
  command->callback([options, &context] { bench(*options, context); });
}

}  // namespace turnpoint::cli

#include "physics/figures.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/report/chart.hpp"
#include "station/system/write_file.hpp"

namespace turnpoint::cli {

namespace figures_command {

struct Options {
  std::string out;
};

report::Chart drawn(const physics::FigurePanel& panel, const std::string& x_label) {
  report::Chart result;
  result.title = panel.title;
  std::vector<double> values;
  for (const auto& mark : panel.marks)
    result.layers.emplace_back(report::Rule{report::Rule::Direction::vertical, mark.x_mm, mark.label});
  int series = 0;
  for (const auto& curve : panel.curves) {
    result.layers.emplace_back(report::Line{curve.x_mm, curve.value, series++, curve.label});
    values.insert(values.end(), curve.value.begin(), curve.value.end());
  }
  const auto& x_mm = panel.curves.front().x_mm;
  result.x = {x_label, x_mm.front(), x_mm.back(), report::AxisScale::linear};
  result.y = report::fitted(panel.y_label, values);
  return result;
}

report::Figure drawn(const physics::Figure& figure) {
  report::Figure result;
  result.title = figure.title;
  result.caption = figure.title + ". " + figure.note;
  result.chart_width_px = 760;
  result.chart_height_px = 300;
  for (const auto& panel : figure.panels) result.charts.push_back(drawn(panel, figure.x_label));
  return result;
}

void figures(const Options& options, Context& context) {
  system::make_folder(options.out);
  Json list = Json::array();
  for (const auto& figure : physics::figures()) {
    const auto path = (std::filesystem::path(options.out) / figure.id).string();
    system::write_file(path + ".svg", report::render(drawn(figure)));
    system::write_file(path + ".csv", physics::to_csv(figure));
    list.push_back({{"id", figure.id},
                    {"title", figure.title},
                    {"note", figure.note},
                    {"files", {path + ".svg", path + ".csv"}}});
    if (!context.json)
      fmt::print(context.out, "{}: {}\n  {}\n  wrote {}.svg and .csv\n", figure.id, figure.title, figure.note,
                 path);
  }
  if (context.json) print_json(context.out, list);
}

}  // namespace figures_command

void add_figures(CommandLine& app, Context& context) {
  using namespace figures_command;
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand(
      "figures", "Draw figures 3, 5, 8 and 10 of the 1998 paper next to the corrected theory");
  command->add_option("--out", options->out, "Folder for the SVG and CSV files")->value("FOLDER")->required();
  add_json(*command, context);
  command->footer("Example: turnpoint figures --out figures");
  command->callback([options, &context] { figures(*options, context); });
}

}  // namespace turnpoint::cli

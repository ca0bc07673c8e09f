#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>

#include "physics/boundary_budget.hpp"
#include "physics/boundary_map.hpp"
#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"
#include "station/core/limits.hpp"
#include "station/core/number.hpp"
#include "station/report/chart.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/planner.hpp"
#include "station/scene/transducer.hpp"
#include "station/scene/under_finger.hpp"
#include "station/session/places.hpp"
#include "station/session/prepare.hpp"
#include "station/system/write_file.hpp"

namespace turnpoint::cli {

namespace map_command {

struct Options {
  std::string rig, calibration, edge = "turning", model, plot;
  std::vector<double> boundaries_mm, frequencies_Hz;
  double tolerance_mm = 0;
  bool budget = false;
};

using core::number;
using physics::name;

std::string with_unit(double value, physics::Parameter parameter) {
  const auto unit = physics::unit(parameter);
  return number(value / unit.size, 3) + (unit.name.empty() ? "" : " " + std::string(unit.name));
}

Json to_json(const physics::BoundaryBudget& budget) {
  Json list = Json::array();
  for (const auto& c : budget.contributions)
    list.push_back({{"parameter", name(c.parameter)},
                    {"sd", json_number(c.sd / physics::unit(c.parameter).size)},
                    {"unit", physics::unit(c.parameter).name},
                    {"moved_mm", json_number(c.moved_m * 1e3)},
                    {"left_mm", json_number(c.left_m * 1e3)}});
  return {{"total_mm", json_number(budget.total_m * 1e3)}, {"contributions", list}};
}

void print(std::ostream& out, const physics::MapAnswer& answer, const physics::BoundaryBudget& budget,
           bool calibrated) {
  if (budget.contributions.empty()) {
    fmt::print(out,
               "\nThe rig file states no standard deviations, so the boundary's uncertainty is not known.\n");
    return;
  }
  fmt::print(out, "\nBoundary at {} mm: uncertain by {} mm (one standard deviation)\n",
             number(*answer.boundary_m * 1e3, 5), number(budget.total_m * 1e3, 3));
  fmt::print(out, "{:>14} {:>16} {:>14} {:>24}\n", "parameter", "deviation", "moves it, mm",
             "left if it were exact, mm");
  for (const auto& c : budget.contributions)
    fmt::print(out, "{:>14} {:>16} {:>14} {:>24}\n", name(c.parameter), with_unit(c.sd, c.parameter),
               number(c.moved_m * 1e3, 3), number(c.left_m * 1e3, 3));
  const auto& best = budget.contributions.front();
  fmt::print(
      out, "Of these, measuring the {} would help most: {} mm would be left. {}\n", name(best.parameter),
      number(best.left_m * 1e3, 3),
      calibrated
          ? "The parameters' errors cancel in part, because measured boundaries determined them together."
          : "Measured boundaries help more, because they include all of these (turnpoint calibrate "
            "--boundaries).");
}

Json to_json(const std::optional<scene::FingerShift>& shift) {
  if (!shift) return nullptr;
  return {{"shift_mm", json_number(shift->shift_m * 1e3)},
          {"range_mm", {json_number(shift->least_m * 1e3), json_number(shift->most_m * 1e3)}}};
}

void print(std::ostream& out, const std::optional<scene::FingerShift>& shift) {
  if (shift)
    fmt::print(out,
               "A moving finger displaces this edge by {} mm (people differ: {} to {} mm); this is not part "
               "of the uncertainty.\n",
               number(shift->shift_m * 1e3, 3), number(shift->least_m * 1e3, 3),
               number(shift->most_m * 1e3, 3));
}

constexpr std::size_t most_lines = 6;  ///< most lines in the plot; more would repeat the colours and dashes

/// Plots the largest contributions to the uncertainty, for all boundaries that the rig can present.
report::Figure figure_of(const rig::Rig& rig, const physics::Surface& surface,
                         const physics::BoundaryMap& map, const std::vector<physics::MapAnswer>& answers) {
  constexpr int points = 60;
  const double low_Hz = scene::lowest_frequency(rig, 0),
               high_Hz = scene::highest_frequency(rig, core::kHighestShareOfRate * rig.output.rate_Hz);
  report::Line total;
  total.name = "total", total.series = report::kNeutral;
  std::map<physics::Parameter, report::Line> lines;
  for (int i = 0; i <= points; ++i) {
    const double f = low_Hz + (high_Hz - low_Hz) * i / points;
    const auto x = map.boundary_m(f);
    if (!x) continue;
    const auto budget = physics::boundary_budget(surface, f, *x);
    total.x.push_back(*x * 1e3), total.y.push_back(budget.total_m * 1e3);
    for (const auto& c : budget.contributions) {
      auto& line = lines[c.parameter];
      line.name = name(c.parameter);
      line.x.push_back(*x * 1e3), line.y.push_back(std::abs(c.moved_m) * 1e3);
    }
  }
  if (total.x.size() < 2 || lines.empty())
    throw UsageError(
        "map: --plot needs standard deviations in the rig file, and boundaries that the rig can present");
  auto heights = total.y;
  heights.push_back(0);
  report::Chart chart{"Uncertainty of the boundary",
                      report::fitted("Boundary (mm)", total.x, 0),
                      report::fitted("One standard deviation (mm)", heights),
                      {}};
  for (const auto& answer : answers)
    if (answer.boundary_m)
      chart.layers.push_back(report::Rule{report::Rule::Direction::vertical, *answer.boundary_m * 1e3, ""});
  std::vector<report::Line> largest;
  for (auto& [parameter, line] : lines) largest.push_back(std::move(line));
  const auto top = [](const report::Line& line) { return *std::max_element(line.y.begin(), line.y.end()); };
  std::stable_sort(largest.begin(), largest.end(),
                   [&](const auto& a, const auto& b) { return top(a) > top(b); });
  largest.resize(std::min(largest.size(), most_lines));
  for (std::size_t k = 0; k < largest.size(); ++k) {
    largest[k].series = static_cast<int>(k);
    chart.layers.push_back(std::move(largest[k]));
  }
  chart.layers.push_back(total);
  report::Figure figure;
  figure.title = "Uncertainty of the boundary, " + rig.name;
  figure.charts = {std::move(chart)};
  figure.chart_width_px = 620, figure.chart_height_px = 400;
  return figure;
}

Json to_json(const physics::MapAnswer& answer) {
  return {{"boundary_mm", json_number(answer.boundary_m, 1e3)},
          {"frequency_Hz", json_number(answer.frequency_Hz)},
          {"edge", physics::format(answer.edge)},
          {"model", physics::name(answer.model)},
          {"error_bound_mm", json_number(answer.error_bound_m * 1e3)},
          {"uncertainty_mm", json_number(answer.uncertainty_m * 1e3)},
          {"mm_per_Hz", json_number(answer.m_per_Hz * 1e3)},
          {"shear_shift_mm", json_number(answer.shear_shift_m, 1e3)},
          {"reason", answer.reason},
          {"warnings", json_warnings(answer.warnings)}};
}

void print(std::ostream& out, const std::vector<physics::MapAnswer>& answers) {
  fmt::print(out, "{:>12} {:>14} {:>8} {:>8} {:>10} {:>8} {:>12}  {}\n", "boundary mm", "frequency Hz",
             "edge", "model", "bound mm", "SD mm", "mm per kHz", "reason");
  for (const auto& a : answers) {
    fmt::print(out, "{:>12} {:>14} {:>8} {:>8} {:>10} {:>8} {:>12}  {}\n",
               a.boundary_m ? number(*a.boundary_m * 1e3, 7) : "none",
               a.frequency_Hz ? number(*a.frequency_Hz, 8) : "none", physics::format(a.edge),
               physics::name(a.model), number(a.error_bound_m * 1e3, 3), number(a.uncertainty_m * 1e3, 3),
               number(a.m_per_Hz * 1e6, 4), a.reason);
    for (const auto& warning : a.warnings) fmt::print(out, "{:>14}{}\n", "warning: ", warning.text);
  }
}

void map(const Options& options, Context& context) {
  if (options.boundaries_mm.empty() == options.frequencies_Hz.empty())
    throw UsageError("map: give either --boundary or --frequency");
  if (!options.plot.empty() && !options.budget) throw UsageError("map: --plot needs --budget");
  for (const double at : options.boundaries_mm)
    if (!std::isfinite(at)) throw UsageError(fmt::format("map: --boundary {}; a number of mm is needed", at));
  const auto rig = session::calibrated_rig(session::rig_or_default(options.rig, context.err),
                                           options.calibration, context.err);
  physics::MapOptions wanted;
  wanted.edge = physics::parse_edge(options.edge);
  if (!options.model.empty()) wanted.model = physics::parse_model(options.model);
  if (options.tolerance_mm > 0) wanted.tolerance_m = options.tolerance_mm * 1e-3;
  if (wanted.edge.kind == physics::Edge::Kind::friction)
    wanted.friction = physics::FrictionContext{rig::friction_of(rig), 1e-6, rig.friction.fingertip_m};
  const auto surface = rig::surface_of(rig);
  std::vector<physics::MapAnswer> answers;
  for (const double mm : options.boundaries_mm)
    answers.push_back(physics::answer_at_boundary(surface, wanted, mm * 1e-3));
  if (!options.frequencies_Hz.empty()) {
    const physics::BoundaryMap boundary_map(surface, wanted);
    for (const double f : options.frequencies_Hz) answers.push_back(boundary_map.at_frequency(f));
  }
  if (!options.plot.empty())
    system::write_file(options.plot, report::render(figure_of(
                                         rig, surface, physics::BoundaryMap(surface, wanted), answers)));
  const auto budget_of = [&](const physics::MapAnswer& a) {
    return physics::boundary_budget(surface, *a.frequency_Hz, *a.boundary_m);
  };
  const auto has_budget = [&](const physics::MapAnswer& a) {
    return options.budget && a.frequency_Hz && a.boundary_m;
  };
  if (!context.json) {
    print(context.out, answers);
    for (const auto& answer : answers)
      if (has_budget(answer)) {
        print(context.out, answer, budget_of(answer), !surface.correlations.empty());
        print(context.out, scene::finger_shift(rig, *answer.frequency_Hz, wanted.edge));
      }
    return;
  }
  Json list = Json::array();
  for (const auto& answer : answers) {
    list.push_back(to_json(answer));
    if (!has_budget(answer)) continue;
    list.back()["budget"] = to_json(budget_of(answer));
    list.back()["finger"] = to_json(scene::finger_shift(rig, *answer.frequency_Hz, wanted.edge));
  }
  print_json(context.out, list);
}

}  // namespace map_command

void add_map(CommandLine& app, Context& context) {
  using namespace map_command;
  auto options = std::make_shared<Options>();
  auto* command =
      app.add_subcommand("map", "Convert boundaries to frequencies, or frequencies to boundaries");
  add_rig(*command, options->rig);
  add_calibration(*command, options->calibration);
  command->add_option("--boundary", options->boundaries_mm, "Boundaries in mm from the wide end");
  command->add_option("--frequency", options->frequencies_Hz, "Frequencies in Hz");
  command
      ->add_option("--edge", options->edge,
                   "Definition of the boundary: turning | peak | p70 | p50 | p25 | p10 | friction=0.7")
      ->capture_default_str();
  command->add_option("--model", options->model,
                      "Physical model to use; by default the cheapest one that meets the tolerance");
  command->add_option("--tolerance-mm", options->tolerance_mm, "Largest allowed error in mm")
      ->check(positive());
  command->add_flag("--budget", options->budget,
                    "Also show how far each uncertain parameter of the rig moves each boundary, and which "
                    "measurement would help most");
  command
      ->add_option("--plot", options->plot,
                   "With --budget: SVG file that plots this for all boundaries that the rig can present")
      ->value("FILE");
  add_json(*command, context);
  command->footer("Example: turnpoint map --boundary 150 200 --edge p50 --budget");
  command->callback([options, &context] { with_users_numbers([&] { map(*options, context); }); });
}

}  // namespace turnpoint::cli

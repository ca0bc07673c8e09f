#include <fmt/format.h>
#include <fmt/ostream.h>

#include <memory>

#include "physics/boundary_map.hpp"
#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/planner.hpp"
#include "station/text/number.hpp"

namespace turnpoint::cli {

namespace map_command {

struct Options {
  std::string rig, edge = "turning", model;
  std::vector<double> boundaries_mm, frequencies_Hz;
  double tolerance_mm = 0;
};

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
  using text::number;
  fmt::print(out, "{:>12} {:>14} {:>8} {:>8} {:>10} {:>12}  {}\n", "boundary mm", "frequency Hz", "edge",
             "model", "bound mm", "mm per kHz", "reason");
  for (const auto& a : answers) {
    fmt::print(out, "{:>12} {:>14} {:>8} {:>8} {:>10} {:>12}  {}\n",
               a.boundary_m ? number(*a.boundary_m * 1e3, 7) : "none",
               a.frequency_Hz ? number(*a.frequency_Hz, 8) : "none", physics::format(a.edge),
               physics::name(a.model), number(a.error_bound_m * 1e3, 3), number(a.m_per_Hz * 1e6, 4),
               a.reason);
    for (const auto& warning : a.warnings) fmt::print(out, "{:>14}{}\n", "warning: ", warning.text);
  }
}

void map(const Options& options, Context& context) {
  if (options.boundaries_mm.empty() == options.frequencies_Hz.empty())
    throw UsageError("map: give either --boundary or --frequency");
  const auto rig = rig::load(options.rig);
  physics::MapOptions wanted;
  wanted.edge = physics::parse_edge(options.edge);
  if (!options.model.empty()) wanted.model = physics::parse_model(options.model);
  if (options.tolerance_mm > 0) wanted.tolerance_m = options.tolerance_mm * 1e-3;
  if (wanted.edge.kind == physics::Edge::Kind::friction)
    wanted.friction = physics::FrictionContext{scene::friction_of(rig), 1e-6, rig.friction.fingertip_m};
  const physics::BoundaryMap boundary_map(scene::surface_of(rig), wanted);
  std::vector<physics::MapAnswer> answers;
  for (const double mm : options.boundaries_mm) answers.push_back(boundary_map.at_boundary(mm * 1e-3));
  for (const double f : options.frequencies_Hz) answers.push_back(boundary_map.at_frequency(f));
  if (!context.json) return print(context.out, answers);
  Json list = Json::array();
  for (const auto& answer : answers) list.push_back(to_json(answer));
  context.out << list.dump(2) << "\n";
}

}  // namespace map_command

void add_map(CommandLine& app, Context& context) {
  using namespace map_command;
  auto options = std::make_shared<Options>();
  auto* command =
      app.add_subcommand("map", "Convert boundaries to frequencies, or frequencies to boundaries");
  command->add_option("--rig", options->rig, "Rig file")->required();
  command->add_option("--boundary", options->boundaries_mm, "Boundaries in mm from the wide end");
  command->add_option("--frequency", options->frequencies_Hz, "Frequencies in Hz");
  command->add_option("--edge", options->edge, "turning | peak | p70 | p50 | p25 | p10 | friction=0.7")
      ->capture_default_str();
  command->add_option("--model", options->model,
                      "Physical model to use; by default the cheapest one that meets the tolerance");
  command->add_option("--tolerance-mm", options->tolerance_mm, "Largest allowed error in mm")
      ->check(positive());
  add_json(*command, context);
  command->footer("Example: turnpoint map --rig deploy/rigs/simulated.toml --boundary 150 200 --edge p50");
  command->callback([options, &context] { with_users_numbers([&] { map(*options, context); }); });
}

}  // namespace turnpoint::cli

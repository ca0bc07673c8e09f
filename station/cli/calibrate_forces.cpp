#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <iostream>

#include "station/cli/calibrate_sensors.hpp"
#include "station/cli/json.hpp"
#include "station/maintenance/force_weights.hpp"
#include "station/text/number.hpp"

namespace turnpoint::cli {

namespace calibrate_forces_command {

using maintenance::ForceResult;
using text::number;

/// Asks the operator to place a weight. The operator types an empty line when the weight stands, or "s" to
/// leave this step out. Returns false for "s".
bool stands(std::istream& in, std::ostream& out, const maintenance::WeightStep& step) {
  if (!step.remark.empty() && step.tare) fmt::print(out, "{}\n", texts::say(step.remark, "en"));
  fmt::print(out, "{} {} (s: leave this step out) ", texts::say(step.text(), "en"),
             step.tap == maintenance::Tap::none ? "Then press Enter" : "Enter begins the reading");
  out.flush();
  std::string line;
  if (!std::getline(in, line))
    throw UsageError("calibrate: --forces asks for weights; the input ended before the last one");
  if (line != "" && line != "s")
    throw UsageError("calibrate: --forces understands an empty line and \"s\", not \"" + line + "\"");
  return line.empty();
}

bool again(std::istream& in, std::ostream& out, const std::string& why) {
  fmt::print(out, "{}\nRepair it and press Enter to read again (q: give up) ", why);
  out.flush();
  std::string line;
  return std::getline(in, line) && line != "q";
}

void print(std::ostream& out, const ForceResult& result) {
  fmt::print(out, "\n  mass   at       pull     residual: normal   lateral   position\n");
  for (std::size_t k = 0; k < result.steps.size(); ++k) {
    const auto& step = result.steps[k];
    const auto& rest = result.residuals[k];
    fmt::print(out, "{:5.0f} g {:4.0f} mm {:7.0f} g {:15.2f} mN {:6.2f} mN {:7.2f} mm\n", step.mass_g,
               step.position_mm, step.pull_g, 1e3 * rest.normal_N, 1e3 * rest.lateral_N, rest.position_mm);
  }
  for (const auto& step : result.repeated)
    fmt::print(out, "weighed again: {}\n", texts::say(step.name(), "en"));
  const auto share = [](double misfit) { return number(misfit, 2); };
  fmt::print(
      out,
      "residuals divided by the errors expected from weights, places and pulley: normal {}, lateral {}, "
      "moment {}{}\n",
      share(result.misfit[0]), share(result.misfit[1]), share(result.misfit[2]),
      *std::max_element(result.misfit.begin(), result.misfit.end()) > 3
          ? "; that is much: the weights or their places are not known well, and the uncertainty is larger"
          : "");
  fmt::print(out, "largest change of the zero reading: {} mN\n", number(result.zero_moved_mN, 2));
  if (result.resonance_Hz)
    fmt::print(out,
               "lowest resonance of the plate on its cells: {} Hz; usable_Hz = {}: faster changes of force "
               "are not measured correctly\n",
               number(*result.resonance_Hz, 3), number(result.cells.usable_Hz.value(), 3));
  else
    fmt::print(out, "usable_Hz is not known, because a tap was left out or the plate did not ring\n");
  fmt::print(out,
             "uncertainty (one standard deviation, for a finger in the middle with 0.5 N normal and 0.25 N "
             "lateral force): "
             "normal force {} mN, "
             "lateral force {} mN, position {} mm, friction {}\n",
             number(1e3 * result.sd.normal_N, 2), number(1e3 * result.sd.lateral_N, 2),
             number(result.sd.position_mm, 2), number(result.sd.friction, 2));
}

Json to_json(const ForceResult& result, const std::string& out) {
  Json json{{"file", out},
            {"zero_moved_mN", json_number(result.zero_moved_mN)},
            {"resonance_Hz", result.resonance_Hz ? Json(json_number(*result.resonance_Hz)) : Json()},
            {"usable_Hz", result.cells.usable_Hz ? Json(json_number(*result.cells.usable_Hz)) : Json()},
            {"misfit", {result.misfit[0], result.misfit[1], result.misfit[2]}},
            {"uncertainty",
             {{"normal_N", json_number(result.sd.normal_N)},
              {"lateral_N", json_number(result.sd.lateral_N)},
              {"position_mm", json_number(result.sd.position_mm)},
              {"friction", json_number(result.sd.friction)}}},
            {"repeated", Json::array()},
            {"weights", Json::array()}};
  for (const auto& step : result.repeated) json["repeated"].push_back(texts::say(step.name(), "en"));
  for (std::size_t k = 0; k < result.steps.size(); ++k)
    json["weights"].push_back({{"mass_g", result.steps[k].mass_g},
                               {"pull_g", result.steps[k].pull_g},
                               {"position_mm", json_number(result.steps[k].position_mm)},
                               {"residual_normal_N", json_number(result.residuals[k].normal_N)},
                               {"residual_lateral_N", json_number(result.residuals[k].lateral_N)},
                               {"residual_position_mm", json_number(result.residuals[k].position_mm)}});
  return json;
}

}  // namespace calibrate_forces_command

void calibrate_forces(const SensorOptions& options, const rig::Rig& rig, Context& context) {
  using namespace calibrate_forces_command;
  const auto bridges = maintenance::open_bridges(rig);
  const auto result = maintenance::weigh(
      rig, *bridges, [&](const auto& step) { return stands(std::cin, context.err, step); },
      [&](const auto& why) { return again(std::cin, context.err, texts::say(why, "en")); });
  const auto out = maintenance::write_forces(rig, result.cells, options.out);
  if (context.json) {
    context.out << to_json(result, out).dump(2, ' ', false, kInvalidBytes) << "\n";
    return;
  }
  print(context.out, result);
  fmt::print(context.out, "wrote {}\n", out);
}

}  // namespace turnpoint::cli

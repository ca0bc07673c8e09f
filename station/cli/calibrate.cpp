#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>

#include "physics/boundary_budget.hpp"
#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/run.hpp"
#include "station/cli/screens.hpp"
#include "station/cli/shared_options.hpp"
#include "station/core/number.hpp"
#include "station/maintenance/calibrate.hpp"
#include "station/maintenance/force_weights.hpp"
#include "station/maintenance/pick_up_sweep.hpp"
#include "station/rig/apply.hpp"
#include "station/rig/rig.hpp"
#include "station/session/session.hpp"
#include "station/session/stage.hpp"
#include "station/system/write_file.hpp"

namespace turnpoint::cli {

/// Options of `turnpoint calibrate` for the sensors of a rig. The last five members are copies of options
/// that all kinds of `turnpoint calibrate` share.
struct SensorOptions {
  bool pick_up = false, forces = false;
  std::string sensor = "patch", vibrometer, accelerometer;
  double instrument_percent = 5;
  double full_scale = 0.1, table_full_scale = 1;
  bool arm = false;
  std::string rig_path, out;
};

void add_sensor_options(Command& command, SensorOptions& options);

/// Carries out `turnpoint calibrate --pickup`: plays a sweep, fits the responses of the pick-ups, and writes
/// the calibration file.
void calibrate_pick_ups(const SensorOptions& options, const rig::Rig& rig, Context& context);

/// Carries out `turnpoint calibrate --forces`: asks for dead weights on the terminal, and writes the
/// calibration file.
void calibrate_forces(const SensorOptions& options, const rig::Rig& rig, Context& context);

namespace calibrate_sensors_command {

using core::number;

Json to_json(const rig::PickUp& pick_up) {
  Json json{{"channel", pick_up.response.channel},
            {"drive_channel", pick_up.response.drive_channel},
            {"response_sd", json_number(pick_up.response_sd)},
            {"resonances", Json::array()},
            {"scale", nullptr}};
  for (const auto& r : pick_up.resonances)
    json["resonances"].push_back({{"frequency_Hz", json_number(r.frequency_Hz)},
                                  {"frequency_sd_Hz", json_number(r.frequency_sd_Hz)},
                                  {"quality_factor", json_number(r.quality_factor)},
                                  {"quality_sd", json_number(r.quality_sd)}});
  if (const auto& scale = pick_up.scale)
    json["scale"] = {{"sensor", std::string(name(scale->sensor))},
                     {"um_per_full_scale", json_number(scale->um_per_full_scale)},
                     {"at_Hz", json_number(scale->at_Hz)},
                     {"exponent", json_number(scale->exponent)},
                     {"sd", json_number(scale->sd)}};
  return json;
}

void print(std::ostream& out, const rig::PickUp& pick_up) {
  const auto& points = pick_up.response.points;
  fmt::print(
      out,
      "pick-up on channel {}, output channel {}: {} to {} kHz, uncertainty {} % of the largest response\n",
      pick_up.response.channel, pick_up.response.drive_channel, number(1e-3 * points.front().frequency_Hz, 4),
      number(1e-3 * points.back().frequency_Hz, 4), number(100 * pick_up.response_sd, 2));
  for (const auto& r : pick_up.resonances)
    fmt::print(out, "  resonance {} +- {} Hz, quality factor {} +- {}\n", number(r.frequency_Hz, 6),
               number(r.frequency_sd_Hz, 2), number(r.quality_factor, 4), number(r.quality_sd, 2));
  if (const auto& scale = pick_up.scale)
    fmt::print(out,
               "  scale: {} um for full scale at {} kHz, proportional to frequency to the power {}; "
               "uncertainty {} % (one standard deviation)\n",
               number(scale->um_per_full_scale, 4), number(1e-3 * scale->at_Hz, 4),
               number(-scale->exponent, 3), number(100 * scale->sd, 2));
  else
    fmt::print(out, "  scale: not measured here; levels are relative\n");
}

}  // namespace calibrate_sensors_command

void add_sensor_options(Command& command, SensorOptions& options) {
  command.add_flag("--pickup", options.pick_up,
                   "Sweep each transducer, and fit the response of the pick-ups to what they capture");
  command.add_flag("--forces", options.forces,
                   "Calibrate the force cells with dead weights; asks for each weight and waits for Enter");
  command
      .add_option("--sensor", options.sensor,
                  "With --pickup: patch (a piezo patch; its table needs 5 frequencies) | accelerometer (one "
                  "frequency is enough)")
      ->capture_default_str()
      ->check(one_of({"patch", "accelerometer"}));
  command
      .add_option(
          "--vibrometer", options.vibrometer,
          "With --pickup: CHANNEL=FILE, a table of the displacement at the pick-up on this captured channel "
          "(columns frequency_Hz,displacement_um), measured while driving at --full-scale")
      ->value("CHANNEL=FILE");
  command
      .add_option("--accelerometer", options.accelerometer,
                  "Like --vibrometer, with columns frequency_Hz,acceleration_m_s2")
      ->value("CHANNEL=FILE");
  command
      .add_option("--instrument-sd", options.instrument_percent,
                  "Standard deviation of the instrument that measured the table, in percent")
      ->capture_default_str()
      ->check(range(0, 100));
}

void calibrate_pick_ups(const SensorOptions& options, const rig::Rig& rig, Context& context) {
  using namespace calibrate_sensors_command;
  if (rig.capture && !session::simulates_capture(rig) && !options.arm)
    throw UsageError(
        "calibrate: --pickup plays a sweep through the amplifier; make sure that nobody touches the surface, "
        "and add --arm");
  maintenance::PickUpOptions plan;
  plan.full_scale = options.full_scale, plan.table_full_scale = options.table_full_scale;
  plan.sensor = rig::find_sensor(options.sensor).value();
  plan.vibrometer = options.vibrometer, plan.accelerometer = options.accelerometer;
  plan.instrument_sd = 1e-2 * options.instrument_percent;
  const auto made = maintenance::with_pick_ups(rig, maintenance::calibrate_pick_ups(rig, plan), options.out);
  const auto out = options.out.empty() ? rig::file_for(options.rig_path, rig::today()) : options.out;
  maintenance::write_calibration(made, rig, out);
  if (context.json) {
    Json json{{"file", out}, {"pick_ups", Json::array()}};
    for (const auto& pick_up : made.pick_ups) json["pick_ups"].push_back(to_json(pick_up));
    print_json(context.out, json);
    return;
  }
  for (const auto& pick_up : made.pick_ups) print(context.out, pick_up);
  fmt::print(context.out, "wrote {}\n", out);
}

namespace calibrate_forces_command {

using core::number;
using maintenance::ForceResult;

/// Asks the operator to place a weight. The operator types an empty line when the weight stands, or "s" to
/// leave this step out. Returns false for "s".
bool stands(std::istream& in, std::ostream& out, const maintenance::WeightStep& step) {
  if (!step.remark.empty() && step.tare) fmt::print(out, "{}\n", core::say(step.remark, "en"));
  fmt::print(out, "{} {} (s: leave this step out) ", core::say(step.text(), "en"),
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
    fmt::print(out, "weighed again: {}\n", core::say(step.name(), "en"));
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
  for (const auto& step : result.repeated) json["repeated"].push_back(core::say(step.name(), "en"));
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
      [&](const auto& why) { return again(std::cin, context.err, core::say(why, "en")); });
  const auto out = maintenance::write_forces(rig, result.cells, options.out);
  if (context.json) {
    print_json(context.out, to_json(result, out));
    return;
  }
  print(context.out, result);
  fmt::print(context.out, "wrote {}\n", out);
}

namespace calibrate_command {

using core::number;
using rig::BoundaryFit;

struct Options {
  std::string rig, out, plots, edge = "p50", note, boundaries, friction, sound, sweep_out;
  std::vector<std::string> sweeps;
  double full_scale = 1;
  int valid_days = 90;
  bool sweep = false, arm = false, panel = false;
  SensorOptions sensors;
  std::string reference = "button";
  maintenance::SweepOptions plan;
};

rig::Measurements measurements_of(const Options& options) {
  rig::Measurements measurements;
  for (const auto& sweep : options.sweeps) {
    const auto equals = sweep.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == sweep.size())
      throw UsageError("calibrate: --response " + sweep + "; write TRANSDUCER=FILE.csv");
    measurements.sweeps.push_back({sweep.substr(0, equals), sweep.substr(equals + 1), options.full_scale});
  }
  measurements.boundaries_csv = options.boundaries;
  measurements.friction_csv = options.friction;
  measurements.sound_csv = options.sound;
  measurements.edge = options.edge;
  if (options.sweeps.empty() && options.boundaries.empty() && options.friction.empty() &&
      options.sound.empty())
    throw UsageError(
        "calibrate: no measurements were given; use --response, --boundaries, --friction or --sound (or "
        "--sweep for a list of test tones)");
  return measurements;
}

Json boundary_json(const BoundaryFit& fit) {
  Json parameters = Json::array(), points = Json::array();
  for (const auto& p : fit.surface.parameters)
    parameters.push_back({{"parameter", p.name},
                          {"change", json_number(p.change)},
                          {"sd", json_number(p.sd)},
                          {"stated_sd", json_number(p.stated_sd)}});
  for (const auto& p : fit.points)
    points.push_back({{"frequency_Hz", json_number(p.frequency_Hz)},
                      {"boundary_mm", json_number(1e3 * p.boundary_m)},
                      {"sd_mm", json_number(1e3 * p.sd_m)},
                      {"residual_mm", json_number(1e3 * p.residual_m)},
                      {"deviation", json_number(p.deviation)},
                      {"outlier", p.outlier},
                      {"left_out", p.left_out}});
  return {{"edge", fit.edge}, {"parameters", parameters}, {"points", points}};
}

void print(std::ostream& out, const BoundaryFit& fit) {
  constexpr double surprising = 3;
  fmt::print(out, "boundaries ({} edge), {} measured:\n", fit.edge, fit.points.size());
  for (const auto& p : fit.points)
    fmt::print(out, "  {} kHz: {} mm, {} mm from the fit{}\n", number(p.frequency_Hz * 1e-3, 5),
               number(1e3 * p.boundary_m, 5), number(1e3 * p.residual_m, 2),
               p.outlier
                   ? fmt::format("; OUTLIER, {} deviations from where the others put it{}: measure it again",
                                 number(std::abs(p.deviation), 2), p.left_out ? ", left out of the fit" : "")
                   : "");
  for (const auto& p : fit.surface.parameters) {
    const auto parameter = *physics::find_parameter(p.name);
    const auto unit = physics::unit(parameter);
    fmt::print(out, "  {}: changed by {} {} (SD {}; {} in the rig file){}\n", p.name,
               number(p.change / unit.size, 3), unit.name, number(p.sd / unit.size, 2),
               number(p.stated_sd / unit.size, 2),
               std::abs(p.change) > surprising * p.stated_sd
                   ? "; that is much: check plate_theory and the rig file"
                   : "");
  }
}

Json to_json(const rig::Calibration& c, const std::string& out, const std::string& plots) {
  Json json{{"file", out}, {"plots", plots}, {"made_on", c.made_on}, {"valid_days", c.valid_days}};
  json["transducers"] = Json::array();
  for (const auto& t : c.transducers)
    json["transducers"].push_back({{"name", t.name},
                                   {"low_Hz", t.response.low_Hz},
                                   {"high_Hz", t.response.high_Hz},
                                   {"residual_dB", json_number(t.response.residual_dB)}});
  json["quality_factor"] = c.quality_factor ? json_number(*c.quality_factor) : Json();
  if (c.boundary) json["boundary"] = boundary_json(*c.boundary);
  return json;
}

void print(std::ostream& out, const rig::Calibration& c) {
  for (const auto& t : c.transducers)
    fmt::print(out, "{}: usable from {} to {} kHz (within {} dB), residual {} dB\n", t.name,
               number(t.response.low_Hz * 1e-3, 5), number(t.response.high_Hz * 1e-3, 5),
               number(rig::equalisation_cap_dB), number(t.response.residual_dB, 2));
  if (c.quality_factor) fmt::print(out, "quality factor {}\n", number(*c.quality_factor, 3));
  if (c.boundary) print(out, *c.boundary);
  if (c.friction)
    fmt::print(out, "friction: {} points, residual {}\n", c.friction->points.size(),
               number(c.friction->residual, 2));
  if (!c.sound.empty()) fmt::print(out, "sound: {} levels\n", c.sound.size());
}

void sweep(const Options& options, const rig::Rig& rig, Context& context) {
  const auto steps = maintenance::sweep_plan(rig, options.plan);
  if (options.sweep_out.empty()) {
    context.out << maintenance::to_csv(steps);
    return;
  }
  if (options.sweep_out.starts_with("alsa:") && !options.arm)
    throw UsageError(
        "calibrate: --sweep-out " + options.sweep_out +
        " plays through the amplifier; make sure that nobody touches the surface, and add --arm");
  maintenance::play_sweep(rig, steps, options.sweep_out);
  const double length_s = steps.back().start_s + steps.back().length_s;
  fmt::print(context.err, "{} tones, {} s, to {}\n", steps.size(), number(length_s, 4), options.sweep_out);
}

Json delay_json(const std::optional<rig::Delay>& delay) {
  if (!delay) return {};
  return {{"median_s", delay->median_s},
          {"jitter_s", delay->sd_s},
          {"pairs", delay->pairs},
          {"unmatched", delay->unmatched}};
}

void calibrate_panel(const Options& options, const rig::Rig& rig, Context& context) {
  const auto instead = "the latency of a touch panel can be measured on its screen only";
  if (!context.screens) return become_ui(context, instead);
  const auto reference =
      options.reference == "photodiode" ? rig::LatencyReference::photodiode : rig::LatencyReference::button;
  const auto measured = with_screen(instead, [&] {
    return context.screens->latency({options.rig, reference});
  });
  if (!measured) throw std::runtime_error("calibrate --panel: no result was accepted, so no file is written");
  const auto made = maintenance::with_panel(rig, *measured, options.out);
  const auto out = options.out.empty() ? rig::file_for(options.rig, rig::today()) : options.out;
  maintenance::write_calibration(made, rig, out);
  if (context.json) {
    const Json json{{"file", out},
                    {"quality", measured->quality},
                    {"response_offset", delay_json(made.panel->touch)},
                    {"flash", delay_json(made.panel->flash)}};
    print_json(context.out, json);
    return;
  }
  const auto say = [&](const char* what, const std::optional<rig::Delay>& delay) {
    if (delay)
      fmt::print(context.out, "{}: median {} ms, jitter (SD) {} ms, {} taps, {} unmatched\n", what,
                 number(1e3 * delay->median_s, 4), number(1e3 * delay->sd_s, 3), delay->pairs,
                 delay->unmatched);
  };
  say("response_offset", made.panel->touch);
  say("flash", made.panel->flash);
  fmt::print(context.out, "wrote {}\n", out);
}

void calibrate(const Options& options, Context& context) {
  const auto rig = rig::load(options.rig);
  if (options.sweep) return sweep(options, rig, context);
  // refuses to overwrite a calibration that must be kept before anything is measured
  static_cast<void>(maintenance::known_calibration(rig, options.out));
  if (options.panel) return calibrate_panel(options, rig, context);
  if (options.sensors.pick_up && options.sensors.forces)
    throw UsageError("calibrate: --pickup and --forces are two measurements; give one of them");
  if (options.sensors.pick_up || options.sensors.forces) {
    auto sensors = options.sensors;
    sensors.full_scale = options.plan.full_scale, sensors.table_full_scale = options.full_scale;
    sensors.arm = options.arm, sensors.rig_path = options.rig, sensors.out = options.out;
    return sensors.forces ? calibrate_forces(sensors, rig, context)
                          : calibrate_pick_ups(sensors, rig, context);
  }
  const auto measurements = measurements_of(options);
  auto made = maintenance::calibrate(rig, measurements, options.valid_days, options.note);
  maintenance::keep_devices(rig, made, options.out);
  const auto out = options.out.empty() ? rig::file_for(options.rig, made.made_on) : options.out;
  const auto plots = options.plots.empty() ? out + ".svg" : options.plots;
  if (plots == out) throw UsageError("calibrate: --plots and the calibration file must be two files: " + out);
  static_cast<void>(maintenance::usable_toml(made, rig));  // nothing is written if this throws
  system::write_file(plots, report::render(maintenance::calibration_figure(made, measurements)));
  maintenance::write_calibration(made, rig, out);
  if (context.json) {
    print_json(context.out, to_json(made, out, plots));
    return;
  }
  print(context.out, made);
  fmt::print(context.out, "wrote {} (valid for {} days) and {}\n", out, made.valid_days, plots);
}

}  // namespace calibrate_command

void add_calibrate(CommandLine& app, Context& context) {
  using namespace calibrate_command;
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand(
      "calibrate",
      "Make a calibration file from measurements of a rig; list or play the tones for the measurements");
  add_rig(*command, options->rig, "the rig that was measured")->required();
  command->add_option(
      "--response", options->sweeps,
      "TRANSDUCER=FILE: measurements by a vibrometer, with columns frequency_Hz,displacement_um,phase_deg");
  command
      ->add_option("--full-scale", options->full_scale,
                   "Amplitude of the drive signal during the measurement; 1 is full scale")
      ->capture_default_str();
  command
      ->add_option("--boundaries", options->boundaries,
                   "File with columns frequency_Hz,boundary_mm,sd_mm; sd_mm is the precision of the reading")
      ->value("FILE");
  command
      ->add_option("--edge", options->edge,
                   "The edge that was measured as boundary: turning | peak | p70 | p50 | p25 | p10")
      ->capture_default_str();
  command->add_option("--friction", options->friction, "File with columns displacement_um,relative_friction")
      ->value("FILE");
  command
      ->add_option("--sound", options->sound,
                   "File with columns frequency_Hz,level_dB (sound pressure level at full scale)")
      ->value("FILE");
  command->add_option("--valid-days", options->valid_days, "Days until the calibration expires")
      ->capture_default_str()
      ->check(range(1, 3650));
  command->add_option("--note", options->note,
                      "Note to store in the calibration file: instruments, temperature, operator");
  command
      ->add_option("--out", options->out,
                   "Calibration file to write; by default beside the rig file, with the date in its name, "
                   "where `run` finds it. If it exists, --pickup, --forces and --panel replace only what "
                   "they measure; other measurements replace all but the results of these three")
      ->value("FILE");
  command
      ->add_option("--plots", options->plots,
                   "SVG file with fits and residuals; by default beside the calibration file")
      ->value("FILE");
  command->add_flag(
      "--panel", options->panel,
      "Measure the latency of the touch panel, using one of the rig's button lines as the reference");
  command
      ->add_option("--reference", options->reference,
                   "button: a button pressed by the tapping finger; measures input latency | photodiode: a "
                   "photodiode on the flashing square; measures display latency")
      ->capture_default_str()
      ->check(one_of({"button", "photodiode"}));
  add_sensor_options(*command, options->sensors);
  command->add_flag("--sweep", options->sweep, "Print the tones of the test sweep as CSV");
  command->add_option("--sweep-out", options->sweep_out,
                      "With --sweep: play the sweep to wav:FILE or alsa:NAME");
  command->add_flag("--arm", options->arm,
                    "With --sweep-out alsa:..., or --pickup on a real rig: arm the amplifier");
  command->add_option("--points", options->plan.points, "Number of tones in the sweep, for each transducer")
      ->capture_default_str();
  command
      ->add_option("--amplitude", options->plan.full_scale,
                   "Amplitude of the sweep (also of --pickup), 1 is full scale")
      ->capture_default_str();
  add_json(*command, context);
  command->footer(
      "Example: turnpoint calibrate --rig simulated --sweep\n"
      "This lists the tones to measure. After measuring them: turnpoint calibrate --rig plate.toml "
      "--response "
      "main=sweep.csv --full-scale 0.1 --boundaries edges.csv --friction friction.csv");
  command->callback([options, &context] { calibrate(*options, context); });
}

}  // namespace turnpoint::cli

#include "station/cli/calibrate_sensors.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include "station/calibration/apply.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"
#include "station/maintenance/calibrate.hpp"
#include "station/maintenance/pick_up_sweep.hpp"
#include "station/session/session.hpp"
#include "station/session/stage.hpp"
#include "station/text/number.hpp"

namespace turnpoint::cli {

namespace calibrate_sensors_command {

using text::number;

Json to_json(const calibration::PickUp& pick_up) {
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

void print(std::ostream& out, const calibration::PickUp& pick_up) {
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
  plan.sensor = calibration::find_sensor(options.sensor).value();
  plan.vibrometer = options.vibrometer, plan.accelerometer = options.accelerometer;
  plan.instrument_sd = 1e-2 * options.instrument_percent;
  const auto made = maintenance::with_pick_ups(rig, maintenance::calibrate_pick_ups(rig, plan), options.out);
  const auto out =
      options.out.empty() ? calibration::file_for(options.rig_path, calibration::today()) : options.out;
  maintenance::write_calibration(made, rig, out);
  if (context.json) {
    Json json{{"file", out}, {"pick_ups", Json::array()}};
    for (const auto& pick_up : made.pick_ups) json["pick_ups"].push_back(to_json(pick_up));
    context.out << json.dump(2, ' ', false, kInvalidBytes) << "\n";
    return;
  }
  for (const auto& pick_up : made.pick_ups) print(context.out, pick_up);
  fmt::print(context.out, "wrote {}\n", out);
}

}  // namespace turnpoint::cli

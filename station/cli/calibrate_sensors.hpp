#pragma once
#include <string>

#include "station/cli/command.hpp"
#include "station/rig/rig.hpp"

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

}  // namespace turnpoint::cli

#pragma once
#include <functional>
#include <string>
#include <vector>

#include "station/rig/calibration.hpp"
#include "station/rig/rig.hpp"
#include "station/simulation/setup.hpp"

namespace turnpoint::maintenance {

/// Options for calibrating the pick-ups of a rig.
struct PickUpOptions {
  double full_scale = 0.1;  ///< amplitude of the sweep; 1 is full scale
  double low_Hz = 22000, high_Hz = 46000, length_s = 3;
  rig::PickUpSensor sensor = rig::PickUpSensor::patch;
  /// Measured displacements or accelerations, as CHANNEL=FILE with the pick-up's captured channel; "" if none
  /// were measured. The columns are frequency_Hz,displacement_um or frequency_Hz,acceleration_m_s2.
  std::string vibrometer, accelerometer;
  double table_full_scale = 1;  ///< amplitude of the drive while the table was measured; 1 is full scale
  double instrument_sd = 0.05;  ///< relative standard uncertainty of the instrument that measured the table
  /// Changes the simulated laboratory; for tests.
  std::function<void(simulation::Setup&)> laboratory;
};

/// Plays a sweep on each transducer, captures the pick-ups, and fits their responses. With a rig whose
/// [capture] is `sim:`, plate and pick-ups are simulated. With `alsa:`, the amplifier is armed, so only an
/// operator may request it. Throws core::UsageError for a rig without pick-ups, and if the measurements do
/// not allow a fit; core::BadInput for the table; std::runtime_error if frames were lost.
std::vector<rig::PickUp> calibrate_pick_ups(const rig::Rig& rig, const PickUpOptions& options);

/// Returns known_calibration() with these pick-ups.
rig::Calibration with_pick_ups(const rig::Rig& rig, std::vector<rig::PickUp> pick_ups,
                               const std::string& out = "");

}  // namespace turnpoint::maintenance

#pragma once
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "station/rig/fits.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::rig {

/// What a vibration sensor responds to, which decides how its sensitivity depends on frequency.
/// patch: a piezo patch that is bent with the surface; sensitivity is a power of frequency that must be
/// measured. accelerometer: sensitivity is proportional to the square of frequency.
enum class PickUpSensor { patch, accelerometer };
std::string_view name(PickUpSensor sensor);
std::optional<PickUpSensor> find_sensor(std::string_view name);

/// The displacement at a pick-up for a captured amplitude of full scale:
/// um_per_full_scale (frequency / at_Hz)^-exponent.
struct PickUpScale {
  PickUpSensor sensor = PickUpSensor::patch;
  double um_per_full_scale = 0;
  double at_Hz = 0;
  double exponent = 0;
  /// Relative standard deviation within the measured range of frequencies: the errors of the fit and of the
  /// instrument together.
  double sd = 0;

  double at(double frequency_Hz) const;
};

/// A pick-up's response to one output channel, as calibrated.
struct PickUp {
  PickUpResponse response;
  double response_sd = 0;  ///< standard deviation of the amplitudes, relative to the largest one; 0: unknown
  std::vector<Resonance> resonances;
  std::optional<PickUpScale> scale;  ///< empty if no displacement was measured
};

/// The measured response at one frequency: captured complex amplitude for a tone of full scale.
struct SweptPoint {
  double frequency_Hz = 0;
  std::complex<double> response;
};

/// Fits resonances to a sweep. The table of the result then contains the fitted values, which are less noisy.
/// If the residuals of the fit are above twice the noise, the table keeps the measured values. `noise` is the
/// rms error of one response (complex).
PickUp fit_pick_up(int channel, int drive_channel, const std::vector<SweptPoint>& sweep, double noise);

/// The displacement at one frequency for a drive of full scale, measured at the place of a pick-up.
struct DisplacementPoint {
  double frequency_Hz = 0;
  double um_per_full_scale = 0;
};

/// Computes the scale of a pick-up from measured displacements. `instrument_sd` is the relative standard
/// deviation that all of them share. A patch needs 5 frequencies, an accelerometer one. Throws
/// core::UsageError for fewer, for frequencies outside of the sweep, and if the displacements contradict the
/// shape of the response.
PickUpScale fit_scale(const PickUp& pick_up, PickUpSensor sensor, const std::vector<DisplacementPoint>& table,
                      double instrument_sd);

}  // namespace turnpoint::rig

#pragma once
#include <complex>
#include <optional>
#include <vector>

namespace turnpoint::sensing {

/// The response of a pick-up to one output channel, from the calibration: the captured complex amplitude,
/// relative to full scale, for a tone played at full scale, at ascending frequencies. It does not include the
/// loop delay. Values in between are interpolated by cubics through four points, separately for real and
/// imaginary part, so the phase must turn by less than about half a radian between neighbours.
struct Transfer {
  int drive_channel = 0;
  std::vector<double> frequency_Hz;
  std::vector<std::complex<double>> response;
};

/// A sensor that measures the vibration of the surface; it is captured on one channel.
struct PickUp {
  int channel = 0;
  std::vector<Transfer> transfers;  ///< responses to the output channels, at most one for each
};

/// The interpolated response to an output channel at a frequency; empty if the calibration does not cover it.
std::optional<std::complex<double>> response(const PickUp& pick_up, int drive_channel, double frequency_Hz);

/// The largest magnitude of all responses in the calibration of the pick-up.
double best_response(const PickUp& pick_up);

/// Delay of the vibration's envelope behind the drive (s), from the slope of the phase; 0 if the calibration
/// does not cover the frequency.
double group_delay_s(const PickUp& pick_up, int drive_channel, double frequency_Hz);

}  // namespace turnpoint::sensing

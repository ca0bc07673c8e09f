#pragma once
#include <complex>
#include <optional>
#include <vector>

namespace turnpoint::sensing {

/// What a pick-up measures per unit of drive, from the calibration: the captured complex amplitude (of full
/// scale of the capture) for a tone of full scale on one output channel, at rising frequencies. The delay of
/// the loop is not part of it. Values in between are interpolated by cubics through four points, separately
/// for both parts, so the phase must turn by less than about half a radian between neighbours.
struct Transfer {
  int drive_channel = 0;
  std::vector<double> frequency_Hz;
  std::vector<std::complex<double>> response;
};

/// A sensor of the vibration on one captured channel.
struct PickUp {
  int channel = 0;
  std::vector<Transfer> transfers;  ///< at most one per output channel
};

/// The interpolated response to an output channel at a frequency; none if the calibration does not cover it.
std::optional<std::complex<double>> response(const PickUp& pick_up, int drive_channel, double frequency_Hz);

/// The largest magnitude of a response in the calibration of the pick-up.
double best_response(const PickUp& pick_up);

/// Delay of the vibration's envelope behind the drive (s), from the slope of the phase; 0 if the calibration
/// does not cover the frequency.
double group_delay_s(const PickUp& pick_up, int drive_channel, double frequency_Hz);

}  // namespace turnpoint::sensing

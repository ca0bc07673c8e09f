#pragma once
#include <array>
#include <cstdint>

#include "station/simulation/noise.hpp"
#include "station/simulation/setup.hpp"

namespace turnpoint::simulation {

/// Returns the value that a converter with this many bits gives: rounded, and limited to full scale.
double converted(double full_scale, int bits);

/// Computes captured samples of the bridges and the reference from the cells' readings (N) and voltages.
class WiresModel {
 public:
  WiresModel(const Wires& wires, double volt_per_volt_N, int rate_Hz, std::uint64_t seed);

  /// Takes the excitation and the drive in the next frame, both in units of full scale and after the delay
  /// from playback to capture.
  void step(double excitation_full_scale, double drive_full_scale);

  double reference(std::int64_t frame, bool connected) const;
  /// Returns the captured sample of a bridge. `cell` is 0 for a, 1 for b, 2 for lateral. If a wire is open
  /// (`connected` is false), there is no force signal, but still crosstalk, noise and the excitation. The
  /// excitation gets through a capacitance of a few pF, so it comes a quarter period early.
  double bridge(int cell, double reading_N, std::int64_t frame, bool connected) const;
  /// Voltage (V) at an open wire per rate of change of the excitation (V/s).
  static constexpr double kOpenWire_s = 1.2e-8;

 private:
  Wires wires_;
  double volt_per_volt_N_;
  double rate_Hz_;
  double noise_V_;  // rms of one sample of noise at the bridge
  Noise reference_noise_;
  std::array<Noise, 3> bridge_noise_;
  double excitation_V_ = 0, last_excitation_V_ = 0, crosstalk_V_ = 0;
};

}  // namespace turnpoint::simulation

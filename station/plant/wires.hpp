#pragma once
#include <array>
#include <cstdint>

#include "station/plant/noise.hpp"
#include "station/plant/setup.hpp"

namespace turnpoint::plant {

/// The value that a converter of so many bits gives, within its range.
double converted(double full_scale, int bits);

/// The bridges and the reference: from readings (N) and voltages to captured samples.
class WiresModel {
 public:
  WiresModel(const Wires& wires, double volt_per_volt_N, int rate_Hz, std::uint64_t seed);

  /// Takes the excitation and the drive (full scale, as they arrive) of the next frame.
  void step(double excitation_full_scale, double drive_full_scale);

  double reference(std::int64_t frame, bool connected) const;
  /// `cell`: 0 a, 1 b, 2 lateral. An open wire brings no force: only the excitation, through a capacitance of
  /// a few pF and so a quarter period early, besides crosstalk and noise.
  double bridge(int cell, double reading_N, std::int64_t frame, bool connected) const;
  /// Voltage at an open wire per rate of change of the excitation.
  static constexpr double kOpenWire_s = 1.2e-8;

 private:
  Wires wires_;
  double volt_per_volt_N_;
  double rate_Hz_;
  double noise_V_;  // rms of one sample, at the bridge
  Noise reference_noise_;
  std::array<Noise, 3> bridge_noise_;
  double excitation_V_ = 0, last_excitation_V_ = 0, crosstalk_V_ = 0;
};

}  // namespace turnpoint::plant

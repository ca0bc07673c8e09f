#include "station/simulation/wires.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace turnpoint::simulation {

double converted(double full_scale, int bits) {
  const double steps = std::ldexp(1.0, bits - 1);
  return std::clamp(std::nearbyint(full_scale * steps), -steps, steps - 1) / steps;
}

WiresModel::WiresModel(const Wires& wires, double volt_per_volt_N, int rate_Hz, std::uint64_t seed)
    : wires_(wires),
      volt_per_volt_N_(volt_per_volt_N),
      rate_Hz_(rate_Hz),
      noise_V_(wires.noise_V_per_rtHz * std::sqrt(rate_Hz / 2.0)),
      reference_noise_(seed, 1),
      bridge_noise_{Noise(seed, 2), Noise(seed, 3), Noise(seed, 4)} {}

void WiresModel::step(double excitation_full_scale, double drive_full_scale) {
  last_excitation_V_ = excitation_V_;
  excitation_V_ = wires_.excitation_V_per_full_scale * excitation_full_scale;
  crosstalk_V_ = wires_.crosstalk_V_per_full_scale * drive_full_scale;
}

double WiresModel::reference(std::int64_t frame, bool connected) const {
  const double noise = wires_.converter_noise_full_scale * reference_noise_.at(frame);
  const double signal = connected ? excitation_V_ / wires_.reference_V_at_full_scale : 0;
  return converted(signal + noise, wires_.bits);
}

double WiresModel::bridge(int cell, double reading_N, std::int64_t frame, bool connected) const {
  const double signal_V = connected ? excitation_V_ * volt_per_volt_N_ * reading_N
                                    : kOpenWire_s * rate_Hz_ * (excitation_V_ - last_excitation_V_);
  const double noise_V = noise_V_ * bridge_noise_[static_cast<std::size_t>(cell)].at(frame);
  const double y = wires_.gain * (signal_V + crosstalk_V_ + noise_V);
  const double distorted = y + y * y * (wires_.a2_per_V + wires_.a3_per_V2 * y);
  return converted(distorted / wires_.full_scale_V, wires_.bits);
}

}  // namespace turnpoint::simulation

#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "station/sensing/carrier.hpp"

namespace turnpoint::sensing {

/// Computes from formulas what a codec captures of a reference and three bridges: excitation of 2.5 V, cells
/// of 10 N and 2 mV/V, amplifiers with gain 200, converter full scale 3 V.
struct BridgeSignal {
  double rate_Hz = 192000, carrier_Hz = 10525;
  /// Force (N) on every cell, as a function of time (s).
  std::function<double(double)> force_N = [](double) { return 0.0; };
  /// Force (N) on each cell, as a function of time (s). If set, it replaces force_N.
  std::function<std::array<double, bridge_count>(double)> forces_N;
  /// Factor by which the excitation is multiplied, as a function of time (s).
  std::function<double(double)> gain = [](double) { return 1.0; };
  double phase_rad = 0.4;       ///< phase of the carrier, the same on all channels
  double bridge_phase_rad = 0;  ///< phase of the bridge's resistive signal relative to the reference
  /// quadrature part of the ratio of bridge to reference, from unbalanced capacitance
  double quadrature_V_V = 0;
  std::vector<double> tones_Hz;  ///< drive tones that reach the bridges
  /// amplitude (V) of each tone at the bridge; coefficient of the cubic distortion of the amplifier's output
  double tone_V = 1e-3, cubic_per_V2 = 0;
  double noise_V_rtHz = 0;  ///< density of the noise at the bridge (V per square root of Hz)
  unsigned seed = 1;

  static constexpr double excitation_V = 2.5, volt_per_volt_N = 2e-4, amplifier = 200, full_scale_V = 3;
  static constexpr double reference_share = 0.5;  ///< amplitude of the reference, as a fraction of full scale

  std::vector<std::int32_t> frames(std::int64_t first, std::size_t count) const {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const double noise_V = noise_V_rtHz * std::sqrt(rate_Hz / 2);
    const double turn = 2 * std::numbers::pi;
    std::vector<std::int32_t> all;
    for (std::size_t n = 0; n < count; ++n) {
      const double t = static_cast<double>(first + static_cast<std::int64_t>(n)) / rate_Hz;
      const double angle = turn * std::fmod(carrier_Hz * t, 1.0) + phase_rad;
      double tones = 0;
      for (std::size_t i = 0; i < tones_Hz.size(); ++i)
        tones += tone_V * std::sin(turn * tones_Hz[i] * t + static_cast<double>(i));
      const double across = quadrature_V_V * -std::sin(angle + bridge_phase_rad);
      all.push_back(sample(reference_share * gain(t) * std::cos(angle)));
      std::array<double, bridge_count> forces{};
      if (forces_N)
        forces = forces_N(t);
      else
        forces.fill(force_N(t));
      for (const double force : forces) {
        const double in = volt_per_volt_N * force * std::cos(angle + bridge_phase_rad);
        const double bridge = excitation_V * gain(t) * (in + across) + tones;
        const double out = amplifier * (bridge + (noise_V > 0 ? noise_V * normal(random) : 0));
        all.push_back(sample((out + cubic_per_V2 * out * out * out) / full_scale_V));
      }
    }
    return all;
  }

  /// Force (N) at which the output of a bridge equals the reference (ratio 1).
  static constexpr double N_per_ratio =
      full_scale_V * reference_share / (amplifier * excitation_V * volt_per_volt_N);

  static std::int32_t sample(double share) {  // rounds to 24 bits
    return static_cast<std::int32_t>(std::lround(std::clamp(share, -1.0, 0.999999) * 0x1p23)) * 256;
  }
};

inline BridgeOptions bridge_options() {
  BridgeOptions options;
  options.full_scale.fill(10 / BridgeSignal::N_per_ratio);
  options.reference_amplitude = BridgeSignal::reference_share;
  return options;
}

/// Demodulates a capture that begins at playback frame `first`, and returns all points.
inline std::vector<BridgePoint> demodulated(const BridgeOptions& options, std::int64_t first,
                                            const std::vector<std::int32_t>& samples) {
  BridgeDemodulator demodulator(options);
  std::vector<BridgePoint> points;
  demodulator.push({samples, 4, first}, [&](const BridgePoint& point) { points.push_back(point); });
  return points;
}

/// Returns only the points that have no missing frames.
inline std::vector<BridgePoint> complete(std::vector<BridgePoint> points) {
  std::erase_if(points, [](const BridgePoint& point) { return std::isnan(point.ratio[0]); });
  return points;
}

}  // namespace turnpoint::sensing

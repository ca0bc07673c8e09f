#include "station/audio/oscillator.hpp"

#include <cstdint>

#include "station/core/instruction_sets.hpp"

namespace turnpoint::audio {
namespace {

constexpr double sine_terms[8] = {
    0x1.921fb54442d11p+2, -0x1.4abbce625bbc0p+5, 0x1.466bc67748a9ap+6, -0x1.32d2ccdf15cb2p+6,
    0x1.5078319302a74p+5, -0x1.e305e9570ada5p+3, 0x1.e8935f2c74189p+1, -0x1.61c25941fd7cdp-1,
};
constexpr std::uint64_t quarter_cycle_ahead = std::uint64_t{1} << 62;

[[gnu::always_inline]] inline double sine_of(std::uint64_t shifted) noexcept {
  const double x = __builtin_bit_cast(double, (shifted >> 12) | 0x3ff0000000000000u) - 1.5;
  const double r = 0.25 - __builtin_fabs(x);
  const double q = r * r;
  double sum = sine_terms[7];
  sum = sum * q + sine_terms[6];
  sum = sum * q + sine_terms[5];
  sum = sum * q + sine_terms[4];
  sum = sum * q + sine_terms[3];
  sum = sum * q + sine_terms[2];
  sum = sum * q + sine_terms[1];
  sum = sum * q + sine_terms[0];
  return sum * r;
}

}  // namespace

TURNPOINT_CLONES void add_steady(double* __restrict sum, int frames, Partial p) noexcept {
  const double amplitude = p.amplitude;
  std::uint64_t phase = p.phase + quarter_cycle_ahead;
  const std::uint64_t increment = p.increment;
  for (int n = 0; n < frames; ++n) {
    sum[n] += amplitude * sine_of(phase);
    phase += increment;
  }
}

TURNPOINT_CLONES void add_gliding(double* __restrict sum, int frames, Partial p,
                                  const double* __restrict shape) noexcept {
  constexpr int chunk = 64;
  std::uint64_t phases[chunk];
  std::uint64_t phase = p.phase + quarter_cycle_ahead, increment = p.increment;
  for (int start = 0; start < frames; start += chunk) {
    const int count = frames - start < chunk ? frames - start : chunk;
    for (int n = 0; n < count; ++n, phase += increment, increment += p.curvature) phases[n] = phase;
    for (int n = 0; n < count; ++n)
      sum[start + n] += (p.amplitude + p.amplitude_change * shape[start + n]) * sine_of(phases[n]);
  }
}

}  // namespace turnpoint::audio

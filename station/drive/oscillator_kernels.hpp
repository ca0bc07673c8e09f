// The loops of oscillator.hpp, compiled once for each kind of processor. Include only in oscillator_*.cpp;
// everything is in an unnamed namespace, so that no code built for a newer processor can be shared by the
// linker with the rest of the program.
#pragma once
#include <cstdint>

#include "station/drive/oscillator.hpp"

namespace turnpoint::drive {
namespace {

constexpr double kernel_sine[8] = {
    0x1.921fb54442d11p+2, -0x1.4abbce625bbc0p+5, 0x1.466bc67748a9ap+6, -0x1.32d2ccdf15cb2p+6,
    0x1.5078319302a74p+5, -0x1.e305e9570ada5p+3, 0x1.e8935f2c74189p+1, -0x1.61c25941fd7cdp-1,
};
// Degree 9, minimax error 3.3e-9 (-169 dB), for the float loops.
constexpr float kernel_sine_float[5] = {0x1.921fb4a653108p+2F, -0x1.4abbb5a215be6p+5F, 0x1.46676d9ce4094p+6F,
                                        -0x1.3232fa277adddp+6F, 0x1.3c4b2cea332a9p+5F};
constexpr std::uint64_t kernel_quarter = std::uint64_t{1} << 62;

inline double kernel_sine_of(std::uint64_t shifted) noexcept {
  const double x = __builtin_bit_cast(double, (shifted >> 12) | 0x3ff0000000000000u) - 1.5;
  const double r = 0.25 - __builtin_fabs(x);
  const double q = r * r;
  double sum = kernel_sine[7];
  sum = sum * q + kernel_sine[6];
  sum = sum * q + kernel_sine[5];
  sum = sum * q + kernel_sine[4];
  sum = sum * q + kernel_sine[3];
  sum = sum * q + kernel_sine[2];
  sum = sum * q + kernel_sine[1];
  sum = sum * q + kernel_sine[0];
  return sum * r;
}

// `shifted` is the upper half of phase + 3/4 cycle, as a signed fraction of a cycle of -1/2 ... 1/2.
inline float kernel_sine_of(std::int32_t shifted) noexcept {
  const float x = static_cast<float>(shifted) * 0x1p-32F;
  const float r = 0.25F - __builtin_fabsf(x);
  const float q = r * r;
  float sum = kernel_sine_float[4];
  sum = sum * q + kernel_sine_float[3];
  sum = sum * q + kernel_sine_float[2];
  sum = sum * q + kernel_sine_float[1];
  sum = sum * q + kernel_sine_float[0];
  return sum * r;
}

[[maybe_unused]] void steady(double* __restrict sum, int frames, Partial p) noexcept {
  const double amplitude = p.amplitude;
  std::uint64_t phase = p.phase + kernel_quarter;
  const std::uint64_t increment = p.increment;
  for (int n = 0; n < frames; ++n) {
    sum[n] += amplitude * kernel_sine_of(phase);
    phase += increment;
  }
}

[[maybe_unused]] void gliding(double* __restrict sum, int frames, Partial p,
                              const double* __restrict shape) noexcept {
  constexpr int chunk = 64;
  std::uint64_t phases[chunk];
  std::uint64_t phase = p.phase + kernel_quarter, increment = p.increment;
  for (int start = 0; start < frames; start += chunk) {
    const int count = frames - start < chunk ? frames - start : chunk;
    for (int n = 0; n < count; ++n, phase += increment, increment += p.curvature) phases[n] = phase;
    for (int n = 0; n < count; ++n)
      sum[start + n] += (p.amplitude + p.amplitude_change * shape[start + n]) * kernel_sine_of(phases[n]);
  }
}

// 32 frames at a time about an exact phase in their middle: there the upper half of the phase advances by the
// upper half of the increment, at most 16 roundings of 2^-33 cycles away (-158 dB), which is below the
// float's own noise.
[[maybe_unused]] void steady_float(float* __restrict sum, int frames, Partial p) noexcept {
  constexpr int chunk = 32;
  const auto amplitude = static_cast<float>(p.amplitude);
  const auto step = static_cast<std::uint32_t>((p.increment + 0x80000000u) >> 32);
  std::uint32_t offset[chunk];
  for (int n = 0; n < chunk; ++n) offset[n] = step * static_cast<std::uint32_t>(n - chunk / 2);
  std::uint64_t middle = p.phase - kernel_quarter + p.increment * (chunk / 2);
  int start = 0;
  for (; start + chunk <= frames; start += chunk, middle += p.increment * chunk) {
    const auto upper = static_cast<std::uint32_t>(middle >> 32);
    float* __restrict out = sum + start;
    for (int n = 0; n < chunk; ++n)
      out[n] += amplitude * kernel_sine_of(static_cast<std::int32_t>(upper + offset[n]));
  }
  const auto upper = static_cast<std::uint32_t>(middle >> 32);
  for (int n = 0; start + n < frames; ++n)
    sum[start + n] += amplitude * kernel_sine_of(static_cast<std::int32_t>(upper + offset[n]));
}

[[maybe_unused]] void gliding_float(float* __restrict sum, int frames, Partial p,
                                    const double* __restrict shape) noexcept {
  constexpr int chunk = 64;
  std::int32_t phases[chunk];
  std::uint64_t phase = p.phase - kernel_quarter, increment = p.increment;
  const auto amplitude = static_cast<float>(p.amplitude), change = static_cast<float>(p.amplitude_change);
  for (int start = 0; start < frames; start += chunk) {
    const int count = frames - start < chunk ? frames - start : chunk;
    for (int n = 0; n < count; ++n, phase += increment, increment += p.curvature)
      phases[n] = static_cast<std::int32_t>(phase >> 32);
    for (int n = 0; n < count; ++n)
      sum[start + n] +=
          (amplitude + change * static_cast<float>(shape[start + n])) * kernel_sine_of(phases[n]);
  }
}

}  // namespace
}  // namespace turnpoint::drive

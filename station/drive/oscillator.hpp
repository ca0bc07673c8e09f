#pragma once
#include <cstdint>

namespace turnpoint::drive {

/// One sinusoid over a stretch of frames n = 0, 1, ...: the phase is
/// phase + increment n + curvature n (n - 1) / 2 (units of 2^-64 cycles), an exact integer at every n.
struct Partial {
  std::uint64_t phase = 0;
  std::uint64_t increment = 0;
  std::uint64_t curvature = 0;  ///< signed, in two's complement; 0 unless the frequency glides
  double amplitude = 0;
  double amplitude_change = 0;  ///< times the glide's shape, 0 ... 1
};

/// The partial seen from `frames` later: same sinusoid, n counted from there.
inline Partial advanced(Partial partial, std::uint64_t frames) noexcept {
  partial.phase += partial.increment * frames;
  // n (n - 1) / 2 modulo 2^64 without losing the bit that a division of a wrapped product would.
  const std::uint64_t pairs = frames % 2 == 0 ? frames / 2 * (frames - 1) : (frames - 1) / 2 * frames;
  partial.phase += partial.curvature * pairs;
  partial.increment += partial.curvature * frames;
  return partial;
}

/// Inner loops for one kind of processor. `steady` adds `frames` samples of a partial without glide to `sum`;
/// `gliding` also follows curvature and amplitude_change along `shape` (one value a frame).
/// They give the same bits on every processor.
struct Kernels {
  const char* name;
  void (*steady)(double* sum, int frames, Partial partial) noexcept;
  void (*gliding)(double* sum, int frames, Partial partial, const double* shape) noexcept;
};

/// The loops that every processor of the architecture runs.
const Kernels& generic_kernels() noexcept;

/// The fastest loops that this processor runs, found once.
const Kernels& best_kernels() noexcept;

}  // namespace turnpoint::drive

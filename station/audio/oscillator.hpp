#pragma once
#include <cstdint>

namespace turnpoint::audio {

/// One sinusoid over frames n = 0, 1, ..., as the synthesiser renders it. Its phase is phase + increment n +
/// curvature n (n - 1) / 2, in units of 2^-64 cycles: an exact integer at every n.
struct Partial {
  std::uint64_t phase = 0;
  std::uint64_t increment = 0;
  /// change of the increment per frame, as a signed number in two's complement; 0 if the frequency does not
  /// glide
  std::uint64_t curvature = 0;
  double amplitude = 0;
  /// change of the amplitude over a glide; the glide's shape, which rises from 0 to 1, multiplies it
  double amplitude_change = 0;
  std::int32_t channel = 0;  ///< output channel, from 0
};

/// Returns the same sinusoid with frames counted from a later start: its frame 0 is frame `frames` of
/// `partial`.
inline Partial advanced(Partial partial, std::uint64_t frames) noexcept {
  partial.phase += partial.increment * frames;
  // n (n - 1) / 2 modulo 2^64. Halve the even factor before multiplying: the product may overflow, and
  // halving it afterwards would lose its highest bit.
  const std::uint64_t pairs = frames % 2 == 0 ? frames / 2 * (frames - 1) : (frames - 1) / 2 * frames;
  partial.phase += partial.curvature * pairs;
  partial.increment += partial.curvature * frames;
  return partial;
}

/// Returns the partial that glides from `partial` at its frame 0 to frequency and amplitude of `to` within
/// this number of frames.
inline Partial gliding(Partial partial, const Partial& to, std::int64_t frames) noexcept {
  const auto difference = static_cast<std::int64_t>(to.increment - partial.increment);
  partial.curvature = static_cast<std::uint64_t>(difference / frames);
  partial.amplitude_change = to.amplitude - partial.amplitude;
  return partial;
}

/// Returns the partial that follows such a glide of this number of frames, from the glide's end on.
inline Partial after_glide(const Partial& glide, const Partial& to, std::int64_t frames) noexcept {
  return {advanced(glide, static_cast<std::uint64_t>(frames)).phase,
          to.increment,
          0,
          to.amplitude,
          0,
          glide.channel};
}

/// Adds `frames` samples of a partial without glide to `sum`. Every processor gives the same bits.
void add_steady(double* sum, int frames, Partial partial) noexcept;

/// The same, following curvature and amplitude_change along `shape` (one value for each frame).
void add_gliding(double* sum, int frames, Partial partial, const double* shape) noexcept;

}  // namespace turnpoint::audio

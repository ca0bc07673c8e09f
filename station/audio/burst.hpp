#pragma once
#include <array>
#include <cstdint>
#include <type_traits>

#include "station/audio/sine.hpp"

namespace turnpoint::audio {

inline constexpr int max_tones = 32;
inline constexpr int max_channels = 8;
inline constexpr int max_changes = 4;

/// One sinusoid `amplitude * sin(2 pi frequency t + phase)`, where t is 0 at the first frame of its burst.
/// Amplitude 1 is full scale. Output channels are numbered from 0.
struct Tone {
  double frequency_Hz = 0;
  double amplitude = 0;
  double phase_rad = 0;
  std::int32_t channel = 0;
};

/// Up to 32 tones that sound together.
struct ToneSet {
  std::array<Tone, max_tones> tones{};
  std::int32_t count = 0;
};

/// The shape in which amplitude rises and falls: a raised cosine (Hann), which has a continuous slope. A ramp
/// of 0 frames switches abruptly, which can be felt, so use it only on purpose.
struct Ramp {
  std::int64_t frames = 9600;  ///< length of the ramp; the default is 50 ms at 192 kHz
};

/// A change of tones within a burst. Starting at `at_frame` (counted from the burst's first frame), tone i
/// glides to tone i of `to` within `frames`. Frequency changes linearly, and the phase does not jump;
/// amplitude follows the ramp's shape. A tone that only the old set contains fades out. A tone that only the
/// new set contains fades in, with the phase that it would have had if it had run silently since the onset.
struct Change {
  std::int64_t at_frame = 0;
  std::int64_t frames = 9600;
  ToneSet to;
};

/// A signal for recording equipment. It is played at the onset and at each change, on a channel that drives
/// no transducer.
/// A `code` differs from event to event, so a recorder can tell them apart (trigger_code.hpp).
enum class MarkerKind : std::int32_t { none, pulse, tone, code };
struct Marker {
  MarkerKind kind = MarkerKind::none;
  std::int32_t channel = 1;
  double amplitude = 0.5;
  double frequency_Hz = 1000;  ///< frequency if the marker is a tone
  std::int64_t frames = 192;   ///< length of the pulse or tone, or of one bit of a code
  /// trigger codes of the onset and of each change, 1 to 255; 0: no code for this event
  std::array<std::uint8_t, max_changes + 1> codes{};
};

/// Band-limited noise that masks audible sound, faded in and out with the burst's ramp. rms 0 means no noise.
struct MaskingNoise {
  std::int32_t channel = 1;
  double rms = 0;
  double low_Hz = 100;
  double high_Hz = 8000;
  std::uint64_t seed = 1;
};

/// A short tone on headphones that asks for an answer. It begins at `at_frame` (counted from the burst's
/// first frame) with a ramp of its own, so that its onset does not depend on the burst's ramps. If the burst
/// is stopped, so is the tone. Amplitude 0 means no tone.
struct SignalTone {
  std::int32_t channel = 1;
  double amplitude = 0;
  double frequency_Hz = 1000;
  std::int64_t at_frame = 0;
  std::int64_t frames = 9600;
  Ramp ramp{960};
};

/// How a burst follows gains that come while it plays, period by period (GainPeriod). They multiply its
/// tones, in addition to its ramps. If gains are missing, the gain goes to the resting gain; see GainLine.
struct Following {
  double most_gain = 0;  ///< largest gain, which counts in the burst's peak; 0: the burst follows nothing
  double resting_gain = 0;
  std::int64_t leave_frames = 960;    ///< from the first missing gain to the resting gain, in a straight line
  std::int64_t steady_frames = 960;   ///< so long gains must have come again before the burst follows them,
  std::int64_t resume_frames = 1920;  ///< and so long it takes until it does
  bool follows() const noexcept { return most_gain > 0; }
};

/// Describes one stimulus. `start_frame` counts from the opening of the stream. The length includes both
/// ramps.
struct Burst {
  std::int64_t start_frame = 0;
  std::int64_t length_frames = 0;
  Ramp ramp;
  ToneSet tones;
  std::array<Change, max_changes> changes{};  ///< changes in order of time, without overlap
  std::int32_t change_count = 0;
  Marker marker;
  MaskingNoise noise;
  SignalTone signal;
  Following following;
};

static_assert(std::is_trivially_copyable_v<Burst>);

/// Gain of a rising ramp at the fraction u of its length. It rises from 0 at u = 0 to 1 at u = 1, is
/// symmetric about (1/2, 1/2), and is constant outside this range.
inline double ramp_gain(double u) noexcept {
  if (!(u > 0)) return 0;
  if (u >= 1) return 1;
  const double s = sine_of_quarter(u * 0.25);
  return s * s;
}

/// Gain of frame `n` of a rising ramp with `frames` frames. It is computed for the middle of the frame, so
/// that a falling ramp is the exact mirror image of a rising one.
inline double ramp_at(std::int64_t n, std::int64_t frames) noexcept {
  if (n >= frames) return 1;
  return ramp_gain((static_cast<double>(n) + 0.5) / static_cast<double>(frames));
}

}  // namespace turnpoint::audio

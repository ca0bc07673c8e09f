#pragma once
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "station/audio/burst.hpp"
#include "station/audio/oscillator.hpp"
#include "station/core/limits.hpp"

namespace turnpoint::audio {

/// The sample format of a stream. `bits` is the converter's real depth, at which dither is added; samples are
/// passed left-aligned in 32 bits.
struct Format {
  int rate_Hz = 192000;
  int channels = 2;
  int bits = 24;
};

/// The limits that a burst must meet to be accepted.
struct SynthLimits {
  /// largest allowed peak of each channel, relative to full scale
  double peak = 1.0 - 0x1p-20;
  double highest_relative_Hz = core::kHighestShareOfRate;
  std::int64_t longest_frames = 192000LL * 3600;
  std::int64_t longest_rendered_frames =
      /// a longer burst is judged by the sum of its amplitudes, because rendering it would take too long
      192000LL * 60;
};

/// Returns the largest peak that a burst may have in this format, relative to full scale: limits.peak, or
/// less if dither and rounding could otherwise reach full scale (they add up to two steps of the converter).
double largest_peak(const Format& format, const SynthLimits& limits);

/// Thrown for a burst that will not be played; gives the reason.
class BurstRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Returns a tone as the synthesiser renders it at this rate, from the first frame of its burst. Checks
/// nothing.
Partial rendered(const Tone& tone, int rate_Hz);

/// A checked change to other tones: tone i of the burst becomes tone i of `to`. `count` is at least the
/// number of tones of the burst.
struct PreparedChange {
  std::int64_t at_frame = 0;  ///< frame at which the change begins, counted from the burst's first frame
  std::int64_t frames = 1;
  std::int32_t count = 0;
  /// true for a change that was sent while the burst plays; if it arrives late, it begins at once and is
  /// played in full
  bool live = false;
  std::array<Partial, max_tones> to{};
};

/// Masking noise in the form that the synthesiser uses: a high-pass and a low-pass filter of second order,
/// and a scale factor.
struct PreparedNoise {
  std::int32_t channel = 0;
  double gain = 0;
  std::uint64_t seed = 0;
  double high_pass[5] = {};  ///< filter coefficients b0 b1 b2 a1 a2
  double low_pass[5] = {};
};

struct PreparedMarker {
  MarkerKind kind = MarkerKind::none;
  std::int32_t channel = 0;
  double amplitude = 0;
  std::uint64_t increment = 0;
  std::int64_t frames = 0;  ///< length of the pulse or tone, or of half a bit of a code
  std::array<std::uint32_t, max_changes + 1> patterns{};  ///< pulse patterns of the codes (trigger_code.hpp)
};

struct PreparedSignal {
  std::int32_t channel = 0;
  double amplitude = 0;
  std::uint64_t increment = 0;
  std::int64_t at_frame = 0;
  std::int64_t frames = 0;
  Ramp ramp;
};

/// A checked burst, ready for the audio thread. It contains only plain integers and doubles, and the audio
/// thread need not check anything.
struct PreparedBurst {
  std::uint32_t id = 0;
  std::int64_t start_frame = 0;
  std::int64_t length_frames = 0;
  Ramp ramp;
  std::int32_t tone_count = 0;
  std::array<Partial, max_tones> tones{};
  std::int32_t change_count = 0;
  std::array<PreparedChange, max_changes> changes{};
  PreparedMarker marker;
  PreparedNoise noise;
  PreparedSignal signal;
  Following following;
  std::array<double, max_channels>
      /// largest sample of each channel (or an upper limit of it, if that is below the allowed peak)
      peak{};
};

static_assert(std::is_trivially_copyable_v<PreparedBurst>);

/// Checks a burst against the format and the limits, and converts it to integers. The peak of a channel is
/// the sum of its amplitudes if that keeps the limit; otherwise the whole burst is rendered to find its
/// largest sample. Throws BurstRefused for a tone at or above 0.45 of the rate, a channel that does not
/// exist, a peak above the limit, ramps longer than the burst, changes that are out of order or extend beyond
/// the end, and values that are not finite. A burst that follows gains is judged at its largest gain.
PreparedBurst prepare(const Burst& burst, const Format& format, const SynthLimits& limits = {});

/// Checks and converts a change for a burst that may already be sounding. `burst` is the control side's copy
/// of that burst; it gets the tones of the change and the new peak. There is no time to render the burst, so
/// the peak is an upper limit: the largest sum of amplitudes among the burst's first tones, its own changes
/// and all live changes so far. That is enough, because all tones glide with the same weight and no mixture
/// exceeds the larger set.
PreparedChange prepare_change(const Change& change, PreparedBurst& burst, const Format& format,
                              const SynthLimits& limits = {});

/// An upper limit of the samples of each channel: the largest sum of amplitudes of any one tone set, plus the
/// marker and the noise. During a glide between two sets, samples stay below the larger limit of the two.
std::array<double, max_channels> peak_bound(const PreparedBurst& burst);

/// Like the function above, but only for the time in which the burst plays the tones of `change`.
std::array<double, max_channels> peak_bound(const PreparedBurst& burst, const PreparedChange& change);

/// For each channel, the largest sample of the whole burst, found by rendering it (about 1 ns per tone and
/// frame). A burst that follows gains is rendered at its largest gain.
std::array<double, max_channels> rendered_peak(const PreparedBurst& burst, const Format& format);

/// Root mean square of the filtered noise if its input is uniform in (-1, 1) and its gain is 1.
double noise_rms(const PreparedNoise& noise);

}  // namespace turnpoint::audio

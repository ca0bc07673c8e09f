#pragma once
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "station/drive/burst.hpp"
#include "station/terms/limits.hpp"

namespace turnpoint::drive {

/// What a stream is made of. `bits` is the converter's real depth, at which dither is added; samples travel
/// left-aligned in 32 bits.
struct Format {
  int rate_Hz = 192000;
  int channels = 2;
  int bits = 24;
};

/// What a burst must stay inside to be accepted.
struct SynthLimits {
  double peak = 1.0 - 0x1p-20;  ///< of any channel, full scale; leaves room for dither
  double highest_relative_Hz = terms::kHighestShareOfRate;
  std::int64_t longest_frames = 192000LL * 3600;
  std::int64_t longest_rendered_frames =
      192000LL * 60;  ///< longer bursts are judged by the sum of amplitudes alone
};

/// A burst that will not be played, with the reason.
class BurstRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A tone in the synthesiser's units: phases and increments in 2^-64 cycles.
struct PreparedTone {
  std::uint64_t phase = 0;
  std::uint64_t increment = 0;
  double amplitude = 0;
  std::int32_t channel = 0;
};

/// Where the tones go: tone i of `to` is tone i of the burst. `count` is at least the burst's own.
struct PreparedChange {
  std::int64_t at_frame = 0;  ///< from the burst's first frame
  std::int64_t frames = 1;
  std::int32_t count = 0;
  bool live = false;  ///< sent while the burst sounded: if late it begins at once, its past is not made up
  std::array<PreparedTone, max_tones> to{};
};

/// Two second-order sections for masking noise, y = b0 (x - x2) - a1 y1 - a2 y2 each (band pass), and its
/// scale.
struct PreparedNoise {
  std::int32_t channel = 0;
  double gain = 0;
  std::uint64_t seed = 0;
  double high_pass[5] = {};  ///< b0 b1 b2 a1 a2
  double low_pass[5] = {};
};

struct PreparedMarker {
  MarkerKind kind = MarkerKind::none;
  std::int32_t channel = 0;
  double amplitude = 0;
  std::uint64_t increment = 0;
  std::int64_t frames = 0;
};

/// A checked burst, ready for the audio thread: plain integers and doubles, nothing left to refuse.
struct PreparedBurst {
  std::uint32_t id = 0;
  std::int64_t start_frame = 0;
  std::int64_t length_frames = 0;
  Ramp ramp;
  std::int32_t tone_count = 0;
  std::array<PreparedTone, max_tones> tones{};
  std::int32_t change_count = 0;
  std::array<PreparedChange, max_changes> changes{};
  PreparedMarker marker;
  PreparedNoise noise;
  std::array<double, max_channels>
      peak{};  ///< largest sample of each channel (or a bound that is inside the limit)
};

static_assert(std::is_trivially_copyable_v<PreparedBurst>);

/// Checks a burst against the format and the limits, and turns it into integers. The peak of a channel is the
/// sum of its amplitudes where that is inside the limit, otherwise the largest sample of the whole burst,
/// found by rendering it. Throws BurstRefused: a tone at or above 0.45 of the rate, a channel that is not
/// there, a peak above the limit, ramps longer than the burst, changes out of order or crossing the end,
/// values that are not finite.
PreparedBurst prepare(const Burst& burst, const Format& format, const SynthLimits& limits = {});

/// A change for a burst that may be sounding already: the same checks. `burst` is what the control side knows
/// of it, and gets the change's tones and the new peak. All tones glide by the same weight, so no mixture of
/// the sets that they pass between is larger than the largest: the peak is the largest sum of amplitudes of
/// the burst's first tones, of its own changes, and of all live ones so far, since a live change cannot wait
/// for a rendering.
PreparedChange prepare_change(const Change& change, PreparedBurst& burst, const Format& format,
                              const SynthLimits& limits = {});

}  // namespace turnpoint::drive

#pragma once
#include <cstdint>

namespace turnpoint::terms {

/// Below, a tone may be heard, and falls into the stricter band of exposure limits: the lower end of the
/// third-octave band around 25 kHz.
inline constexpr double kAudible_Hz = 22400;

/// Highest frequency of a tone as a share of the sampling rate: the pass band of common converters.
inline constexpr double kHighestShareOfRate = 0.45;

/// Fingers of one hand land within some 30 ms of each other: a touch is an answer only if no other comes
/// within this.
inline constexpr std::int64_t kOneTouch_ns = 40'000'000;
/// How long the page keeps a touch before it goes to the session: that time, and the slack of a timer.
inline constexpr std::int64_t kTouchToAnswer_ns = 60'000'000;
/// How long the session waits before it believes that no touch with an earlier stamp is still on its way.
inline constexpr std::int64_t kWatermark_ns = 80'000'000;
static_assert(kOneTouch_ns < kTouchToAnswer_ns && kTouchToAnswer_ns < kWatermark_ns);

}  // namespace turnpoint::terms

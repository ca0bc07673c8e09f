#pragma once
#include <cstdint>

namespace turnpoint::core {

/// A tone below this frequency may be audible, and the stricter limit of airborne sound applies to it. It is
/// the lower end of the third-octave band around 25 kHz.
inline constexpr double kAudible_Hz = 22400;

/// Returns the recommended limit of airborne sound (rms, re 20 uPa) in the third-octave band of a frequency:
/// 75 dB in the bands up to 20 kHz, 110 dB above. These are limits for workplaces: INIRC/IRPA, Health Physics
/// 46 (1984) 969; Health Canada, Safety Code 24 (1991). For the public, INIRC/IRPA recommends 70 and 100 dB.
constexpr double allowed_sound_dB(double frequency_Hz) { return frequency_Hz < kAudible_Hz ? 75 : 110; }

/// Highest frequency of a tone divided by the sampling rate. Common converters pass frequencies up to this
/// fraction.
inline constexpr double kHighestShareOfRate = 0.45;

/// A touch counts as an answer only if no other touch follows within this time. The reason: when a hand lands
/// on the panel, its fingers touch it within about 30 ms of each other.
inline constexpr std::int64_t kOneTouch_ns = 40'000'000;
/// The page waits this long before it passes a touch to the session: kOneTouch_ns and a margin for timers.
inline constexpr std::int64_t kTouchToAnswer_ns = 60'000'000;
/// The session waits this long for touches that have an earlier time stamp but arrive late.
inline constexpr std::int64_t kWatermark_ns = 80'000'000;
static_assert(kOneTouch_ns < kTouchToAnswer_ns && kTouchToAnswer_ns < kWatermark_ns);

/// A press sooner than this after an answer is a second press of the answer and never its confidence.
inline constexpr std::int64_t kConfidenceGuard_ns = 350'000'000;
inline constexpr double kConfidenceGuard_s = 0.35;

/// Length of the tone that asks for an answer (a response signal on headphones).
inline constexpr double kSignal_s = 0.05;
/// Length of a frame of an ordinary screen, which shows 60 of them in a second.
inline constexpr double kFrame_s = 1.0 / 60;
/// A flash (a response signal on the screen) is late if its frame comes longer than this after its time. One
/// or two frames of the screen are normal.
inline constexpr double kSignalLate_s = 3 * kFrame_s;
/// How long the surface takes to change to a buzz (a response signal on the surface), and back.
inline constexpr double kBuzzRamp_s = 0.005;
/// A part of a stimulus in which nothing changes is measured if it lasts this long; see
/// sensing/interval_proof.hpp.
inline constexpr double kBetweenChanges_s = 0.02;

/// Frequency of the carrier that excites the strain-gauge bridges of force cells. It is 25 Hz above a
/// multiple of 300 Hz, and so at least 25 Hz away from every harmonic of 50 and 60 Hz mains. There is one for
/// all rigs, because amplifier and filter treat each frequency differently, so each would need its own
/// calibration.
inline constexpr double kForceCarrier_Hz = 10525;

}  // namespace turnpoint::core

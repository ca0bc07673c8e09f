#pragma once

namespace turnpoint::terms {

/// Frequency of the carrier that excites the strain-gauge bridges of force cells. It is 25 Hz above a
/// multiple of 300 Hz, and so at least 25 Hz away from every harmonic of 50 and 60 Hz mains. There is one for
/// all rigs, because amplifier and filter treat each frequency differently, so each would need its own
/// calibration.
inline constexpr double kForceCarrier_Hz = 10525;

}  // namespace turnpoint::terms

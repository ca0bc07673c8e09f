#pragma once
#include <array>

namespace turnpoint::terms {

/// The possible carrier frequencies for the excitation of the strain-gauge bridges of force cells; the first
/// is the default. Each is 25 Hz above a multiple of 300 Hz, and so at least 25 Hz away from every harmonic
/// of 50 and 60 Hz mains. There are only five, because amplifier and filter treat each carrier differently,
/// so each needs its own calibration.
inline constexpr std::array carriers_Hz{10525.0, 6325.0, 8425.0, 12625.0, 14725.0};

}  // namespace turnpoint::terms

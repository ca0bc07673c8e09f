#pragma once
#include <cstdint>
#include <optional>
#include <span>

namespace turnpoint::sensing {

/// The index (with a fraction) at which an envelope last rises through 0.5, half of its final level of 1. It
/// is interpolated by cubics, and empty if the envelope never rises through 0.5. A symmetric low-pass filter
/// does not move the half level of a symmetric ramp, so the envelope may be filtered with a longer window
/// than the ramp. The result is also empty if a value next to the crossing is NaN.
std::optional<double> half_level(std::span<const double> envelope);

}  // namespace turnpoint::sensing

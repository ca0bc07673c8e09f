#pragma once
#include <cstdint>
#include <optional>
#include <span>

namespace turnpoint::sensing {

/// Returns the index (with a fraction) at which an envelope last rises through 0.5, half of its final level
/// of 1, interpolated by cubics. Empty if the envelope never rises through 0.5, or if a value next to the
/// crossing is NaN. A symmetric low-pass filter does not move the half level of a symmetric ramp, so the
/// envelope may have been filtered, even with a window longer than the ramp.
std::optional<double> half_level(std::span<const double> envelope);

}  // namespace turnpoint::sensing

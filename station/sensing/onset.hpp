#pragma once
#include <cstdint>
#include <optional>
#include <span>

namespace turnpoint::sensing {

/// The place (in points, counted from 0) at which an envelope last rises through half of its final level 1,
/// interpolated by cubics; none if it never does. A symmetric low-pass filter does not move the half level of
/// a symmetric ramp, so the envelope may be filtered with a longer window than the ramp. NaN is never
/// crossed.
std::optional<double> half_level(std::span<const double> envelope);

}  // namespace turnpoint::sensing

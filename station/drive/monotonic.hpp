#pragma once
#include <cstdint>

namespace turnpoint::drive {

/// CLOCK_MONOTONIC in nanoseconds: the station's one clock for events, read here and nowhere else.
std::int64_t monotonic_ns() noexcept;

/// CLOCK_MONOTONIC_RAW minus CLOCK_MONOTONIC now: what time services have added since the start; ns.
std::int64_t raw_minus_monotonic_ns() noexcept;

/// Sleeps until that time, through signals.
void sleep_until_ns(std::int64_t time_ns) noexcept;

}  // namespace turnpoint::drive

#pragma once
#include <cstdint>

namespace turnpoint::drive {

/// CLOCK_MONOTONIC in nanoseconds, the clock of all events in the station.
std::int64_t monotonic_ns() noexcept;

/// CLOCK_MONOTONIC_RAW minus CLOCK_MONOTONIC, in ns: the correction that time services have made since the
/// machine started.
std::int64_t raw_minus_monotonic_ns() noexcept;

/// Sleeps until that time; signals do not cut it short.
void sleep_until_ns(std::int64_t time_ns) noexcept;

}  // namespace turnpoint::drive

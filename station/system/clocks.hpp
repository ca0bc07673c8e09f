#pragma once
#include <cstdint>

namespace turnpoint::system {

/// Returns CLOCK_MONOTONIC in nanoseconds. The times of all events in the station are from this clock.
std::int64_t monotonic_ns() noexcept;

/// Returns CLOCK_MONOTONIC_RAW minus CLOCK_MONOTONIC in ns. The difference is the sum of all corrections that
/// time services have made since the machine started.
std::int64_t raw_minus_monotonic_ns() noexcept;

/// Returns the wall-clock time in ns since 1970. Use it for records only, never for durations.
std::int64_t realtime_ns() noexcept;

/// Readings of three clocks in ns, taken together.
struct Clocks {
  std::int64_t monotonic_ns = 0;  ///< this clock stops while the machine is suspended
  std::int64_t boottime_ns = 0;   ///< this clock continues while the machine is suspended
  std::int64_t realtime_ns = 0;   ///< wall time, which may be set
};
Clocks read_clocks() noexcept;

/// Sleeps until `time_ns` on CLOCK_MONOTONIC. Signals do not end the sleep.
void sleep_until_ns(std::int64_t time_ns) noexcept;

}  // namespace turnpoint::system

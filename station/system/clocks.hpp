#pragma once
#include <cstdint>

namespace turnpoint::system {

/// CLOCK_MONOTONIC in nanoseconds, the clock of all events in the station.
std::int64_t monotonic_ns() noexcept;

/// CLOCK_MONOTONIC_RAW minus CLOCK_MONOTONIC, in ns: the correction that time services have made since the
/// machine started.
std::int64_t raw_minus_monotonic_ns() noexcept;

/// Wall-clock time in ns since 1970: for records only, never for durations.
std::int64_t realtime_ns() noexcept;

/// Three clocks of the machine, read at the same time; ns.
struct Clocks {
  std::int64_t monotonic_ns = 0;  ///< stops during suspend
  std::int64_t boottime_ns = 0;   ///< continues during suspend
  std::int64_t realtime_ns = 0;   ///< wall time, which may be set
};
Clocks read_clocks() noexcept;

/// Sleeps until that time, through signals.
void sleep_until_ns(std::int64_t time_ns) noexcept;

}  // namespace turnpoint::system

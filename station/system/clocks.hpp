#pragma once
#include <cstdint>
#include <optional>

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

/// Detects that the machine was suspended, or that somebody set its clock. Reads no clock itself: it compares
/// the readings that the caller passes.
class ClockWatch {
 public:
  explicit ClockWatch(const Clocks& start) noexcept : last_(start) {}

  struct News {
    std::optional<double> suspended_s;  ///< how long the machine slept
    std::optional<double> jump_s;       ///< how much the wall clock was changed, not counting time asleep
  };
  /// Returns what has happened since the previous call. Slow corrections by a time service (at most 500 ppm)
  /// do not count as a jump.
  News look(const Clocks& now) noexcept;

 private:
  Clocks last_;
};

}  // namespace turnpoint::system

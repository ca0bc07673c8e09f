#include "station/system/clocks.hpp"

#include <cerrno>
#include <ctime>

namespace turnpoint::system {

namespace {

std::int64_t read(clockid_t clock) noexcept {
  timespec now{};
  ::clock_gettime(clock, &now);
  return std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
}

}  // namespace

std::int64_t monotonic_ns() noexcept { return read(CLOCK_MONOTONIC); }

std::int64_t raw_minus_monotonic_ns() noexcept { return read(CLOCK_MONOTONIC_RAW) - monotonic_ns(); }

std::int64_t realtime_ns() noexcept { return read(CLOCK_REALTIME); }

Clocks read_clocks() noexcept { return {read(CLOCK_MONOTONIC), read(CLOCK_BOOTTIME), read(CLOCK_REALTIME)}; }

void sleep_until_ns(std::int64_t time_ns) noexcept {
  const timespec until{time_ns / 1'000'000'000, time_ns % 1'000'000'000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace turnpoint::system

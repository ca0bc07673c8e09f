#include "station/drive/monotonic.hpp"

#include <cerrno>
#include <ctime>

namespace turnpoint::drive {

std::int64_t monotonic_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
}

std::int64_t raw_minus_monotonic_ns() noexcept {
  timespec raw{};
  clock_gettime(CLOCK_MONOTONIC_RAW, &raw);
  return std::int64_t{1'000'000'000} * raw.tv_sec + raw.tv_nsec - monotonic_ns();
}

void sleep_until_ns(std::int64_t time_ns) noexcept {
  const timespec until{time_ns / 1'000'000'000, time_ns % 1'000'000'000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace turnpoint::drive

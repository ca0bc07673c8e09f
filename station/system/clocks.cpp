#include "station/system/clocks.hpp"

#include <cerrno>
#include <cmath>
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

namespace {

constexpr double kSleep_s = 0.05, kJump_s = 0.1, kSteering = 1e-3;

}  // namespace

ClockWatch::News ClockWatch::look(const Clocks& now) noexcept {
  const double ran_s = 1e-9 * static_cast<double>(now.monotonic_ns - last_.monotonic_ns);
  const double passed_s = 1e-9 * static_cast<double>(now.boottime_ns - last_.boottime_ns);
  const double wall_s = 1e-9 * static_cast<double>(now.realtime_ns - last_.realtime_ns);
  last_ = now;
  News news;
  if (passed_s - ran_s > kSleep_s) news.suspended_s = passed_s - ran_s;
  if (std::fabs(wall_s - passed_s) > kJump_s + kSteering * passed_s) news.jump_s = wall_s - passed_s;
  return news;
}

}  // namespace turnpoint::system

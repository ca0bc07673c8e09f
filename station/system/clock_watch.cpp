#include "station/system/clock_watch.hpp"

#include <cmath>

namespace turnpoint::system {

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

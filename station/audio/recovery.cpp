#include "station/audio/recovery.hpp"

#include <cerrno>

namespace turnpoint::audio {
namespace {

constexpr std::int64_t reopen_every_ns = 250'000'000;
// after the machine has slept, a device needs about ten waits to resume; after 50 it will not resume by
// itself
constexpr int most_resumes = 50;

}  // namespace

RecoveryAction Recovery::lose() noexcept {
  state_ = State::lost;
  next_try_ns_ = reopen_every_ns;
  return RecoveryAction::abandon;
}

RecoveryAction Recovery::transferred(const DeviceReport& report) noexcept {
  if (report.disconnected) return lose();
  switch (-report.error) {
    case 0:
    case EINTR:
    case EAGAIN:
      state_ = State::running;
      return RecoveryAction::go_on;
    case EPIPE:
      state_ = State::restarting;
      return RecoveryAction::restart;
    case ESTRPIPE:
      state_ = State::resuming;
      resumes_ = 0;
      return RecoveryAction::resume;
    default:
      return lose();
  }
}

RecoveryAction Recovery::acted(const DeviceReport& report) noexcept {
  if (report.disconnected || report.error == -ENODEV) return lose();
  if (state_ == State::resuming) {
    if (report.error == -EAGAIN && ++resumes_ < most_resumes) return RecoveryAction::wait;
    // Restart the device in any case. Many drivers cannot resume (ENOSYS). If the driver did resume, the
    // relation between frames and time has changed, and the buffer still holds the rest of a stimulus from
    // before the sleep.
    state_ = State::restarting;
    return RecoveryAction::restart;
  }
  if (report.error == 0) {
    state_ = State::running;
    return RecoveryAction::go_on;
  }
  return lose();
}

RecoveryAction Recovery::absent(std::int64_t lost_for_ns) noexcept {
  if (lost_for_ns < next_try_ns_) return RecoveryAction::wait;
  next_try_ns_ = lost_for_ns + reopen_every_ns;
  return RecoveryAction::reopen;
}

RecoveryAction Recovery::reopened(int error) noexcept {
  if (error != 0) return RecoveryAction::wait;
  state_ = State::running;
  return RecoveryAction::back;
}

bool UnderrunLimit::exceeded_by(std::int64_t time_ns) noexcept {
  const std::int64_t oldest = recent_ns_[next_];
  recent_ns_[next_] = time_ns;
  next_ = (next_ + 1) % 3;
  return oldest >= 0 && time_ns - oldest < 60'000'000'000;
}

}  // namespace turnpoint::audio

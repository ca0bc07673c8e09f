#pragma once
#include <cstdint>

namespace turnpoint::drive {

/// What a sound device said: 0 or the negative errno of the last call, and whether its state is
/// "disconnected".
struct DeviceReport {
  int error = 0;
  bool disconnected = false;
};

enum class RecoveryAction {
  go_on,    ///< all is well, or the call was only interrupted: try again
  restart,  ///< underrun or woken: prepare, fill with silence, start
  resume,   ///< suspended: ask the device to resume, before it is restarted
  wait,     ///< the device is resuming: wait a period, then ask again
  abandon,  ///< gone: close it; the stream is lost and the amplifier goes off
  reopen,   ///< lost: try to open it by name
  back,     ///< it is open again: an operator has to re-arm
};

/// What to do when a sound device fails, as a machine that is stepped with what the device said. Pure: it
/// neither sleeps nor calls the device.
class Recovery {
 public:
  /// After a transfer or a wait.
  RecoveryAction transferred(const DeviceReport& report) noexcept;
  /// After the action `restart` or `resume` was carried out.
  RecoveryAction acted(const DeviceReport& report) noexcept;
  /// While lost: whenever a period has passed, with the time since the loss. Reopening is tried four times a
  /// second.
  RecoveryAction absent(std::int64_t lost_for_ns) noexcept;
  /// After the action `reopen`: 0, or why not.
  RecoveryAction reopened(int error) noexcept;

  bool lost() const noexcept { return state_ == State::lost; }

 private:
  enum class State { running, restarting, resuming, lost };
  RecoveryAction lose() noexcept;

  State state_ = State::running;
  int resumes_ = 0;
  std::int64_t next_try_ns_ = 0;
};

/// Decides whether underruns are too many: more than three within a minute stop a session.
class UnderrunLimit {
 public:
  /// True when this one makes it too many.
  bool exceeded_by(std::int64_t time_ns) noexcept;

 private:
  std::int64_t recent_ns_[3] = {-1, -1, -1};
  int next_ = 0;
};

}  // namespace turnpoint::drive

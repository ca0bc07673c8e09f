#pragma once
#include <cstdint>

namespace turnpoint::audio {

/// The state of a sound device after a call: 0 or the negative errno of the last call, and whether ALSA
/// reports "disconnected".
struct DeviceReport {
  int error = 0;
  bool disconnected = false;
};

enum class RecoveryAction {
  go_on,    ///< nothing to recover from, or the call was only interrupted: try again
  restart,  ///< after an underrun or a resume: prepare the device, fill it with silence, start it
  resume,   ///< the device was suspended: ask it to resume, then restart it
  wait,     ///< the device is resuming: wait one period, then ask again
  abandon,  ///< the device is gone: close it; the amplifier goes off
  reopen,   ///< the device is lost: try to open it by name
  back,     ///< the device is open again: an operator has to re-arm
};

/// Decides what to do when a sound device fails, from what the device reported. Pure: this state machine
/// neither sleeps nor calls the device.
class Recovery {
 public:
  /// Call this after writing samples to the device or waiting for it.
  RecoveryAction transferred(const DeviceReport& report) noexcept;
  /// Call this after carrying out the action `restart` or `resume`.
  RecoveryAction acted(const DeviceReport& report) noexcept;
  /// Call this once per period while the device is lost, with the time since the loss. Four times a second it
  /// answers `reopen`, otherwise `wait`.
  RecoveryAction absent(std::int64_t lost_for_ns) noexcept;
  /// Call this after carrying out the action `reopen`, with 0 or the error that occurred.
  RecoveryAction reopened(int error) noexcept;

  bool lost() const noexcept { return state_ == State::lost; }

 private:
  enum class State { running, restarting, resuming, lost };
  RecoveryAction lose() noexcept;

  State state_ = State::running;
  int resumes_ = 0;
  std::int64_t next_try_ns_ = 0;
};

/// Counts underruns: more than three within a minute stop a session.
class UnderrunLimit {
 public:
  /// True if this underrun exceeds the limit.
  bool exceeded_by(std::int64_t time_ns) noexcept;

 private:
  std::int64_t recent_ns_[3] = {-1, -1, -1};
  int next_ = 0;
};

}  // namespace turnpoint::audio

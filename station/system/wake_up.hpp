#pragma once
#include "station/core/file_descriptor.hpp"

namespace turnpoint::system {

/// Wakes a thread that waits for descriptor(). ring() never blocks and may be called on any thread; only one
/// thread may wait.
class WakeUp {
 public:
  /// Throws std::system_error if the process has no free descriptor.
  WakeUp();
  WakeUp(const WakeUp&) = delete;
  WakeUp& operator=(const WakeUp&) = delete;

  void ring() noexcept;
  /// Forgets all rings so far. The waiting thread calls this.
  void clear() noexcept;
  /// Returns a descriptor that is readable from a ring() until the next clear().
  int descriptor() const noexcept { return event_.get(); }

 private:
  core::FileDescriptor event_;
};

}  // namespace turnpoint::system

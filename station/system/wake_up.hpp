#pragma once
#include "station/system/file_descriptor.hpp"

namespace turnpoint::system {

/// Ends another thread's wait for a descriptor. ring() never blocks and is safe on any thread; only one
/// thread may wait.
class WakeUp {
 public:
  /// Throws std::system_error if the process has no free descriptor.
  WakeUp();
  WakeUp(const WakeUp&) = delete;
  WakeUp& operator=(const WakeUp&) = delete;

  void ring() noexcept;
  /// For the waiting thread: forgets all rings so far.
  void clear() noexcept;
  /// Readable from a ring() until a clear().
  int descriptor() const noexcept { return event_.get(); }

 private:
  FileDescriptor event_;
};

}  // namespace turnpoint::system

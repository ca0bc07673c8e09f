#pragma once
#include "station/system/file_descriptor.hpp"

namespace turnpoint::system {

/// Ends another thread's wait for a descriptor. ring() never blocks and is safe on any thread; one waiter.
class WakeUp {
 public:
  /// Throws std::system_error where the process has no descriptor left.
  WakeUp();
  WakeUp(const WakeUp&) = delete;
  WakeUp& operator=(const WakeUp&) = delete;

  void ring() noexcept;
  /// The waiter forgets the rings so far.
  void clear() noexcept;
  /// Readable from a ring() until a clear().
  int descriptor() const noexcept { return event_.get(); }

 private:
  FileDescriptor event_;
};

}  // namespace turnpoint::system

#pragma once

namespace turnpoint::panel {

/// Ends another thread's wait for a descriptor. ring() never blocks and is safe on any thread; one waiter.
class WakeUp {
 public:
  /// Throws std::system_error where the process has no descriptor left.
  WakeUp();
  ~WakeUp();
  WakeUp(const WakeUp&) = delete;
  WakeUp& operator=(const WakeUp&) = delete;

  void ring() noexcept;
  /// The waiter forgets the rings so far.
  void clear() noexcept;
  /// Readable from a ring() until a clear().
  int descriptor() const noexcept { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace turnpoint::panel

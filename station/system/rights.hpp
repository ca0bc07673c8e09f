#pragma once
#include <string>
#include <vector>

#include "station/system/memory_range.hpp"

namespace turnpoint::system {

/// The rights that the operating system granted to the audio thread, for the record and the screen.
struct Rights {
  bool asked = false;     ///< a synchronous stream asks for nothing
  int fifo_priority = 0;  ///< 0: not real time
  bool memory_locked = false;
  std::string note;  ///< why not, where something was denied
};

/// Call this before the audio thread starts. It locks into memory the program, its libraries, the current
/// heap and the given ranges. Objects made by a thread other than the first are in separate anonymous memory
/// and must be given. The note says why locking failed, or else repeats `left_out`: memory that the audio
/// thread uses but that is in no range. mlockall is not used because it also pins pages that a garbage
/// collector gives back. madvise(MADV_DONTNEED) then fails, and Qt's JavaScript engine, which expects zeroed
/// pages, crashes.
Rights lock_memory(const std::vector<MemoryRange>& ranges, const std::string& left_out = "");

/// Locks the part of the calling thread's stack that a real-time thread uses. Returns 0 or an errno.
int lock_stack() noexcept;

/// Makes the calling thread real-time: SCHED_FIFO at `priority`, a stack locked in memory, and a limit on
/// real-time run time, so that a spinning thread is killed before it freezes the machine. Returns 0, or the
/// errno of what was denied.
int become_realtime(int priority) noexcept;

}  // namespace turnpoint::system

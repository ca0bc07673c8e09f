#pragma once
#include <string>
#include <vector>

#include "station/system/memory_range.hpp"

namespace turnpoint::system {

/// The rights that the operating system granted to the audio thread, for the record and the screen.
struct Rights {
  bool asked = false;     ///< whether rights were requested; a synchronous stream needs none
  int fifo_priority = 0;  ///< 0: the thread is not real-time
  bool memory_locked = false;
  std::string note;  ///< why a right was denied or what is not locked; "" if there is nothing to say
};

/// Locks memory, so that the audio thread never waits for a page to be loaded. Call this before the thread
/// starts. It locks the program, its libraries, the heap as it is now, and the given ranges. Objects that
/// were allocated on another thread than the first are outside of this heap, so their ranges must be given.
/// If locking failed, `note` in the result says why. Otherwise `note` is `left_out`, in which the caller
/// names memory that the audio thread uses but that is in no range.
///
/// mlockall is not used, because it would also pin pages that a garbage collector gives back.
/// madvise(MADV_DONTNEED) then fails, and Qt's JavaScript engine, which expects zeroed pages, crashes.
Rights lock_memory(const std::vector<MemoryRange>& ranges, const std::string& left_out = "");

/// Locks the calling thread's stack in memory, as much of it as a real-time thread needs. Returns 0 or an
/// errno value.
int lock_stack() noexcept;

/// Makes the calling thread real-time: SCHED_FIFO at `priority`, with its stack locked in memory. Its run
/// time is limited, so that a thread in an endless loop is killed before it freezes the machine. Returns 0,
/// or the errno value of the right that was denied.
int become_realtime(int priority) noexcept;

}  // namespace turnpoint::system

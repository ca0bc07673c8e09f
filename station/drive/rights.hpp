#pragma once
#include <string>
#include <vector>

#include "station/drive/engine.hpp"
#include "station/drive/memory_range.hpp"

namespace turnpoint::drive {

/// Locks into memory, before the audio thread starts, the program, its libraries, the heap as far as it has
/// grown, and the ranges given: objects made by a thread other than the first lie in anonymous memory of
/// their own. The note says why not, or else names `left_out`: what the audio thread uses and is in no range.
/// Not mlockall: it also pins the pages that a garbage collector gives back, madvise(MADV_DONTNEED) then
/// fails, and Qt's JavaScript engine, which relies on getting zeroed pages again, crashes.
Rights lock_memory(const std::vector<MemoryRange>& ranges, const std::string& left_out = "");

/// Locks the part of the calling thread's stack that a real-time thread uses. Returns 0 or an errno.
int lock_stack() noexcept;

/// For the calling thread: SCHED_FIFO at `priority`, a stack that is in memory, and a limit on real-time run
/// time so that a spinning thread is killed rather than the machine frozen. Returns 0 or the errno of what
/// was denied.
int become_realtime(int priority) noexcept;

}  // namespace turnpoint::drive

#pragma once
#include "station/drive/engine.hpp"

namespace turnpoint::drive {

/// Locks program, libraries and heap into memory, before the audio thread starts; the note says why not.
/// These are what a machine without swap can page out. Not mlockall: it also pins the pages that a garbage
/// collector gives back, madvise(MADV_DONTNEED) then fails, and Qt's JavaScript engine, which relies on
/// getting zeroed pages again, crashes.
Rights lock_memory();

/// For the calling thread: SCHED_FIFO at `priority`, a prefaulted stack, and a limit on real-time run time so
/// that a spinning thread is killed rather than the machine frozen. Returns 0 or the errno of what was
/// denied.
int become_realtime(int priority) noexcept;

}  // namespace turnpoint::drive

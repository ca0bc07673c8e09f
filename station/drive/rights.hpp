#pragma once
#include "station/drive/engine.hpp"

namespace turnpoint::drive {

/// Locks the process's memory (mlockall) for the control side, before the audio thread starts; the note says
/// why not.
Rights lock_memory();

/// For the calling thread: SCHED_FIFO at `priority`, a prefaulted stack, and a limit on real-time run time so
/// that a spinning thread is killed rather than the machine frozen. Returns 0 or the errno of what was
/// denied.
int become_realtime(int priority) noexcept;

}  // namespace turnpoint::drive

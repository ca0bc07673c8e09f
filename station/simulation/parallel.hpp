#pragma once
#include <functional>

namespace turnpoint::simulation {

/// Calls work(0) ... work(count - 1) on so many threads, each once, in no particular order, and
/// `progress(done, count)` (may be empty) one at a time. Returns when all are done; the first exception stops
/// what has not begun and is thrown here.
void in_parallel(int count, int threads, const std::function<void(int done, int of)>& progress,
                 const std::function<void(int)>& work);

/// How many threads can run at once; at least 1.
int processors();

}  // namespace turnpoint::simulation

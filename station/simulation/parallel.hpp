#pragma once
#include <functional>

namespace turnpoint::simulation {

/// Calls work(0) ... work(count - 1), each once and in no particular order, on this number of threads. Calls
/// `progress(done, count)` (may be empty) from one thread at a time. Returns when all are done. After the
/// first exception no further work is started, and the exception is thrown here.
void in_parallel(int count, int threads, const std::function<void(int done, int of)>& progress,
                 const std::function<void(int)>& work);

/// How many threads can run at once; at least 1.
int processors();

}  // namespace turnpoint::simulation

#pragma once
#include <functional>
#include <stop_token>

namespace turnpoint::rehearsal {

/// Calls work(0) ... work(count - 1), each once and in no particular order, on this number of threads. Calls
/// `progress(done, count)`, unless `progress` is empty, from one thread at a time. Returns when all calls
/// have ended. If a call throws, no further calls are started, and this function throws the first exception.
/// Once `stop` is requested, no further calls are started either. Returns the number n of calls made, which
/// are then work(0) ... work(n - 1).
int in_parallel(int count, int threads, const std::function<void(int done, int of)>& progress,
                const std::function<void(int)>& work, const std::stop_token& stop = {});

/// How many threads can run at once; at least 1.
int processors();

}  // namespace turnpoint::rehearsal

#include "station/rehearsal/parallel.hpp"

#include <algorithm>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace turnpoint::rehearsal {

int processors() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

int in_parallel(int count, int threads, const std::function<void(int done, int of)>& progress,
                const std::function<void(int)>& work, const std::stop_token& stop) {
  std::mutex mutex;
  int next = 0, done = 0;
  std::exception_ptr failure;
  const auto take = [&]() -> int {
    const std::lock_guard lock(mutex);
    return failure || stop.stop_requested() || next >= count ? -1 : next++;
  };
  const auto worker = [&] {
    for (int i = take(); i >= 0; i = take()) try {
        work(i);
        const std::lock_guard lock(mutex);
        ++done;
        if (progress) progress(done, count);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
      }
  };
  {
    std::vector<std::jthread> team;
    for (int i = 1; i < threads && i < count; ++i) team.emplace_back(worker);
    worker();
  }
  if (failure) std::rethrow_exception(failure);
  return done;
}

}  // namespace turnpoint::rehearsal

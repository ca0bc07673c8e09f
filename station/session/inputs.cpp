#include "station/session/inputs.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace turnpoint::session {

void Inputs::push(Input input) {
  {
    const std::lock_guard lock(mutex_);
    const auto later = std::upper_bound(queue_.begin(), queue_.end(), input,
                                        [](const Input& a, const Input& b) { return a.time_ns < b.time_ns; });
    queue_.insert(later, std::move(input));
  }
  arrived_.notify_one();
}

std::optional<Input> Inputs::wait_until(std::int64_t deadline_ns) {
  // steady_clock is CLOCK_MONOTONIC here, the clock of every time stamp.
  const std::chrono::steady_clock::time_point deadline{std::chrono::nanoseconds(deadline_ns)};
  std::unique_lock lock(mutex_);
  if (!arrived_.wait_until(lock, deadline, [this] { return !queue_.empty(); })) return std::nullopt;
  Input first = std::move(queue_.front());
  queue_.pop_front();
  return first;
}

std::deque<Input> Inputs::drain() {
  const std::lock_guard lock(mutex_);
  return std::exchange(queue_, {});
}

}  // namespace turnpoint::session

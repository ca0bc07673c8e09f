#include "station/panel/simulated_lines.hpp"

#include <chrono>

#include "station/drive/monotonic.hpp"

namespace turnpoint::panel {

void SimulatedLines::check() const {
  if (gone_) throw std::system_error(ENODEV, std::generic_category(), "simulated gpio chip");
}

std::optional<Edge> SimulatedLines::wait(std::int64_t timeout_ns) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, std::chrono::nanoseconds(timeout_ns), [this] { return gone_ || !edges_.empty(); });
  check();
  if (edges_.empty()) return std::nullopt;
  const Edge edge = edges_.front();
  edges_.pop_front();
  return edge;
}

bool SimulatedLines::level(int index) {
  const std::lock_guard lock(mutex_);
  check();
  return levels_.at(static_cast<std::size_t>(index)) != 0;
}

void SimulatedLines::drive(int index, int level) {
  const std::lock_guard lock(mutex_);
  check();
  int& now = levels_.at(static_cast<std::size_t>(index));
  if (now != level) driven_.push_back({drive::monotonic_ns(), index, level});
  now = level;
}

std::vector<SimulatedLines::Driven> SimulatedLines::driven() const {
  const std::lock_guard lock(mutex_);
  return driven_;
}

void SimulatedLines::set(int index, bool level, std::int64_t time_ns) {
  const std::lock_guard lock(mutex_);
  levels_.at(static_cast<std::size_t>(index)) = level ? 1 : 0;
  edges_.push_back({time_ns, index, level, ++sequences_.at(static_cast<std::size_t>(index))});
  changed_.notify_all();
}

void SimulatedLines::lose_edges(int index, std::uint32_t count) {
  const std::lock_guard lock(mutex_);
  sequences_.at(static_cast<std::size_t>(index)) += count;
}

void SimulatedLines::remove() {
  const std::lock_guard lock(mutex_);
  gone_ = true;
  changed_.notify_all();
}

void SimulatedLines::put_back() {
  const std::lock_guard lock(mutex_);
  gone_ = false;
  edges_.clear();
}

}  // namespace turnpoint::panel

#include "station/io/simulated_lines.hpp"

#include <poll.h>

#include <algorithm>

#include "station/system/clocks.hpp"

namespace turnpoint::io {

void SimulatedLines::check(int index) const {
  if (gone_ || (index >= 0 && index == broken_))
    throw std::system_error(ENODEV, std::generic_category(), "simulated gpio chip");
}

std::optional<Edge> SimulatedLines::next_edge() {
  const std::lock_guard lock(mutex_);
  check();
  changed_.clear();
  if (edges_.empty()) return std::nullopt;
  const Edge edge = edges_.front();
  edges_.pop_front();
  return edge;
}

std::optional<Edge> SimulatedLines::wait(std::int64_t timeout_ns, int wake) {
  const std::int64_t end_ns = system::monotonic_ns() + timeout_ns;
  for (;;) {
    if (auto edge = next_edge()) return edge;
    const std::int64_t left_ns = std::max<std::int64_t>(0, end_ns - system::monotonic_ns());
    const timespec left{left_ns / 1'000'000'000, left_ns % 1'000'000'000};
    pollfd news[] = {{changed_.descriptor(), POLLIN, 0}, {wake, POLLIN, 0}};
    if (::ppoll(news, 2, &left, nullptr) == 0 || (news[1].revents & POLLIN) != 0) return next_edge();
  }
}

bool SimulatedLines::level(int index) {
  const std::lock_guard lock(mutex_);
  check(index);
  return levels_.at(static_cast<std::size_t>(index)) != 0;
}

void SimulatedLines::drive(int index, int level) {
  const std::lock_guard lock(mutex_);
  check();
  int& now = levels_.at(static_cast<std::size_t>(index));
  if (now != level) driven_.push_back({system::monotonic_ns(), index, level});
  now = level;
}

std::vector<SimulatedLines::Driven> SimulatedLines::driven() const {
  const std::lock_guard lock(mutex_);
  return driven_;
}

void SimulatedLines::change(int index, bool level, std::int64_t time_ns) {
  levels_.at(static_cast<std::size_t>(index)) = level ? 1 : 0;
  edges_.push_back({time_ns, index, level, ++sequences_.at(static_cast<std::size_t>(index))});
}

void SimulatedLines::set(int index, bool level, std::int64_t time_ns) {
  const std::lock_guard lock(mutex_);
  change(index, level, time_ns);
  changed_.ring();
}

void SimulatedLines::pulse(int index, std::int64_t time_ns, std::int64_t length_ns) {
  const std::lock_guard lock(mutex_);
  const bool level = levels_.at(static_cast<std::size_t>(index)) != 0;
  change(index, !level, time_ns);
  change(index, level, time_ns + length_ns);
  changed_.ring();
}

void SimulatedLines::lose_edges(int index, std::uint32_t count) {
  const std::lock_guard lock(mutex_);
  sequences_.at(static_cast<std::size_t>(index)) += count;
}

void SimulatedLines::remove() {
  const std::lock_guard lock(mutex_);
  gone_ = true;
  changed_.ring();
}

void SimulatedLines::break_line(int index) {
  const std::lock_guard lock(mutex_);
  broken_ = index;
}

void SimulatedLines::put_back() {
  const std::lock_guard lock(mutex_);
  gone_ = false;
  edges_.clear();
}

namespace {

constexpr std::int64_t monostable_ns = 110'000'000;

/// Lets the guard use lines that somebody else owns and may change.
class Shared : public Lines {
 public:
  explicit Shared(std::shared_ptr<SimulatedAmplifierLines> lines) : lines_(std::move(lines)) {}
  std::optional<Edge> wait(std::int64_t timeout_ns, int wake) override {
    return lines_->wait(timeout_ns, wake);
  }
  bool level(int index) override { return lines_->level(index); }
  void drive(int index, int level) override { lines_->drive(index, level); }
  std::optional<bool> read_back(int index) override { return lines_->read_back(index); }

 private:
  std::shared_ptr<SimulatedAmplifierLines> lines_;
};

}  // namespace

bool SimulatedAmplifierLines::level(int index) {
  if (index != kSimulatedAmplifier.gate) return SimulatedLines::level(index);
  if (broken_ || !SimulatedLines::level(kSimulatedAmplifier.enable)) return false;
  const auto edge_ns = last_edge_ns_.load();
  return bridged_ || (edge_ns >= 0 && system::monotonic_ns() - edge_ns <= monostable_ns);
}

void SimulatedAmplifierLines::drive(int index, int level) {
  SimulatedLines::drive(index, level);
  if (index == kSimulatedAmplifier.heartbeat && heartbeat_.exchange(level) != level)
    last_edge_ns_ = system::monotonic_ns();
}

std::unique_ptr<audio::Amplifier> simulated_amplifier(const std::shared_ptr<SimulatedAmplifierLines>& lines) {
  return guard_amplifier([lines] { return std::make_unique<Shared>(lines); }, kSimulatedAmplifier);
}

}  // namespace turnpoint::io

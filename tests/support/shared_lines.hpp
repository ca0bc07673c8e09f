#pragma once
#include <cstdint>
#include <memory>

#include "station/io/guarded_amplifier.hpp"
#include "station/io/simulated_lines.hpp"

/// Simulated lines for an amplifier with the real guard. The test can change their levels, and read a log of
/// all changes at the end.
struct SharedLines : turnpoint::io::Lines {
  static constexpr int enable = 0, heartbeat = 1, fault = 2, stop = 3, count = 4;

  explicit SharedLines(std::shared_ptr<turnpoint::io::SimulatedLines> shared) : lines(std::move(shared)) {}
  std::optional<turnpoint::io::Edge> wait(std::int64_t timeout_ns, int wake) override {
    return lines->wait(timeout_ns, wake);
  }
  bool level(int index) override { return lines->level(index); }
  void drive(int index, int level) override { lines->drive(index, level); }
  std::optional<bool> read_back(int index) override { return lines->read_back(index); }

  std::shared_ptr<turnpoint::io::SimulatedLines> lines;
};

/// Returns a function that opens the lines. Like that of a real chip, it fails while the chip is missing.
inline turnpoint::io::OpenLines opener(const std::shared_ptr<turnpoint::io::SimulatedLines>& lines) {
  return [lines] {
    static_cast<void>(lines->level(0));
    return std::make_unique<SharedLines>(lines);
  };
}

inline auto guarded(const std::shared_ptr<turnpoint::io::SimulatedLines>& lines) {
  return turnpoint::io::guard_amplifier(
      opener(lines), {SharedLines::enable, SharedLines::heartbeat, SharedLines::fault, SharedLines::stop});
}

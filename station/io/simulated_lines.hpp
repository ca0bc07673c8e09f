#pragma once
#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "station/audio/amplifier.hpp"
#include "station/io/guarded_amplifier.hpp"
#include "station/io/lines.hpp"
#include "station/system/wake_up.hpp"

namespace turnpoint::io {

/// Lines without hardware, for development and tests: inputs are set by hand, and outputs can be read back.
/// All functions may be called from any thread.
class SimulatedLines : public Lines {
 public:
  explicit SimulatedLines(int count)
      : levels_(static_cast<std::size_t>(count), 0), sequences_(levels_.size(), 0) {}

  std::optional<Edge> wait(std::int64_t timeout_ns, int wake = -1) override;
  bool level(int index) override;
  void drive(int index, int level) override;
  std::optional<bool> read_back(int index) override { return level(index); }

  /// Sets the level of an input, with this time stamp.
  void set(int index, bool level, std::int64_t time_ns);
  /// Changes an input and changes it back after `length_ns`; both edges are available at once.
  void pulse(int index, std::int64_t time_ns, std::int64_t length_ns);
  /// Drops this number of edges, as if the kernel's buffer had no room for them.
  void lose_edges(int index, std::uint32_t count);
  /// One change of an output: which output, its new level, and when.
  struct Driven {
    std::int64_t time_ns = 0;
    int line = 0;
    int level = 0;
  };
  std::vector<Driven> driven() const;
  /// Unplugs the chip: every further call throws ENODEV until the chip is plugged in again. Outputs are then
  /// low.
  void remove();
  void put_back();
  /// Breaks one line, as if its chip were unplugged while that of the other lines stays: reading it throws
  /// ENODEV.
  void break_line(int index);

 private:
  void check(int index = -1) const;
  std::optional<Edge> next_edge();
  void change(int index, bool level, std::int64_t time_ns);

  mutable std::mutex mutex_;
  system::WakeUp changed_;
  std::deque<Edge> edges_;
  std::vector<int> levels_;
  std::vector<std::uint32_t> sequences_;
  std::vector<Driven> driven_;
  bool gone_ = false;
  int broken_ = -1;  ///< the line of break_line()
};

/// The index of each line of a simulated amplifier: enable, heartbeat, fault, stop, gate.
inline constexpr GuardLines kSimulatedAmplifier{0, 1, 2, 3, 4};

/// The lines of a simulated amplifier, with the monostable and the gate of deploy/README.md: the gate is open
/// while the enable line is high and the last edge of the heartbeat is not older than 110 ms.
class SimulatedAmplifierLines : public SimulatedLines {
 public:
  SimulatedAmplifierLines() : SimulatedLines(5) {}

  bool level(int index) override;
  void drive(int index, int level) override;

  /// Faults of the wiring. bridge_monostable(): the gate stays open while the enable line is high, whatever
  /// the heartbeat does. break_gate(): the gate never opens.
  void bridge_monostable() noexcept { bridged_ = true; }
  void break_gate() noexcept { broken_ = true; }

 private:
  std::atomic<std::int64_t> last_edge_ns_{-1};
  std::atomic<int> heartbeat_{0};
  std::atomic<bool> bridged_{false}, broken_{false};
};

/// Makes an amplifier that uses these simulated lines and is supervised by the same guard (guard.hpp) as a
/// real one. The caller may change the lines at any time.
std::unique_ptr<audio::Amplifier> simulated_amplifier(const std::shared_ptr<SimulatedAmplifierLines>& lines);

}  // namespace turnpoint::io

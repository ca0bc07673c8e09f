#pragma once
#include <atomic>
#include <cstdint>
#include <memory>

#include "station/drive/amplifier.hpp"
#include "station/lines/guarded_amplifier.hpp"
#include "station/lines/simulated_lines.hpp"

namespace turnpoint::lines {

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
std::unique_ptr<drive::Amplifier> simulated_amplifier(const std::shared_ptr<SimulatedAmplifierLines>& lines);

}  // namespace turnpoint::lines

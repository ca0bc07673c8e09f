#include "station/lines/simulated_amplifier.hpp"

#include "station/system/clocks.hpp"

namespace turnpoint::lines {
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

std::unique_ptr<drive::Amplifier> simulated_amplifier(const std::shared_ptr<SimulatedAmplifierLines>& lines) {
  return guard_amplifier([lines] { return std::make_unique<Shared>(lines); }, kSimulatedAmplifier);
}

}  // namespace turnpoint::lines

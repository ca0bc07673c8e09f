#include "station/drive/amplifier.hpp"

#include <stdexcept>

#include "station/drive/monotonic.hpp"

namespace turnpoint::drive {
namespace {

class SimulatedAmplifier final : public Amplifier {
 public:
  void arm() override {
    if (state_ == AmplifierState::faulted)
      throw std::runtime_error("amplifier sim: cannot be armed: " + fault_);
    if (state_ == AmplifierState::disarmed) state_ = AmplifierState::armed;
  }
  void disarm() noexcept override {
    if (state_ != AmplifierState::faulted) state_ = AmplifierState::disarmed;
  }
  void enable() override {
    if (state_ != AmplifierState::armed && state_ != AmplifierState::enabled)
      throw std::runtime_error(std::string("amplifier sim: cannot be enabled while ") + name(state_));
    state_ = AmplifierState::enabled;
  }
  void disable() noexcept override {
    if (state_ == AmplifierState::enabled) state_ = AmplifierState::armed;
  }
  void trip(std::string_view reason) noexcept override {
    if (state_ == AmplifierState::faulted) return;
    state_ = AmplifierState::faulted;
    fault_ = reason;
    fault_time_ns_ = monotonic_ns();
  }
  void clear() override {
    if (state_ == AmplifierState::faulted) state_ = AmplifierState::disarmed;
    fault_.clear();
  }
  void audio_alive() noexcept override {}
  void session_alive() noexcept override {}
  AmplifierState state() const noexcept override { return state_; }
  std::string fault() const override { return fault_; }
  std::int64_t fault_time_ns() const noexcept override { return fault_time_ns_; }
  std::int64_t reaction_ns() const noexcept override { return -1; }

 private:
  AmplifierState state_ = AmplifierState::disarmed;
  std::string fault_;
  std::int64_t fault_time_ns_ = 0;
};

}  // namespace

const char* name(AmplifierState state) {
  switch (state) {
    case AmplifierState::disarmed:
      return "disarmed";
    case AmplifierState::armed:
      return "armed";
    case AmplifierState::enabled:
      return "enabled";
    case AmplifierState::faulted:
      return "faulted";
  }
  return "?";
}

std::unique_ptr<Amplifier> simulated_amplifier() { return std::make_unique<SimulatedAmplifier>(); }

}  // namespace turnpoint::drive

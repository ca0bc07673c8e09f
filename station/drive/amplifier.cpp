#include "station/drive/amplifier.hpp"

#include "station/drive/monotonic.hpp"

namespace turnpoint::drive {
namespace {

class SimulatedAmplifier final : public Amplifier {
 public:
  Refusal arm() override {
    if (state_ == AmplifierState::faulted) return fault_;
    if (state_ == AmplifierState::disarmed) state_ = AmplifierState::armed;
    return std::nullopt;
  }
  void disarm() noexcept override {
    if (state_ != AmplifierState::faulted) state_ = AmplifierState::disarmed;
  }
  Refusal enable() override {
    if (state_ == AmplifierState::faulted) return fault_;
    if (state_ == AmplifierState::disarmed) return terms::Fault{terms::FaultKind::disarmed, ""};
    state_ = AmplifierState::enabled;
    return std::nullopt;
  }
  void disable() noexcept override {
    if (state_ == AmplifierState::enabled) state_ = AmplifierState::armed;
  }
  void trip(terms::FaultKind kind, std::string_view detail) noexcept override {
    if (state_ == AmplifierState::faulted) return;
    state_ = AmplifierState::faulted;
    fault_ = {{kind, std::string(detail)}, monotonic_ns()};
  }
  Refusal clear() override {
    if (state_ == AmplifierState::faulted) state_ = AmplifierState::disarmed;
    return std::nullopt;
  }
  void audio_alive() noexcept override {}
  void session_alive() noexcept override {}
  void page_alive(std::int64_t) noexcept override {}
  AmplifierState state() const noexcept override { return state_; }
  AmplifierFault fault() const override { return fault_; }
  std::int64_t reaction_ns() const noexcept override { return -1; }

 private:
  AmplifierState state_ = AmplifierState::disarmed;
  AmplifierFault fault_;
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

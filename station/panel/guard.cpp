#include "station/panel/guard.hpp"

namespace turnpoint::panel {

using drive::AmplifierState;

// Who has not been heard of for too long; "" while both are alive.
std::string Guard::silent(std::int64_t now_ns) const {
  if (audio_seen_ns_ < 0 || now_ns - audio_seen_ns_ > config_.audio_timeout_ns)
    return "the audio thread gives no sign";
  if (session_seen_ns_ < 0 || now_ns - session_seen_ns_ > config_.session_timeout_ns)
    return "the session gives no sign";
  return "";
}

std::string Guard::arm(std::int64_t now_ns) {
  if (fault_active_) return "the amplifier's fault line is active";
  if (stop_active_) return "the stop is pressed";
  if (state_ == AmplifierState::faulted) return "latched fault, clear it first: " + fault_;
  if (const std::string who = silent(now_ns); !who.empty()) return who;
  if (state_ == AmplifierState::disarmed) state_ = AmplifierState::armed;
  return "";
}

std::string Guard::enable(std::int64_t now_ns) {
  if (state_ == AmplifierState::faulted) return "latched fault: " + fault_;
  if (state_ == AmplifierState::disarmed) return "disarmed: an operator has to arm it";
  if (const std::string who = silent(now_ns); !who.empty()) return who;
  state_ = AmplifierState::enabled;
  return "";
}

std::string Guard::clear() {
  if (fault_active_) return "the amplifier's fault line is still active";
  if (stop_active_) return "the stop is still pressed";
  if (state_ == AmplifierState::faulted) state_ = AmplifierState::disarmed;
  fault_.clear();
  return "";
}

void Guard::disarm() noexcept {
  if (state_ != AmplifierState::faulted) state_ = AmplifierState::disarmed;
}

void Guard::disable() noexcept {
  if (state_ == AmplifierState::enabled) state_ = AmplifierState::armed;
}

void Guard::fault_line(std::int64_t time_ns, bool active) {
  fault_active_ = active;
  if (active) trip(time_ns, "the amplifier reports a fault");
}

void Guard::stop_line(std::int64_t time_ns, bool active) {
  stop_active_ = active;
  if (active) trip(time_ns, "the stop was pressed");
}

void Guard::trip(std::int64_t time_ns, std::string_view reason) {
  if (state_ == AmplifierState::faulted) return;  // the first cause is kept
  state_ = AmplifierState::faulted;
  fault_ = reason;
  fault_time_ns_ = time_ns;
}

void Guard::tick(std::int64_t now_ns) {
  const std::string who = silent(now_ns);
  if (!who.empty() && state_ == AmplifierState::enabled) trip(now_ns, who);
  if (now_ns < next_toggle_ns_) return;
  next_toggle_ns_ = now_ns + config_.toggle_ns;
  if (who.empty()) heartbeat_ = 1 - heartbeat_;
}

}  // namespace turnpoint::panel

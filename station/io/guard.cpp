#include "station/io/guard.hpp"

namespace turnpoint::io {

using audio::AmplifierState;
using core::FaultKind;

/// Returns the kind of thread that has not reported for too long, if any.
std::optional<FaultKind> Guard::silent(std::int64_t now_ns) const noexcept {
  if (audio_seen_ns_ < 0 || now_ns - audio_seen_ns_ > config_.audio_timeout_ns)
    return FaultKind::audio_silent;
  if (session_seen_ns_ < 0 || now_ns - session_seen_ns_ > config_.session_timeout_ns)
    return FaultKind::session_silent;
  if (page_seen_ns_ >= 0 && now_ns - page_seen_ns_ > config_.page_timeout_ns) return FaultKind::page_silent;
  return std::nullopt;
}

/// Returns a fault that is still present, if any. It would make the guard switch the amplifier off again.
std::optional<FaultKind> Guard::present() const noexcept {
  if (fault_active_) return FaultKind::amplifier;
  if (stop_active_) return FaultKind::stop_pressed;
  if (stuck_high_) return FaultKind::enable_line;
  return std::nullopt;
}

std::optional<Guard::Refusal> Guard::arm(std::int64_t now_ns) noexcept {
  if (const auto cause = present()) return Refusal{*cause};
  if (state_ == AmplifierState::faulted) return Refusal{fault_.kind, true};
  if (const auto who = silent(now_ns)) return Refusal{*who};
  if (state_ == AmplifierState::disarmed) state_ = AmplifierState::armed;
  return std::nullopt;
}

std::optional<Guard::Refusal> Guard::enable(std::int64_t now_ns) noexcept {
  if (state_ == AmplifierState::faulted) return Refusal{fault_.kind, true};
  if (state_ == AmplifierState::disarmed) return Refusal{FaultKind::disarmed};
  if (const auto who = silent(now_ns)) return Refusal{*who};
  state_ = AmplifierState::enabled;
  return std::nullopt;
}

std::optional<Guard::Refusal> Guard::clear() noexcept {
  if (const auto cause = present()) return Refusal{*cause};
  if (state_ == AmplifierState::faulted) state_ = AmplifierState::disarmed;
  fault_ = {};
  return std::nullopt;
}

void Guard::disarm() noexcept {
  if (state_ != AmplifierState::faulted) state_ = AmplifierState::disarmed;
}

void Guard::disable() noexcept {
  if (state_ == AmplifierState::enabled) state_ = AmplifierState::armed;
}

void Guard::fault_line(std::int64_t time_ns, bool active) noexcept {
  fault_active_ = active;
  if (active) trip(time_ns, FaultKind::amplifier);
}

void Guard::stop_line(std::int64_t time_ns, bool active) noexcept {
  stop_active_ = active;
  if (active) trip(time_ns, FaultKind::stop_pressed);
}

void Guard::enable_line(std::int64_t time_ns, bool level) noexcept {
  const bool wanted = state_ == AmplifierState::enabled;
  stuck_high_ = level && !wanted;
  if (level != wanted)
    trip(time_ns, FaultKind::enable_line,
         wanted ? "the line was set high but reads low" : "the line was set low but reads high");
}

void Guard::trip(std::int64_t time_ns, FaultKind kind, const char* detail) noexcept {
  // keep the first fault, because it is the cause of later ones
  if (state_ == AmplifierState::faulted) return;
  state_ = AmplifierState::faulted;
  fault_ = {kind, detail, time_ns};
}

void Guard::tick(std::int64_t now_ns) noexcept {
  const auto who = silent(now_ns);
  if (who && state_ == AmplifierState::enabled) trip(now_ns, *who);
  if (now_ns < next_toggle_ns_) return;
  next_toggle_ns_ = now_ns + config_.toggle_ns;
  if (!who && !stuck_high_) heartbeat_ = 1 - heartbeat_;
}

}  // namespace turnpoint::io

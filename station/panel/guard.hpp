#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "station/drive/amplifier.hpp"

namespace turnpoint::panel {

/// What the guard wants of the lines after a step.
struct GuardOutputs {
  int enable = 0;
  int heartbeat = 0;
};

/// The amplifier's safety rules as a pure machine: latched faults, arming by an operator, and a heartbeat
/// that toggles only while audio and session both prove that they are alive. Time is CLOCK_MONOTONIC in ns;
/// no thread, no lines.
class Guard {
 public:
  struct Config {
    std::int64_t toggle_ns = 10'000'000;              ///< half a heartbeat
    std::int64_t audio_timeout_ns = 100'000'000;      ///< without a sign of the audio thread
    std::int64_t session_timeout_ns = 2'000'000'000;  ///< without a sign of the session
  };

  Guard() noexcept : Guard(Config{}) {}
  explicit Guard(const Config& config) noexcept : config_(config) {}

  /// Operator and session. The reason why not, or "".
  [[nodiscard]] std::string arm(std::int64_t now_ns);
  [[nodiscard]] std::string enable(std::int64_t now_ns);
  [[nodiscard]] std::string clear();
  void disarm() noexcept;
  void disable() noexcept;

  /// Lines and faults. `active` is the level after the edge.
  void fault_line(std::int64_t time_ns, bool active);
  void stop_line(std::int64_t time_ns, bool active);
  void trip(std::int64_t time_ns, std::string_view reason);

  /// Signs of life, and the passing of time.
  void audio_alive(std::int64_t now_ns) noexcept { audio_seen_ns_ = now_ns; }
  void session_alive(std::int64_t now_ns) noexcept { session_seen_ns_ = now_ns; }
  void tick(std::int64_t now_ns);
  std::int64_t next_tick_ns() const noexcept { return next_toggle_ns_; }

  GuardOutputs outputs() const noexcept {
    return {state_ == drive::AmplifierState::enabled ? 1 : 0, heartbeat_};
  }
  drive::AmplifierState state() const noexcept { return state_; }
  const std::string& fault() const noexcept { return fault_; }
  std::int64_t fault_time_ns() const noexcept { return fault_time_ns_; }

 private:
  std::string silent(std::int64_t now_ns) const;

  Config config_;
  drive::AmplifierState state_ = drive::AmplifierState::disarmed;
  bool fault_active_ = false, stop_active_ = false;
  std::string fault_;
  std::int64_t fault_time_ns_ = 0;
  std::int64_t audio_seen_ns_ = -1, session_seen_ns_ = -1;
  std::int64_t next_toggle_ns_ = 0;
  int heartbeat_ = 0;
};

}  // namespace turnpoint::panel

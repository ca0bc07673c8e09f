#pragma once
#include <cstdint>
#include <optional>

#include "station/audio/amplifier.hpp"
#include "station/core/fault.hpp"

namespace turnpoint::io {

/// The levels to which the guard's output lines are to be set after a step of its state machine.
struct GuardOutputs {
  int enable = 0;
  int heartbeat = 0;
};

/// The amplifier's safety rules as a pure state machine: faults that are latched, arming by an operator, and
/// a heartbeat that toggles only while audio, session and page all report that they are alive. Time is
/// CLOCK_MONOTONIC in ns. Uses no threads, no lines and no heap memory.
class Guard {
 public:
  struct Config {
    std::int64_t toggle_ns = 10'000'000;              ///< half a period of the heartbeat
    std::int64_t audio_timeout_ns = 100'000'000;      ///< longest time without a report from the audio thread
    std::int64_t session_timeout_ns = 2'000'000'000;  ///< longest time without a report from the session
    std::int64_t page_timeout_ns =
        2'000'000'000;  ///< longest time without a report from the participant's page
  };

  /// Why a command is refused: the current problem, or the latched fault that has to be cleared first.
  struct Refusal {
    core::FaultKind kind = core::FaultKind::other;
    bool latched = false;
  };
  /// The latched fault, which stays until somebody clears it. Its detail is a string literal.
  struct Fault {
    core::FaultKind kind = core::FaultKind::other;
    const char* detail = "";
    std::int64_t time_ns = 0;
  };

  Guard() noexcept : Guard(Config{}) {}
  explicit Guard(const Config& config) noexcept : config_(config) {}

  /// Commands of the operator and the session. Each returns the reason for a refusal, or nothing on success.
  [[nodiscard]] std::optional<Refusal> arm(std::int64_t now_ns) noexcept;
  [[nodiscard]] std::optional<Refusal> enable(std::int64_t now_ns) noexcept;
  [[nodiscard]] std::optional<Refusal> clear() noexcept;
  void disarm() noexcept;
  void disable() noexcept;

  /// Report the level of the fault line or the stop line, after an edge or after reading the line.
  void fault_line(std::int64_t time_ns, bool active) noexcept;
  void stop_line(std::int64_t time_ns, bool active) noexcept;
  /// Reports the actual level of the enable line. If it is high although it was set low, the heartbeat ends
  /// too, so that the external monitor switches the amplifier off.
  void enable_line(std::int64_t time_ns, bool level) noexcept;
  void trip(std::int64_t time_ns, core::FaultKind kind, const char* detail = "") noexcept;

  /// Report that a thread is alive or, for tick(), that time has passed. After the page's first report, the
  /// guard expects the page to keep reporting.
  void audio_alive(std::int64_t now_ns) noexcept { audio_seen_ns_ = now_ns; }
  void session_alive(std::int64_t now_ns) noexcept { session_seen_ns_ = now_ns; }
  void page_alive(std::int64_t now_ns) noexcept { page_seen_ns_ = now_ns; }
  void tick(std::int64_t now_ns) noexcept;
  std::int64_t next_tick_ns() const noexcept { return next_toggle_ns_; }

  GuardOutputs outputs() const noexcept {
    return {state_ == audio::AmplifierState::enabled ? 1 : 0, heartbeat_};
  }
  audio::AmplifierState state() const noexcept { return state_; }
  const Fault& fault() const noexcept { return fault_; }

 private:
  std::optional<core::FaultKind> silent(std::int64_t now_ns) const noexcept;
  std::optional<core::FaultKind> present() const noexcept;

  Config config_;
  audio::AmplifierState state_ = audio::AmplifierState::disarmed;
  bool fault_active_ = false, stop_active_ = false, stuck_high_ = false;
  Fault fault_;
  std::int64_t audio_seen_ns_ = -1, session_seen_ns_ = -1, page_seen_ns_ = -1;
  std::int64_t next_toggle_ns_ = 0;
  int heartbeat_ = 0;
};

}  // namespace turnpoint::io

#pragma once
#include <cstdint>
#include <optional>

#include "station/drive/amplifier.hpp"
#include "station/terms/fault.hpp"

namespace turnpoint::lines {

/// What the guard wants of the lines after a step.
struct GuardOutputs {
  int enable = 0;
  int heartbeat = 0;
};

/// The amplifier's safety rules as a pure machine: latched faults, arming by an operator, and a heartbeat
/// that toggles only while audio, session and page all prove that they are alive. Time is CLOCK_MONOTONIC in
/// ns; no thread, no lines, no memory from the heap.
class Guard {
 public:
  struct Config {
    std::int64_t toggle_ns = 10'000'000;              ///< half a heartbeat
    std::int64_t audio_timeout_ns = 100'000'000;      ///< without a sign of the audio thread
    std::int64_t session_timeout_ns = 2'000'000'000;  ///< without a sign of the session
    std::int64_t page_timeout_ns = 2'000'000'000;     ///< without a sign of the participant's page
  };

  /// Why something is not done: what is wrong now, or the latched fault that has to be cleared first.
  struct Refusal {
    terms::FaultKind kind = terms::FaultKind::other;
    bool latched = false;
  };
  /// What latched the fault; the detail is a constant.
  struct Fault {
    terms::FaultKind kind = terms::FaultKind::other;
    const char* detail = "";
    std::int64_t time_ns = 0;
  };

  Guard() noexcept : Guard(Config{}) {}
  explicit Guard(const Config& config) noexcept : config_(config) {}

  /// Operator and session. The reason why not, or none.
  [[nodiscard]] std::optional<Refusal> arm(std::int64_t now_ns) noexcept;
  [[nodiscard]] std::optional<Refusal> enable(std::int64_t now_ns) noexcept;
  [[nodiscard]] std::optional<Refusal> clear() noexcept;
  void disarm() noexcept;
  void disable() noexcept;

  /// Lines and faults. `active` is the level after an edge, or as it was read.
  void fault_line(std::int64_t time_ns, bool active) noexcept;
  void stop_line(std::int64_t time_ns, bool active) noexcept;
  /// The level that the enable line really has. One that is high although it is driven low also ends the
  /// heartbeat, so that what monitors it outside switches the amplifier off.
  void enable_line(std::int64_t time_ns, bool level) noexcept;
  void trip(std::int64_t time_ns, terms::FaultKind kind, const char* detail = "") noexcept;

  /// Signs of life, and the passing of time. The page is expected to live from its first sign on.
  void audio_alive(std::int64_t now_ns) noexcept { audio_seen_ns_ = now_ns; }
  void session_alive(std::int64_t now_ns) noexcept { session_seen_ns_ = now_ns; }
  void page_alive(std::int64_t now_ns) noexcept { page_seen_ns_ = now_ns; }
  void tick(std::int64_t now_ns) noexcept;
  std::int64_t next_tick_ns() const noexcept { return next_toggle_ns_; }

  GuardOutputs outputs() const noexcept {
    return {state_ == drive::AmplifierState::enabled ? 1 : 0, heartbeat_};
  }
  drive::AmplifierState state() const noexcept { return state_; }
  const Fault& fault() const noexcept { return fault_; }

 private:
  std::optional<terms::FaultKind> silent(std::int64_t now_ns) const noexcept;
  std::optional<terms::FaultKind> present() const noexcept;

  Config config_;
  drive::AmplifierState state_ = drive::AmplifierState::disarmed;
  bool fault_active_ = false, stop_active_ = false, stuck_high_ = false;
  Fault fault_;
  std::int64_t audio_seen_ns_ = -1, session_seen_ns_ = -1, page_seen_ns_ = -1;
  std::int64_t next_toggle_ns_ = 0;
  int heartbeat_ = 0;
};

}  // namespace turnpoint::lines

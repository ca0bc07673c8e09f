#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "station/terms/fault.hpp"

namespace turnpoint::drive {

/// disarmed: the line stays low until an operator arms the amplifier.
/// armed: the line is low, and sound is allowed.
/// enabled: the line is high.
/// faulted: the line is low and stays low until an operator clears the fault.
enum class AmplifierState { disarmed, armed, enabled, faulted };
const char* name(AmplifierState state);

/// The fault that latched the line low, and its time (CLOCK_MONOTONIC, ns).
struct AmplifierFault : terms::Fault {
  std::int64_t time_ns = 0;
};

/// The power amplifier behind the converter. Only its own guard thread drives the enable line, so the line
/// goes low within a millisecond of a fault, whatever the callers of these functions are doing. Call these
/// functions from ordinary threads; audio_alive() is for the audio thread. They wait for the guard; the guard
/// never waits for them.
class Amplifier {
 public:
  virtual ~Amplifier() = default;

  /// The reason for a refusal; empty on success.
  using Refusal = std::optional<terms::Fault>;

  /// Only an operator may call this. It is required after a start, a device loss or a cleared fault. Refused
  /// while a fault is present or the emergency stop is pressed.
  [[nodiscard]] virtual Refusal arm() = 0;
  /// Sets the line low at once. This is not a fault.
  virtual void disarm() noexcept = 0;
  /// Sets the line high. Call this while the stream is silent, then ramp in. Refused unless armed.
  [[nodiscard]] virtual Refusal enable() = 0;
  /// Sets the line low but stays armed. Call this once the stream is silent.
  virtual void disable() noexcept = 0;
  /// Latches the line low for a fault that the station detected itself. If there is a fault already, that one
  /// is kept.
  virtual void trip(terms::FaultKind kind, std::string_view detail) noexcept = 0;
  /// For the operator: clears a latched fault if its cause is gone. The amplifier is disarmed afterwards.
  [[nodiscard]] virtual Refusal clear() = 0;

  /// Each of these reports that its caller is still running: the audio thread, the session, and the
  /// participant's page from its first report on (a session without a screen has no page). The heartbeat line
  /// toggles only while all of them report. These functions never block.
  virtual void audio_alive() noexcept = 0;
  virtual void session_alive() noexcept = 0;
  virtual void page_alive(std::int64_t time_ns) noexcept = 0;

  virtual AmplifierState state() const noexcept = 0;
  /// The latched fault; valid while the state is `faulted`.
  virtual AmplifierFault fault() const = 0;
  /// Time from the kernel's time stamp of the last fault or stop signal until the enable line was low; -1 if
  /// there was none yet.
  virtual std::int64_t reaction_ns() const noexcept = 0;
};

}  // namespace turnpoint::drive

#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "station/core/fault.hpp"

namespace turnpoint::audio {

/// disarmed: the enable line stays low until an operator arms the amplifier.
/// armed: the line is low until enable() sets it high.
/// enabled: the line is high, so the amplifier is on.
/// faulted: the line is low and stays low until an operator clears the fault.
enum class AmplifierState { disarmed, armed, enabled, faulted };
const char* name(AmplifierState state);

/// The fault that set the enable line low, and its time (CLOCK_MONOTONIC, ns).
struct AmplifierFault : core::Fault {
  std::int64_t time_ns = 0;
};

/// The power amplifier behind the converter. Its guard thread alone drives the enable line, so the line goes
/// low within a millisecond of a fault, whatever other threads are doing. Call these functions from ordinary
/// threads, except audio_alive(), which is for the audio thread. Callers wait for the guard; the guard never
/// waits for callers.
class Amplifier {
 public:
  virtual ~Amplifier() = default;

  /// The reason for a refusal; empty on success.
  using Refusal = std::optional<core::Fault>;

  /// Allows enable(). Only an operator may request this. It is required after a start, a device loss or a
  /// cleared fault. Refused while a fault is present or the emergency stop is pressed.
  [[nodiscard]] virtual Refusal arm() = 0;
  /// Sets the enable line low at once. This does not count as a fault.
  virtual void disarm() noexcept = 0;
  /// Sets the enable line high. Call this while the stream is silent, then start the sound with a ramp.
  /// Refused unless armed.
  [[nodiscard]] virtual Refusal enable() = 0;
  /// Sets the enable line low; the amplifier stays armed. Call this once the stream is silent.
  virtual void disable() noexcept = 0;
  /// Sets the enable line low for a fault that the station detected itself, and keeps it low until clear().
  /// If there is a fault already, fault() continues to report the first one.
  virtual void trip(core::FaultKind kind, std::string_view detail) noexcept = 0;
  /// Clears a fault if its cause is gone; only an operator may request this. The amplifier is disarmed
  /// afterwards.
  [[nodiscard]] virtual Refusal clear() = 0;

  /// Each of these three functions reports that its caller is still running: the audio thread, the session,
  /// or the participant's page. The heartbeat line toggles only while all callers report. The page is
  /// expected to report only after its first report, because a session without a screen has no page. These
  /// functions never block.
  virtual void audio_alive() noexcept = 0;
  virtual void session_alive() noexcept = 0;
  virtual void page_alive(std::int64_t time_ns) noexcept = 0;

  /// For the self-test. Holds the heartbeat line at its present level until resume_heartbeat() is called. The
  /// external monitor must then switch the amplifier off although the enable line is high. Everything else
  /// continues.
  virtual void hold_heartbeat() noexcept {}
  virtual void resume_heartbeat() noexcept {}
  /// The level of the gate behind the external monitor: true while the monitor allows the amplifier to be on.
  /// It is read at least every millisecond while the enable line is high. Empty if the rig has no line that
  /// reads it.
  virtual std::optional<bool> gate() const noexcept { return std::nullopt; }

  virtual AmplifierState state() const noexcept = 0;
  /// The fault that set the enable line low; valid while the state is `faulted`.
  virtual AmplifierFault fault() const = 0;
  /// Time from the last fault or stop signal, by the kernel's time stamp, until the enable line was low; -1
  /// if there was none yet.
  virtual std::int64_t reaction_ns() const noexcept = 0;
};

}  // namespace turnpoint::audio

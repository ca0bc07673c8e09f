#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "station/terms/fault.hpp"

namespace turnpoint::drive {

/// disarmed: line low until an operator arms. armed: line low, sound allowed. enabled: line high.
/// faulted: line low and latched until an operator clears it.
enum class AmplifierState { disarmed, armed, enabled, faulted };
const char* name(AmplifierState state);

/// What latched the line low, and when (CLOCK_MONOTONIC, ns).
struct AmplifierFault : terms::Fault {
  std::int64_t time_ns = 0;
};

/// The power amplifier behind the converter. A guard thread of its own drives the line, and nothing else
/// does: the line goes low within a millisecond of a fault whatever the callers of these functions do. They
/// are for ordinary threads, except audio_alive(). All of them wait for the guard, never the other way round.
class Amplifier {
 public:
  virtual ~Amplifier() = default;

  /// Why not, or none when it was done.
  using Refusal = std::optional<terms::Fault>;

  /// By the operator only; always needed after a start, a device loss or a cleared fault. Refused while a
  /// fault or the stop is present.
  [[nodiscard]] virtual Refusal arm() = 0;
  /// Line low, at once; not a fault.
  virtual void disarm() noexcept = 0;
  /// Line high. Call while the stream is silent, then ramp in. Refused unless armed.
  [[nodiscard]] virtual Refusal enable() = 0;
  /// Line low, still armed. Call once the stream is silent.
  virtual void disable() noexcept = 0;
  /// Line low and latched, for a reason that the station found itself; the first reason is kept.
  virtual void trip(terms::FaultKind kind, std::string_view detail) noexcept = 0;
  /// By the operator: drops a latched fault whose cause is gone; then disarmed.
  [[nodiscard]] virtual Refusal clear() = 0;

  /// Proof of life: audio and session each say that they are alive, and the participant's page does so from
  /// its first sign on (a session without a screen has none). The heartbeat line toggles only while all do.
  /// They return at once.
  virtual void audio_alive() noexcept = 0;
  virtual void session_alive() noexcept = 0;
  virtual void page_alive(std::int64_t time_ns) noexcept = 0;

  virtual AmplifierState state() const noexcept = 0;
  /// What latched the fault; meaningful while the state is `faulted`.
  virtual AmplifierFault fault() const = 0;
  /// From the kernel's stamp of the last fault or stop edge until the line was low; -1 before there was one.
  virtual std::int64_t reaction_ns() const noexcept = 0;
};

}  // namespace turnpoint::drive

#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace turnpoint::drive {

/// disarmed: line low until an operator arms. armed: line low, sound allowed. enabled: line high.
/// faulted: line low and latched until an operator clears it.
enum class AmplifierState { disarmed, armed, enabled, faulted };
const char* name(AmplifierState state);

/// The power amplifier behind the converter. Functions are for the session thread; the line itself is watched
/// by the guard's own thread and goes low within a millisecond of a fault whatever the session does.
class Amplifier {
 public:
  virtual ~Amplifier() = default;

  /// By the operator only; always needed after a start, a device loss or a cleared fault. Throws
  /// std::runtime_error while a fault or the stop is present.
  virtual void arm() = 0;
  /// Line low, at once; not a fault.
  virtual void disarm() noexcept = 0;
  /// Line high. Call while the stream is silent, then ramp in. Throws std::runtime_error unless armed.
  virtual void enable() = 0;
  /// Line low, still armed. Call once the stream is silent.
  virtual void disable() noexcept = 0;
  /// Line low and latched, for a reason that the station found itself.
  virtual void trip(std::string_view reason) noexcept = 0;
  /// By the operator: drops a latched fault whose cause is gone; then disarmed.
  virtual void clear() = 0;

  /// Proof of life: audio and session each say that they are alive. The heartbeat line toggles only while
  /// both do.
  virtual void audio_alive() noexcept = 0;
  virtual void session_alive() noexcept = 0;

  virtual AmplifierState state() const noexcept = 0;
  /// What latched the fault, "" otherwise; and when (CLOCK_MONOTONIC, ns).
  virtual std::string fault() const = 0;
  virtual std::int64_t fault_time_ns() const noexcept = 0;
  /// From the kernel's stamp of the last fault or stop edge until the line was low; -1 before there was one.
  virtual std::int64_t reaction_ns() const noexcept = 0;
};

/// An amplifier without hardware: the same states, no lines. Product code for `sim:`.
std::unique_ptr<Amplifier> simulated_amplifier();

}  // namespace turnpoint::drive

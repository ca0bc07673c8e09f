#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include "station/session/fault.hpp"
#include "station/trial/machine.hpp"

namespace turnpoint::session {

enum class InputKind {
  answer,       ///< value = index of the answer chosen
  next,         ///< Continue or Done on a page
  slider,       ///< number = the slider's value
  touch_down,   ///< any touch on the panel, answer or not: for the log
  button,       ///< value = index of the response button, in the order of the rig's URI
  contact,      ///< value 1: finger on the surface, 0: lifted; number: where along it, 0 to 1, or below 0
  stop,         ///< participant or operator wants to stop, or whoever text says; what was done is kept
  pause,        ///< operator
  xrun,         ///< the drive lost frames; value 1: of what was presented last, 0: of silence
  heard,        ///< value = index of the interval of which every frame has been played; never logged
  fault,        ///< `fault` says what, text the detail; from drive, amplifier or panel: the trial is void
  failure,      ///< text says what: the session cannot go on
  glitch,       ///< interference on a button or contact line; text says which; for the log only
  notice,       ///< text says what; for the log only
  arm,          ///< operator: clear a latched fault of the amplifier and arm it
  disarm,       ///< operator: amplifier off, and not on again before it is armed
  repeat,       ///< operator: void the trial under way and present it again
  note,         ///< operator: text is kept as the session's annotation
  frames_lost,  ///< value = frames that the screen was late by in the trial before
};

/// How good the time stamp is: the kernel's own, a toolkit's, or made by a simulated observer.
enum class TimeQuality { kernel, toolkit, simulated };
const char* name(TimeQuality quality);

struct Input {
  std::int64_t time_ns = 0;  ///< CLOCK_MONOTONIC (virtual in a simulated session)
  InputKind kind = InputKind::next;
  int value = 0;
  double number = 0;
  std::string text;
  FaultKind fault = FaultKind::other;
  TimeQuality quality = TimeQuality::toolkit;
};

/// The input as an event of the trial machine; none where the machine is not concerned.
std::optional<trial::Event> event_of(const Input& input);

/// The one queue into the session: any thread pushes, the session thread takes. Unbounded but tiny.
class Inputs {
 public:
  void push(Input input);
  /// The oldest input by time stamp, or none once `deadline_ns` (CLOCK_MONOTONIC) has passed.
  std::optional<Input> wait_until(std::int64_t deadline_ns);
  /// Throws away what has gathered, and returns it for the log.
  std::deque<Input> drain();

  /// The participant's page lives, at that time (CLOCK_MONOTONIC); -1 before its first sign. A display that
  /// begins to say so has to go on: the amplifier's guard counts on it from then.
  void page_alive(std::int64_t time_ns) noexcept { page_alive_ns_.store(time_ns); }
  std::int64_t page_alive_ns() const noexcept { return page_alive_ns_.load(); }

 private:
  std::atomic<std::int64_t> page_alive_ns_{-1};
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<Input> queue_;
};

}  // namespace turnpoint::session

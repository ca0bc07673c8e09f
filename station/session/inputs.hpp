#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include "station/terms/fault.hpp"
#include "station/trial/machine.hpp"

namespace turnpoint::session {

using terms::Fault;
using terms::FaultKind;

enum class InputKind {
  answer,      ///< value = index of the chosen answer
  next,        ///< Continue or Done on a page
  slider,      ///< number = the slider's value
  touch_down,  ///< any touch on the panel, answer or not; only logged
  button,      ///< value = index of the response button, in the order of the rig's URI
  /// value 1: finger on the surface, 0: finger lifted; number: position of the finger along the surface, 0 to
  /// 1, or below 0 if unknown
  contact,
  /// the participant, the operator, or the program named in text wants to stop; completed trials are kept
  stop,
  pause,  ///< the operator wants a pause
  xrun,   ///< the drive lost frames; value 1: frames of the last stimulus, 0: of silence
  heard,  ///< value = index of the interval that has been played completely; never logged
  /// a fault of drive, amplifier or panel, with its kind in `fault` and the detail in text; the trial is void
  fault,
  failure,      ///< the session cannot continue; text says what happened
  glitch,       ///< interference on a button or contact line, named in text; only logged
  notice,       ///< something that is only logged; text says what happened
  arm,          ///< by the operator: clear a latched fault of the amplifier and arm it
  disarm,       ///< by the operator: amplifier off, until it is armed again
  repeat,       ///< by the operator: void the current trial and present it again
  note,         ///< by the operator: text is stored as an annotation of the session
  frames_lost,  ///< value = number of frames that the screen was late by in the previous trial
};

/// Source of the time stamp: the kernel, a toolkit, or a simulated observer.
enum class TimeQuality { kernel, toolkit, simulated };
const char* name(TimeQuality quality);

struct Input {
  std::int64_t time_ns = 0;  ///< CLOCK_MONOTONIC in ns (virtual in a simulated session)
  InputKind kind = InputKind::next;
  int value = 0;
  double number = 0;
  std::string text;
  FaultKind fault = FaultKind::other;
  TimeQuality quality = TimeQuality::toolkit;
};

/// Converts the input to an event of the trial machine; empty if the machine does not need it.
std::optional<trial::Event> event_of(const Input& input);

/// The only queue into the session: any thread pushes, the session thread takes. Unbounded, but always short.
class Inputs {
 public:
  void push(Input input);
  /// The oldest input by time stamp; empty once `deadline_ns` (CLOCK_MONOTONIC) has passed.
  std::optional<Input> wait_until(std::int64_t deadline_ns);
  /// Removes all waiting inputs and returns them for the log.
  std::deque<Input> drain();

  /// Reports that the participant's page was alive at this time (CLOCK_MONOTONIC); -1 before its first
  /// report. A display that has begun to report must continue, because the amplifier's guard then expects it.
  void page_alive(std::int64_t time_ns) noexcept { page_alive_ns_.store(time_ns); }
  std::int64_t page_alive_ns() const noexcept { return page_alive_ns_.load(); }

 private:
  std::atomic<std::int64_t> page_alive_ns_{-1};
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<Input> queue_;
};

}  // namespace turnpoint::session

#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "station/core/fault.hpp"
#include "station/sensing/interval_result.hpp"
#include "station/sensing/trial_finger.hpp"
#include "station/trial/machine.hpp"

namespace turnpoint::session {

using core::Fault;
using core::FaultKind;

enum class InputKind {
  answer,      ///< value = index of the chosen answer
  value,       ///< number = the number that was typed, or marked on a line, as the answer
  next,        ///< Continue or Done on a page
  back,        ///< Back on a question or an explanation
  slider,      ///< number = the slider's value
  touch_down,  ///< any touch on the panel, on an answer or beside it; only logged
  button,      ///< value = index of the response button, in the order of the rig's URI
  /// value 1: a finger came onto the surface, 0: it was lifted; number: position of the finger along the
  /// surface, 0 to 1, or below 0 if unknown
  contact,
  /// the participant, the operator, or the program named in `text` wants to stop the session; completed
  /// trials are kept
  stop,
  pause,  ///< the participant or the operator wants a pause
  xrun,   ///< the drive lost frames; value 1: during the last stimulus, 0: in silence
  heard,  ///< value = index of an interval that has been played completely; never logged
  /// the pick-ups have measured the interval with the index `value`; the result is in `measured`. Comes
  /// before `heard` of this interval. With the last interval, `forces` says what the force cells measured in
  /// the trial. Either may be null.
  measured,
  /// drive, amplifier or panel has a fault: `fault` is its kind, `text` the detail; the trial is void
  fault,
  failure,      ///< the session cannot continue; `text` says what happened
  glitch,       ///< interference on the button or contact line named in `text`; only logged
  sync,         ///< a pulse from another device; `text` gives its frame; only logged
  notice,       ///< `text` says what happened; only logged
  arm,          ///< the operator clears a latched fault of the amplifier and arms it
  disarm,       ///< the operator switches the amplifier off; it stays off until it is armed again
  repeat,       ///< the operator declares the current trial void; it is presented again
  note,         ///< the operator writes an annotation of the session; `text` is stored
  frames_lost,  ///< value = how many frames the screen was late in the previous trial
  /// the frame with a flash (a response signal) was handed to the screen at time_ns; number = how many
  /// seconds after the time at which the flash was due
  signal_shown,
};

/// Where the time stamp comes from: the kernel, a toolkit, or a simulated observer.
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
  std::shared_ptr<const sensing::IntervalResult> measured;
  std::shared_ptr<const sensing::TrialForces> forces;
};

/// Converts the input to an event of the trial machine; empty if the machine does not need it.
std::optional<trial::Event> event_of(const Input& input);

/// The only queue into the session. Any thread may push; the session thread takes. Its length is not limited,
/// because it is always short.
class Inputs {
 public:
  void push(Input input);
  void push(InputKind kind, std::int64_t time_ns, std::string text, int value = 0);
  void push_fault(std::int64_t time_ns, FaultKind kind, std::string detail);
  /// Waits for an input and returns the one with the oldest time stamp. Returns nothing once `deadline_ns`
  /// (CLOCK_MONOTONIC) has passed.
  std::optional<Input> wait_until(std::int64_t deadline_ns);
  /// Removes all waiting inputs and returns them for the log.
  std::deque<Input> drain();

  /// Reports that the participant's page was alive at this time (CLOCK_MONOTONIC); -1 before its first
  /// report. Once a display has begun to report, it must go on, because the amplifier guard then expects its
  /// reports.
  void page_alive(std::int64_t time_ns) noexcept { page_alive_ns_.store(time_ns); }
  std::int64_t page_alive_ns() const noexcept { return page_alive_ns_.load(); }

 private:
  std::atomic<std::int64_t> page_alive_ns_{-1};
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<Input> queue_;
};

}  // namespace turnpoint::session

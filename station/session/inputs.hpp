#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <variant>

#include "station/core/fault.hpp"
#include "station/sensing/interval_result.hpp"
#include "station/sensing/trial_finger.hpp"
#include "station/trial/machine.hpp"

namespace turnpoint::session {

using core::Fault;
using core::FaultKind;

/// What can happen to a session. Where `by`, `what`, `result` or `detail` may be empty, the log says 0.
namespace input {

struct Answer {
  int index = 0;  ///< index of the chosen answer, or of the example of an explanation
};
struct Value {
  double number = 0;  ///< the number that was typed, or marked on a line, as the answer
};
struct Next {};   ///< Continue or Done on a page
struct Back {};   ///< Back on a question or an explanation
struct Again {};  ///< the participant asks for the intervals of the trial again
struct Slider {
  double value = 0;
};
struct Touch {};  ///< any touch on the panel, on an answer or beside it; only logged
struct Button {
  int index = 0;  ///< index of the response button, in the order of the rig's URI
};
struct Contact {
  bool on = false;                 ///< true: a finger came onto the surface; false: it was lifted
  std::optional<double> position;  ///< position of the finger along the surface, 0 to 1, if it is known
};
/// The participant, the operator (`by` is ""), or the program named in `by` wants to stop the session;
/// completed trials are kept.
struct Stop {
  std::string by = {};
};
struct Pause {};  ///< the participant or the operator wants a pause
/// The drive lost frames.
struct Xrun {
  bool in_stimulus = false;  ///< during the last stimulus; otherwise in silence
  std::string what;
};
struct Heard {
  int interval = 0;  ///< index of an interval that has been played completely; never logged
};
/// The pick-ups have measured an interval. Comes before `Heard` of this interval.
struct Measured {
  int interval = 0;
  std::shared_ptr<const sensing::IntervalResult> result;  ///< never null
  /// with the last interval: what the force cells measured in the trial; null without force cells
  std::shared_ptr<const sensing::TrialForces> forces;
};
using core::Fault;  ///< drive, amplifier or panel has a fault; the trial is void
struct Failure {
  std::string what;  ///< why the session cannot continue
};
struct Glitch {
  std::string what;  ///< interference on the button or contact line; only logged
};
struct Sync {
  std::optional<std::int64_t> frame;  ///< playback frame of another device's pulse; only logged
};
struct Notice {
  std::string what;  ///< what happened; only logged
};
/// The operator clears a latched fault of the amplifier and arms it.
struct Arm {
  std::string result = {};  ///< set when the command has been carried out
};
/// The operator switches the amplifier off; it stays off until it is armed again.
struct Disarm {
  std::string result = {};  ///< set when the command has been carried out
};
struct Repeat {};  ///< the operator declares the current trial void; it is presented again
struct Note {
  std::string text;  ///< the operator's annotation of the session, which is stored
};
struct FramesLost {
  int frames = 0;  ///< how many frames the screen was late in the previous trial
};
/// The frame with a flash (a response signal) was handed to the screen.
struct SignalShown {
  double late_s = 0;  ///< time since the flash was due
};

using Any = std::variant<Next, Answer, Value, Back, Slider, Touch, Button, Contact, Stop, Pause, Xrun, Heard,
                         Measured, Fault, Failure, Glitch, Sync, Notice, Arm, Disarm, Repeat, Note,
                         FramesLost, SignalShown, Again>;

}  // namespace input

/// Where the time stamp comes from: the kernel, a toolkit, or a simulated observer.
enum class TimeQuality { kernel, toolkit, simulated };
const char* name(TimeQuality quality);

struct Input {
  std::int64_t time_ns = 0;  ///< CLOCK_MONOTONIC in ns (virtual in a simulated session)
  input::Any content;
  TimeQuality quality = TimeQuality::toolkit;

  template <class Content>
  bool is() const {
    return std::holds_alternative<Content>(content);
  }
  /// The content if it is of this type; otherwise null.
  template <class Content>
  const Content* as() const {
    return std::get_if<Content>(&content);
  }
};

/// Converts the input to an event of the trial machine; empty if the machine does not need it.
std::optional<trial::Event> event_of(const Input& input);

/// The only queue into the session. Any thread may push; the session thread takes. Its length is not limited,
/// because it is always short.
class Inputs {
 public:
  void push(Input input);
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

#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "station/core/trial.hpp"

namespace turnpoint::trial {

/// The moment from which response times are counted. The enumerators have the names used in protocol files.
using core::ResponseZero;

enum class Phase {
  idle,        ///< the trial has not started
  cue,         ///< the participant gets ready; the surface is silent; all intervals are scheduled
  stimulus,    ///< an interval is being presented
  gap,         ///< silence between two intervals
  response,    ///< silence; an answer is accepted
  confidence,  ///< silence; the participant says how sure the answer was
  feedback,    ///< the page says whether the answer was right
  late,        ///< the page shows a message after a timeout or a premature answer
  interval,    ///< pause between trials
  done,
};

using core::Outcome;

/// One interval, or one part of an interval of several parts: its duration, and the times at which its later
/// scenes begin, counted from its onset.
struct IntervalTiming {
  std::int64_t duration_ns = 0;
  std::vector<std::int64_t> scene_starts_ns;  ///< ascending, without the first scene (which starts at 0)
  std::int64_t silence_ns = 0;                ///< silence before it, from the end of the interval before
};

/// The timing of a trial; all times in ns. Durations must not be negative.
struct Timing {
  std::int64_t cue_ns = 0;
  std::vector<IntervalTiming> intervals;
  /// true: the participant may explore the surface until the answer, in the last interval; false: answers are
  /// accepted only after it
  bool answer_ends_stimulus = false;
  ResponseZero response_zero = ResponseZero::go_cue;
  std::int64_t deadline_ns = 0;      ///< longest response time, counted from response_zero
  std::int64_t anticipation_ns = 0;  ///< an answer sooner than this after response_zero is an anticipation
  /// time from response_zero to the signal that asks the participant to answer at once; empty without a
  /// signal
  std::optional<std::int64_t> signal_ns;
  std::int64_t feedback_ns = 0;  ///< length of the feedback; 0 for none
  std::int64_t late_ns = 0;      ///< length of the message after a late answer; 0 for none
  std::int64_t iti_ns = 0;
  /// what the pause after the trial is longer by if the answer was wrong, too late or too early
  std::int64_t wrong_delay_ns = 0, late_delay_ns = 0, early_delay_ns = 0;
  /// How long a time stamp may take to arrive. The machine waits this long after a deadline before it decides
  /// from the time stamps whether an answer was late.
  std::int64_t watermark_ns = 20'000'000;
  int answers = 2;             ///< number of possible answers
  std::optional<int> correct;  ///< index of the right answer; empty if no answer is right or wrong
  std::optional<int> unsure;   ///< index of an answer that is neither right nor wrong; empty if there is none
  /// number of confidence levels that the participant chooses from after the answer, without a deadline; 0:
  /// confidence is not asked for. A second press of the answer, within core::kConfidenceGuard_ns of the
  /// first, is no confidence
  int confidence = 0;
  /// how often the participant may ask for the intervals again, while an answer is open
  int again = 0;
};

enum class EventKind {
  tick,  ///< time has passed, and nothing else happened
  /// value: index of the interval; time_ns: when its first frame reaches the surface, possibly in the future
  onset,
  heard,    ///< value: index of an interval that has been played completely and as scheduled
  answer,   ///< value: index of the answer or, after the answer, of the degree of confidence
  touch,    ///< a touch beside the answers
  again,    ///< the participant asks to feel the intervals of the trial once more
  contact,  ///< value 1: a finger is on the surface; 0: it was lifted
  xrun,     ///< the drive lost frames; value 1: in an interval of this trial, 0: in silence
  refuted,  ///< value: index of an interval in which the surface did not move as planned
  outside,  ///< the finger did not move as the protocol asks for, and the trial is to be presented again
  fault,    ///< drive, amplifier or panel cannot continue
  abort,    ///< the participant or the operator stops the trial
};

struct Event {
  std::int64_t time_ns = 0;
  EventKind kind = EventKind::tick;
  int value = 0;
};

enum class ActionKind {
  enter,  ///< value: the new phase; show its page
  /// schedule all intervals, with the silences of Timing between them, the first no earlier than time_ns; the
  /// caller replies with an `onset` event for each interval, and with a `heard` event when the interval has
  /// been played completely. It comes once at the start, and once for each time that the participant asks for
  /// the intervals again; by then, everything presented before has been heard
  present,
  silence,  ///< ramp down what is playing now, and cancel what has not begun
  signal,   ///< give the response signal; time_ns: when it was due
};

struct Action {
  ActionKind kind = ActionKind::enter;
  int value = 0;
  std::int64_t time_ns = 0;
};

/// The result of the trial. Response and response time are set only if the trial was answered.
struct Result {
  Outcome outcome = Outcome::aborted;
  std::optional<int> response;
  std::optional<bool> correct;
  std::optional<std::int64_t> zero_ns;  ///< time of the event that response_zero names
  std::optional<std::int64_t> response_time_ns, decision_time_ns, movement_time_ns;
  std::optional<int> confidence;                   ///< degree of confidence; 1 is the least sure
  std::optional<std::int64_t> confidence_time_ns;  ///< time of the confidence rating, counted from the answer
  std::int64_t started_ns = 0, ended_ns = 0;
  int extra_touches = 0;  ///< late, early, repeated or outdated touches; they are logged but never scored
  int again = 0;  ///< how often the intervals were presented again; all times are those of the last time
  int xruns = 0;
};

/// A trial as a pure state machine: time-stamped events go in, actions come out. It contains no clock and no
/// thread; the same events give the same actions. Events must come in the order of their time stamps, with
/// one exception: an answer stamped before a deadline is accepted until watermark_ns after the deadline.
///
/// Whether a stimulus was played without loss is known only some time after it, from the audio stream. An
/// outcome therefore becomes final only when every interval has been reported as played without loss (event
/// `heard`). If a loss is reported first, the trial is void. The phases continue meanwhile, but the trial
/// does not end before its outcome is final.
///
/// If the participant asks for the intervals again, the trial goes back to its cue, and everything after it
/// (response_zero, deadline, anticipation) happens as after the first presentation. The intervals are
/// presented once all of those before have been reported as heard, so that a loss in any presentation makes
/// the trial void.
class Machine {
 public:
  /// Throws std::invalid_argument for a plan without intervals or answers, with a negative time, or with a
  /// response_zero that cannot happen (`change` without a second scene).
  explicit Machine(Timing plan);

  std::vector<Action> start(std::int64_t now_ns);
  std::vector<Action> handle(const Event& event);

  /// The next wake-up time, at which the caller must send a tick. Empty if the machine waits for an event, or
  /// is done.
  std::optional<std::int64_t> wake_ns() const;

  Phase phase() const { return phase_; }
  bool done() const { return phase_ == Phase::done; }
  bool answers_open() const;
  /// True if the participant may ask for the intervals again.
  bool may_ask_again() const { return answers_open() && result_.again < plan_.again; }
  /// True once the outcome is final. Later events cannot change it.
  bool decided() const;
  int interval() const { return interval_; }
  /// True once the response signal has been given.
  bool signalled() const { return signalled_; }
  const Result& result() const { return result_; }

 private:
  void enter(Phase phase, std::int64_t until_ns);
  void advance(std::int64_t now_ns);
  bool step(std::int64_t now_ns);
  void answer(const Event& event);
  void confide(const Event& event);
  void again(const Event& event);
  void present_again();
  void contact(const Event& event);
  void onset(const Event& event);
  void begin_interval(std::int64_t onset_ns);
  void end_stimulus(std::int64_t at_ns);
  void set_zero(std::int64_t at_ns);
  void conclude(Outcome outcome, std::int64_t at_ns);
  void repeat(std::int64_t at_ns);
  void forget_response();
  void end(Outcome outcome, std::int64_t at_ns);
  void settle(std::int64_t at_ns);
  std::int64_t pause_ns() const;
  std::int64_t deadline_at() const;
  std::int64_t signal_at() const;

  Timing plan_;
  Phase phase_ = Phase::idle;
  std::int64_t until_ns_ = 0;
  std::int64_t now_ns_ = 0;
  int interval_ = 0;
  std::vector<std::int64_t> onsets_ns_;  ///< scheduled onsets of all intervals
  std::vector<bool> heard_;
  bool concluded_ = false;
  bool touching_ = false;
  bool signalled_ = false;
  bool asked_again_ = false;  ///< the intervals are to be presented again once those before are heard
  std::optional<std::int64_t> lift_off_ns_, no_contact_deadline_ns_;
  Result result_;
  std::vector<Action> actions_;
};

}  // namespace turnpoint::trial

#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "station/core/fault.hpp"
#include "station/core/texts.hpp"
#include "station/rig/physical.hpp"

namespace turnpoint::session {

/// A planned session that would begin before the protocol's minimum number of days has passed. Dates look
/// like 2026-11-24.
struct EarlySession {
  std::string participant;
  int number = 0;            ///< the session that would begin
  std::string allowed_from;  ///< the first day on which it may begin
  int last_number = 0;       ///< the participant's last session
  std::string last_day;
  int min_days = 0;  ///< the protocol's minimum number of days between sessions
};

using core::FaultKind;

/// The content of the participant's screen. The session decides what it contains; a display only draws it.
enum class PageKind {
  /// the block's text or its speed or accuracy instruction, and a Continue button; or after the block what
  /// was
  /// achieved in it
  instructions,
  cue,  ///< get ready: shows where to slide the finger, and the mark of the question
  /// free exploration, or an interval (`interval`); answers are accepted if `answers_open`
  stimulus,
  pause,     ///< the gap between two intervals, in silence
  response,  ///< the surface is silent; answers can be given
  feedback,  ///< shows whether the answer was right (`correct`), or the message after a late answer (`text`)
  interval,  ///< pause between trials; empty except for the progress
  rest,      ///< a break of `remaining_s`; Continue appears once it is over
  /// the surface is silent; after the answer, the participant says how sure he or she is
  confidence,
  /// a question of a questionnaire or a consent: a text, perhaps long, and answers of equal size
  question,
  /// a text, perhaps with a picture and with examples to feel (`answers`); Continue, and Back if `back`
  explanation,
  line,    ///< a rating on a line: nothing is marked until the first touch; Done confirms the mark
  number,  ///< a number is typed; Done confirms it
  adjust,  ///< a slider moves the boundary in steps; Done ends the adjustment
  /// says what happened, what is safe and what to do; Continue appears after the operator has repaired the
  /// fault
  fault,
  paused,  ///< the participant or the operator has paused the session; Continue or end
  end,     ///< thanks; followed by the summary for the operator
  failed,  ///< the session cannot continue; `text` says why; completed trials are kept
};

struct AnswerButton {
  std::string id, label;
  std::string caption = {};  ///< a smaller text below the label; may be ""
};

/// What a page needs to take a number as the answer.
struct ValueEntry {
  double low = 0, high = 1;
  int decimals = 0;
  /// texts along the line, and their positions on it, from 0 (left end) to 1
  std::vector<double> places;
  std::vector<std::string> texts;
  std::string first;  ///< number pad only: first line, which says what number stands for the standard
                      ///< stimulus; may be ""
};

/// The bars that guide the finger: normal force and speed. Lateral force, friction and position are left out
/// on purpose, because they would reveal the answer.
struct Guidance {
  struct Bar {
    std::optional<double> value;  ///< from 0 to 1; empty while no finger is on the surface
    double low = 0, high = 1;     ///< the range that the protocol asks for, from 0 to 1
    bool operator==(const Bar&) const = default;
  };
  std::optional<Bar> force, speed;  ///< empty if the protocol accepts any value
  /// The speed at which the finger is to slide: the middle of the protocol's range. It is the same in all
  /// trials. Empty if the protocol accepts any speed.
  std::optional<double> pace_mm_s = {};
  bool frozen = false;  ///< the bars stand still, because a stimulus is being presented
  bool operator==(const Guidance&) const = default;
};

/// A line of the operator's summary at the end of a session, whose label is said in the operator's language.
struct SummaryLine {
  core::Phrase label;
  std::string value;
};

/// For an adjustment: position, limits and step of the slider.
struct SliderEntry {
  double setting = 0, low = 0, high = 1, step = 0;
  bool moved = false;  ///< the slider is no longer where the trial began, so there is something to confirm
};

/// Which interval of a trial the page belongs to.
struct IntervalPlace {
  int number = 0, of = 0;  ///< number of the current interval, counted from 1, and total number
  /// what the intervals are called, such as A, B, X; if empty, they are numbered
  std::vector<std::string> names;
};

struct Page {
  PageKind kind = PageKind::interval;
  std::string title;  ///< title of the block, or headline of the page
  std::string text;   ///< the question, instruction or message, in the session's language
  std::string cue;    ///< cue: what the task says instead of the station's own words; may be ""
  std::vector<AnswerButton> answers;
  bool answers_open = false;
  bool back = false;          ///< the participant can return to the previous question or page
  bool playing = false;       ///< true while an example is being presented
  std::string picture;        ///< path of an explanation's picture; "" if there is none
  bool again = false;         ///< the participant may ask for the intervals of the trial again
  bool offers_again = false;  ///< the task lets participants ask for intervals again, at least on other pages
  bool answer_now = false;    ///< true once the response signal has been given
  /// when the response signal was due, if it begins with a flash of the whole page
  std::optional<std::int64_t> flash_ns;
  std::optional<bool> correct;  ///< whether the answer was right; used only for feedback
  /// "", "speed", "accuracy", ...: determines the block's style, which never differs by colour alone
  std::string instruction;
  /// position of the mark on the surface to which the question refers, measured from the wide end; empty if
  /// there is none
  std::optional<double> mark_mm;
  rig::Outline surface;  ///< without a length on a page that does not draw it
  IntervalPlace interval;
  /// number of trials done in the session, and in total; the total may be an estimate
  int trials_done = 0, trials_total = 0;
  double remaining_s = 0;  ///< remaining time of a break
  SliderEntry slider;
  ValueEntry value;                  ///< settings of the rating line or the number pad
  std::optional<Guidance> guidance;  ///< bars that guide the finger, if the page has them
  std::string language;
  /// "disarmed" or "faulted" while the operator has to act (on a fault page); otherwise "armed", "enabled",
  /// or ""
  std::string amplifier;
  /// live | pilot | simulated; shown on every page of pilot and simulated sessions
  std::string run_mode;
  bool resumable = false;            ///< on the end page: the session can be continued later
  std::vector<SummaryLine> summary;  ///< on the end page: summary of the session for the operator
  /// on a page of kind `failed`: set if the session did not begin because it would be too early
  std::optional<EarlySession> early;
  core::Fault fault;        ///< on a fault page; on one of kind `failed` only the detail
  std::string safe, to_do;  ///< on a fault page: what is safe and what to do; `text` says what happened
};

/// Draws pages. show() is called on the session thread and must return without waiting for the participant.
class Display {
 public:
  virtual ~Display() = default;
  virtual void show(const Page& page) = 0;
  /// Moves the bars for force and speed on the page that is shown. Called on the session thread, about twenty
  /// times a second.
  virtual void guide(const Guidance& /*guidance*/) {}
};

}  // namespace turnpoint::session

#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/terms/fault.hpp"

namespace turnpoint::session {

using terms::FaultKind;

/// The content of the participant's screen. The session decides it, a display only draws it.
enum class PageKind {
  /// instructions: the text of the block or of its speed or accuracy instruction, with Continue
  instructions,
  cue,  ///< get ready: where to slide, with the mark; no answers
  /// exploration, or interval `interval` of `intervals`; answers are possible if `answers_open`
  stimulus,
  pause,     ///< the gap between two intervals, in silence
  response,  ///< the surface is silent; answers are possible
  feedback,  ///< right or wrong (`correct`), or the message after a late answer (`text`)
  interval,  ///< between trials: empty except for progress
  rest,      ///< a break with `remaining_s`; Continue once it is over
  adjust,    ///< a slider with steps moves the boundary; Done
  fault,     ///< what happened, what is safe, what to do; Continue after the operator has fixed it
  paused,    ///< stopped by participant or operator; Continue or end
  end,       ///< thanks; followed by the summary for the operator
  failed,    ///< the session cannot continue; `text` says why; completed trials are kept
};

struct AnswerButton {
  std::string id, label;
};

/// A line of the operator's end-of-session summary, as text (label, value).
struct SummaryLine {
  std::string label, value;
};

struct Page {
  PageKind kind = PageKind::interval;
  std::string title;  ///< block title or headline
  std::string text;   ///< the question, instruction or message, in the session's language
  std::vector<AnswerButton> answers;
  bool answers_open = false;
  std::optional<bool> correct;  ///< whether the answer was right; for feedback only
  /// "", "speed", "accuracy", ...: determines the style of the block, never only its colour
  std::string instruction;
  std::optional<double> mark_mm;  ///< the mark to show, measured from the wide end
  double length_mm = 0;           ///< length of the surface, for its drawing
  double wide_half_width_mm = 0, narrow_half_width_mm = 0;
  bool wide_end_left = true;
  int interval = 0, intervals = 0;  ///< number of the current interval, from 1, and number of intervals
  /// trials done and trials in total, over the session; the total may be an estimate
  int trials_done = 0, trials_total = 0;
  double remaining_s = 0;  ///< remaining time of a break
  /// for an adjustment: position, limits and step of the slider
  double slider = 0, slider_min = 0, slider_max = 1, slider_step = 0;
  std::string language;
  /// "disarmed" or "faulted" while the operator has to act (on a fault page); otherwise "armed", "enabled",
  /// or "".
  std::string amplifier;
  std::string run_mode;              ///< live | pilot | simulated: shown on every page unless live
  std::vector<SummaryLine> summary;  ///< summary of the session for the operator, on the end page
  FaultKind fault = FaultKind::other;
  std::string safe, to_do;  ///< on a fault page: what is safe and what to do; `text` says what happened
  std::string detail;       ///< on a fault page: the detail, as it is logged; may be ""
};

/// Draws pages. show() is called on the session thread and must not wait for the participant.
class Display {
 public:
  virtual ~Display() = default;
  virtual void show(const Page& page) = 0;
};

}  // namespace turnpoint::session

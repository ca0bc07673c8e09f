#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/session/fault.hpp"

namespace turnpoint::session {

/// What the participant's screen shows. The session decides, a display only draws it.
enum class PageKind {
  instructions,  ///< text of the block (and of its speed or accuracy instruction); Continue
  cue,           ///< get ready: where to slide, the mark pointed at; nothing to answer
  stimulus,      ///< exploration or interval `interval` of `intervals`; answers open when `answers_open`
  pause,         ///< the gap between intervals, still
  response,      ///< the surface is silent; answers open
  feedback,      ///< right or wrong (`correct`), or the message of a late answer (`text`)
  interval,      ///< between trials: still and empty but for progress
  rest,          ///< a break with `remaining_s`; Continue once it is over
  adjust,        ///< a slider with steps moves the boundary; Done
  fault,         ///< what happened, what is safe, what to do; Continue after the operator has mended it
  paused,        ///< stopped by participant or operator; Continue or end
  end,           ///< thanks; the summary for the operator comes after
  failed,        ///< the session cannot go on; `text` says why, what was done is kept
};

struct AnswerButton {
  std::string id, label;
};

/// The end-of-session numbers for the operator, ready as text (label, value).
struct SummaryLine {
  std::string label, value;
};

struct Page {
  PageKind kind = PageKind::interval;
  std::string title;  ///< block title or headline
  std::string text;   ///< the question, the instruction, the message; in the session's language
  std::vector<AnswerButton> answers;
  bool answers_open = false;
  std::optional<bool> correct;    ///< feedback only
  std::string instruction;        ///< "", "speed", "accuracy", ...: styles the block, never by colour alone
  std::optional<double> mark_mm;  ///< the mark to point at, from the wide end
  double length_mm = 0;           ///< of the surface, for its drawing
  double wide_half_width_mm = 0, narrow_half_width_mm = 0;
  bool wide_end_left = true;
  int interval = 0, intervals = 0;        ///< counted from 1
  int trials_done = 0, trials_total = 0;  ///< of the session; total may be an estimate
  double remaining_s = 0;                 ///< of a break
  double slider = 0, slider_min = 0, slider_max = 1, slider_step = 0;  ///< adjust
  std::string language;
  /// "disarmed" or "faulted" while the operator has to act (a fault page); else "armed", "enabled", or "".
  std::string amplifier;
  std::string run_mode;              ///< live | pilot | simulated: shown on every page unless live
  std::vector<SummaryLine> summary;  ///< end page, for the operator
  FaultKind fault = FaultKind::other;
  std::string safe, to_do;  ///< fault only: what is safe, what to do; `text` is what happened
  std::string detail;       ///< fault only: what the station found, as it is logged; may be ""
};

/// Draws pages. show() is called on the session thread and must not wait for the participant.
class Display {
 public:
  virtual ~Display() = default;
  virtual void show(const Page& page) = 0;
};

}  // namespace turnpoint::session

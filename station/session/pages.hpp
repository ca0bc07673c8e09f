#pragma once
#include <optional>
#include <string>

#include "station/core/texts.hpp"
#include "station/protocol/protocol.hpp"
#include "station/session/page.hpp"
#include "station/session/scores.hpp"
#include "station/session/session.hpp"
#include "station/trial/director.hpp"
#include "station/trial/machine.hpp"

namespace turnpoint::session {

/// Makes the pages of one session. They contain texts in the session's language, the size of the surface for
/// its drawing, and the progress.
class Pages {
 public:
  Pages(const Setup& setup);

  /// Makes the page with a block's instructions: the text of its speed or accuracy instruction if it has one,
  /// otherwise the task's question.
  Page instructions(const protocol::Block& block, const trial::Director& director) const;
  /// Adds the mark on the surface that the question of the block's first trial refers to.
  void add_mark(Page& page, const trial::TrialSpec& first) const;
  /// Makes the page for one phase of a trial. `part` is the part that is presented, or was presented last: an
  /// index of trial::parts_of. During a silence within an interval, the page stays as it is.
  Page of_phase(trial::Phase phase, int part, const trial::TrialSpec& spec, const protocol::Block& block,
                const trial::Result& result, const trial::Director& director) const;
  /// Returns the text that tells the participant what to change after a wrong movement. `word` is the name of
  /// the wrong movement in the trial's row, such as "light".
  std::string movement(const std::string& word) const;
  /// Adds the slider of an adjustment to the page of a phase. `moved` says that it has been moved in this
  /// trial.
  void add_slider(Page& page, const trial::SliderSpan& span, double setting, bool moved) const;
  /// Makes the page between two trials, which shows only the progress.
  Page between_trials(const protocol::Block* block, const trial::Director& director) const;
  /// Makes the page with a question of a questionnaire or with a consent form.
  Page question(const protocol::Item& item, const trial::Director& director) const;
  Page explanation(const protocol::ExplanationPage& explanation, const trial::Director& director) const;
  /// Makes the page before a session ends early because of a refused consent or a screening.
  Page farewell(const protocol::Localised& text, const trial::Director& director) const;
  Page rest(const protocol::Block& block, double min_s, const trial::Director& director) const;
  /// Makes the page after a block that says what the participant has achieved in it. Empty if the block tells
  /// nothing at its end: it has neither a goal nor the feedback "block". `points` is the score so far.
  std::optional<Page> block_over(const protocol::Block& block, const BlockScore& score, double points,
                                 const trial::Director& director) const;
  /// Adds what a trial was worth to its feedback and, if given, the score.
  void add_points(Page& page, double points, std::optional<double> score) const;
  Page practice_again(const protocol::Block& block, const trial::Director& director) const;
  /// Makes the page for a fault that stops the session until somebody has repaired it.
  Page fault(const Fault& fault, const trial::Director& director) const;
  Page paused(const trial::Director& director) const;
  Page end(const Summary& summary, const trial::Director& director) const;

 private:
  Page blank(PageKind kind, const protocol::Block* block, const trial::Director* director) const;
  std::string text(const protocol::Localised& localised) const;
  std::string question_in(std::size_t of_task, const trial::TrialSpec* spec) const;
  const protocol::Goal* goal_of(const protocol::Block& block) const;
  std::string score_in_words(double points) const;
  void add_value(Page& page, const protocol::ValueAnswer& value) const;

  const Setup& setup_;
};

}  // namespace turnpoint::session

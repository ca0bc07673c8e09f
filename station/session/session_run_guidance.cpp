#include "station/session/session_run.hpp"

namespace turnpoint::session {

// The part of SessionRun that moves the bars which guide the finger.

/// Moves the bars if Guide::kEvery_ns has passed since they were last moved.
void SessionRun::move_bars() {
  if (!guide_.guides() || stage_->now_ns() < guide_due_ns_) return;
  guide_due_ns_ = stage_->now_ns() + Guide::kEvery_ns;
  if (guide_.move(stage_->finger_now()) && display_ != nullptr) display_->guide(*guide_.bars());
}

/// Stops the bars during a stimulus, because they could show its effect on the finger. In trials without a
/// question, in which the finger only strokes the surface, the bars always move.
void SessionRun::hold_bars(trial::Phase phase, const Running& trial) {
  guide_.freeze(phase == trial::Phase::stimulus && !trial.spec.strokes);
}

}  // namespace turnpoint::session

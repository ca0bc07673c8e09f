#include "station/session/session_run.hpp"

namespace turnpoint::session {

// This file has the part of SessionRun for the bars that guide the finger.

/// Moves the bars, if it is time for it.
void SessionRun::move_bars() {
  if (!guide_.guides() || stage_->now_ns() < guide_due_ns_) return;
  guide_due_ns_ = stage_->now_ns() + Guide::kEvery_ns;
  if (guide_.move(stage_->finger_now()) && display_ != nullptr) display_->guide(*guide_.bars());
}

/// The bars stand still during a stimulus, whose effect on the finger they could show. Where nothing is
/// asked, they always move.
void SessionRun::hold_bars(trial::Phase phase, const Running& trial) {
  guide_.freeze(phase == trial::Phase::stimulus && !trial.spec.strokes);
}

}  // namespace turnpoint::session

#include "station/session/session_run.hpp"

namespace turnpoint::session {

// The part of SessionRun that moves the bars which guide the finger, and tells the operator of the finger.

bool SessionRun::is_finger_watched() const {
  return monitor_ != nullptr && monitor_->watches_finger() && rig::has_force_cells(setup_.rig);
}

/// Moves the bars if Guide::kEvery_ns has passed since they were last moved.
void SessionRun::move_bars() {
  const bool watched = is_finger_watched();
  if ((!guide_.guides() && !watched) || stage_->now_ns() < guide_due_ns_) return;
  guide_due_ns_ = stage_->now_ns() + Guide::kEvery_ns;
  const auto finger = stage_->finger_now();
  if (guide_.move(finger) && display_ != nullptr) display_->guide(*guide_.bars());
  if (!watched) return;
  const bool touches = finger && finger->contact;
  monitor_->finger_moved(
      touches ? std::optional(FingerSeen{finger->normal_N, finger->speed_mm_s, finger->position_mm})
              : std::nullopt);
}

/// Stops the bars during a stimulus, because they could show its effect on the finger. In trials without a
/// question, in which the finger only strokes the surface, the bars always move.
void SessionRun::hold_bars(trial::Phase phase, const Running& trial) {
  guide_.freeze(phase == trial::Phase::stimulus && !trial.spec.strokes);
}

}  // namespace turnpoint::session

#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "station/core/records.hpp"
#include "station/protocol/protocol.hpp"
#include "station/session/plan_ahead.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::session {

/// A finger that touches the surface, as the operator sees it.
struct FingerSeen {
  double normal_N = 0;
  double speed_mm_s = 0;   ///< NaN if it is not known
  double position_mm = 0;  ///< from the wide edge; NaN if it is not known
};

/// Observes a session for the operator. Its functions are called on the session thread: they must copy what
/// they need and return at once. A monitor cannot affect what the participant sees or feels.
class Monitor {
 public:
  virtual ~Monitor() = default;

  /// A trial is about to begin, and all its stimuli are decided. For each interval, `plans` holds the plans
  /// of the interval's scenes, exactly as they will be played. The plans are valid only during the call.
  virtual void trial_begins(const trial::TrialSpec& /*spec*/, const protocol::Block& /*block*/,
                            const PlanAhead::Plans& /*plans*/) {}

  /// In an adjustment, the slider was moved, and the surface now glides to `plan`. `spec` has the slider's
  /// setting among its factors. Called at most once every kGlideEvery_s.
  virtual void surface_follows(const trial::TrialSpec& /*spec*/, const scene::DrivePlan& /*plan*/) {}

  /// True if finger_moved() should be called.
  virtual bool watches_finger() const { return false; }
  /// What the finger does at this moment; empty if it does not touch the surface, or if that is not known.
  /// Called about twenty times a second during trials, if the rig has force cells, whatever the participant
  /// sees.
  virtual void finger_moved(const std::optional<FingerSeen>& /*finger*/) {}

  /// A trial has ended and is stored.
  virtual void trial_ended(const trial::TrialSpec& /*spec*/, const core::TrialRow& /*row*/) {}
};

}  // namespace turnpoint::session

#pragma once
#include <cstdint>
#include <string>

#include "station/protocol/protocol.hpp"
#include "station/records/records.hpp"
#include "station/session/plan_ahead.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::session {

/// Looks over the session's shoulder, for the operator. Called on the session thread; copies what it needs
/// and returns at once. Nothing that a monitor does reaches the participant.
class Monitor {
 public:
  virtual ~Monitor() = default;

  /// A trial is about to begin: everything that it will present is decided. `plans` are what will be played,
  /// for each interval those of its scenes; they are valid during the call only.
  virtual void trial_begins(const trial::TrialSpec& spec, const protocol::Block& block,
                            const PlanAhead::Plans& plans) = 0;

  /// The surface follows the slider of an adjustment: `plan` is what it glides to from now on, and `spec` has
  /// the setting among its factors. At most once every kGlideEvery_s.
  virtual void surface_follows(const trial::TrialSpec& /*spec*/, const scene::DrivePlan& /*plan*/) {}

  /// A trial has ended and is stored.
  virtual void trial_ended(const trial::TrialSpec& spec, const records::TrialRow& row) = 0;
};

}  // namespace turnpoint::session

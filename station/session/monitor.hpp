#pragma once
#include <cstdint>
#include <string>

#include "station/protocol/protocol.hpp"
#include "station/session/director.hpp"
#include "station/session/plan_ahead.hpp"
#include "station/store/records.hpp"

namespace turnpoint::session {

/// Looks over the session's shoulder, for the operator. Both are called on the session thread, between
/// stimuli; they copy what they need and return at once. Nothing that a monitor does reaches the participant.
class Monitor {
 public:
  virtual ~Monitor() = default;

  /// A trial is about to begin: everything that it will present is decided. `plans` are what will be played,
  /// for each interval those of its scenes; they are valid during the call only.
  virtual void trial_begins(const TrialSpec& spec, const protocol::Block& block,
                            const PlanAhead::Plans& plans) = 0;

  /// A trial has ended and is stored.
  virtual void trial_ended(const TrialSpec& spec, const store::TrialRow& row) = 0;
};

}  // namespace turnpoint::session

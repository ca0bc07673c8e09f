#include <utility>

#include "station/protocol/triggers.hpp"
#include "station/session/session_run.hpp"

namespace turnpoint::session {

using protocol::TriggerEvent;

/// Sends the trigger code of an event that happens now.
void SessionRun::trigger(TriggerEvent event, const Running& trial) {
  if (!stage_->triggers().active()) return;
  Trigger trigger;
  trigger.event = event;
  trigger.code = protocol::trigger_code(setup_.protocol, event, trial.spec.factors);
  trigger.trial_index = trial_index();
  if (trigger.code > 0) stage_->triggers().send(std::move(trigger), stage_->now_ns());
}

/// Records the codes of the scheduled intervals and of their changes of scene (a buzz has no code). On the
/// marker channel these codes are part of the bursts.
void SessionRun::trigger_intervals(const Running& trial) {
  if (!stage_->triggers().active()) return;
  const auto add = [&](TriggerEvent event, const Onset& onset, std::int64_t frames) {
    Trigger trigger;
    trigger.event = event;
    trigger.code = protocol::trigger_code(setup_.protocol, event, trial.spec.factors);
    trigger.trial_index = trial_index();
    trigger.frame = onset.frame + frames;
    trigger.time_ns = onset.time_ns + frames * 1'000'000'000 / setup_.rig.output.rate_Hz;
    if (trigger.code > 0) stage_->triggers().scheduled(std::move(trigger));
  };
  const auto& bursts = plans_.take(trial.spec).bursts;
  for (std::size_t i = 0; i < bursts.size(); ++i) {
    add(TriggerEvent::onset, trial.onsets[i], 0);
    for (std::size_t c = 0; c + 1 < trial.spec.intervals[i].size(); ++c)
      add(TriggerEvent::change, trial.onsets[i], bursts[i].changes[c].at_frame);
  }
}

/// Logs each code once it is known whether it was found in the captured signal, and when it was set on the
/// lines.
void SessionRun::log_triggers() {
  if (!stage_->triggers().active()) return;
  const auto now = stage_->now_ns();
  const auto done = stage_->triggers().take(now);
  for (const auto& trigger : done.triggers)
    for (auto& row : rows_of(trigger)) {
      (row.kind == "trigger" ? summary_.triggers : summary_.triggers_missed) += 1;
      log_.event(std::move(row));
    }
  for (const auto& extra : done.extra) {
    ++summary_.triggers_extra;
    log_.event(row_of_extra(extra, now, trial_index()));
  }
  if (done.failure.empty()) return;
  records::EventRow row;
  row.time_ns = now, row.kind = "notice", row.value = "no more trigger codes on lines: " + done.failure;
  log_.event(std::move(row));
}

/// Waits until the last codes have been sent and read back.
void SessionRun::finish_triggers() {
  const auto until = stage_->now_ns() + 500'000'000;
  log_triggers();
  while (stage_->triggers().pending() && stage_->now_ns() < until) {
    if (auto input = stage_->wait_until(std::min(until, stage_->now_ns() + 50'000'000)))
      gate_.note(gate_.received(std::move(*input)));
    log_triggers();
  }
}

}  // namespace turnpoint::session

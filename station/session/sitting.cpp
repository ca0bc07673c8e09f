#include "station/session/sitting.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "station/protocol/resolve.hpp"
#include "station/session/burst.hpp"
#include "station/session/rows.hpp"
#include "station/session/trial_plan.hpp"

namespace turnpoint::session {

namespace {

constexpr std::int64_t kForever = std::numeric_limits<std::int64_t>::max();
constexpr int kVoidsBeforeStop = 3;

}  // namespace

Sitting::Sitting(const Setup& setup, std::uint64_t seed, store::SessionLog log, std::unique_ptr<Stage> stage,
                 Display* display, Monitor* monitor)
    : setup_(setup),
      log_(std::move(log)),
      stage_(std::move(stage)),
      display_(display),
      monitor_(monitor),
      planner_(setup.rig),
      director_(setup.protocol, log_.session().sequence_index, seed),
      pages_(setup) {
  summary_.session_id = log_.session().session_id;
  summary_.participant = setup.participant;
  summary_.protocol_id = setup.protocol.id;
  summary_.database = setup.database;
  summary_.run_mode = store::name(setup.run_mode);
  summary_.seed = seed;
}

Summary Sitting::run() {
  started_ns_ = stage_->now_ns();
  replay_stored_blocks();
  while (director_.block() != nullptr)
    if (run_block() == Flow::stop) break;
  if (stop_asked_)
    finish(store::SessionStatus::interrupted, stop_reason_);
  else if (!director_.ended_because().empty())
    finish(store::SessionStatus::stopped, director_.ended_because());
  else
    finish(store::SessionStatus::completed, "");
  show(pages_.end(summary_));
  stage_->finish();
  return summary_;
}

Sitting::Flow Sitting::run_block() {
  const auto block = *director_.block();
  log_.begin_block(block_start(block, director_.block_index(), director_.attempt()));
  auto page = director_.attempt() > 0 && block.practice ? pages_.practice_again(block, director_)
                                                        : pages_.instructions(block, director_);
  if (show_and_wait(std::move(page), 0) == Flow::stop) return Flow::stop;
  int trials = 0;
  while (const auto spec = director_.next()) {
    if (run_trial(*spec) == Flow::stop) return Flow::stop;
    ++trials;
    if (rest_if_due(trials) == Flow::stop) return Flow::stop;
  }
  for (const auto& e : director_.estimates())
    summary_.estimates.push_back({e.procedure, e.parameter, e.mean, e.sd});
  ++summary_.blocks;
  director_.finish_block();
  return Flow::go_on;
}

Sitting::Flow Sitting::rest_if_due(int trials) {
  const auto& block = *director_.block();
  if (!block.break_after || trials % block.break_after->trials != 0) return Flow::go_on;
  if (!director_.next()) return Flow::go_on;  // nothing follows that a break could divide
  return show_and_wait(pages_.rest(block, block.break_after->min_s, director_), block.break_after->min_s);
}

Sitting::Flow Sitting::run_trial(const TrialSpec& spec) {
  store::TrialRow row = row_of(spec, setup_.protocol, trial_index_);
  trial::Machine machine(trial_plan(setup_.protocol, *director_.block(), spec));
  for (const auto& stale : stage_->drain()) note(stale);
  if (monitor_ != nullptr) monitor_->trial_begins(spec, *director_.block());
  log_.presented(trial_index_, stage_->now_ns());
  drive_trial(spec, machine, row);
  finish_row(spec, machine, row);
  TrialEnd end{row.outcome, machine.result().response, row.correct};
  director_.record(end);
  row.state_hash = director_.state_hash();
  if (const auto threshold = director_.threshold()) {
    row.threshold_est = threshold->first;
    row.threshold_sd = threshold->second;
  }
  log_.append(row);
  count(spec, row);
  if (monitor_ != nullptr) monitor_->trial_ended(spec, row);
  ++trial_index_;
  if (stop_asked_) return Flow::stop;
  if (std::exchange(pause_asked_, false)) return show_and_wait(pages_.paused(director_), 0);
  if (row.outcome != store::TrialOutcome::fault) {
    voids_in_a_row_ = 0;
    return Flow::go_on;
  }
  if (++voids_in_a_row_ >= kVoidsBeforeStop) {
    stop_asked_ = true;
    stop_reason_ = "three trials in a row were void";
    return Flow::stop;
  }
  return show_and_wait(pages_.fault(fault_, stop_reason_, director_), 0);
}

void Sitting::drive_trial(const TrialSpec& spec, trial::Machine& machine, store::TrialRow& row) {
  perform(machine.start(stage_->now_ns()), spec, machine, row);
  while (!machine.done()) {
    const auto wake = machine.wake_ns();
    const auto input = stage_->wait_until(wake.value_or(kForever));
    if (!input) {
      perform(machine.handle({*wake, trial::EventKind::tick, 0}), spec, machine, row);
      continue;
    }
    note(*input);
    if (input->kind == InputKind::answer) row.response_time_quality = name(input->quality);
    if (input->kind == InputKind::stop || input->kind == InputKind::pause) {
      stop_asked_ = input->kind == InputKind::stop;
      pause_asked_ = input->kind == InputKind::pause;
      stop_reason_ = "stopped by the participant or the operator";
    }
    if (input->kind == InputKind::fault) stop_reason_ = input->text, fault_ = input->fault;
    if (input->kind == InputKind::xrun) stop_reason_ = input->text, fault_ = FaultKind::stimulus_missed;
    if (const auto event = event_of(*input)) perform(machine.handle(*event), spec, machine, row);
  }
}

void Sitting::perform(const std::vector<trial::Action>& actions, const TrialSpec& spec,
                      trial::Machine& machine, store::TrialRow& row) {
  for (const auto& action : actions) {
    switch (action.kind) {
      case trial::ActionKind::enter: {
        const auto phase = static_cast<trial::Phase>(action.value);
        if (phase == trial::Phase::done) break;
        show(pages_.of_phase(phase, machine.interval(), spec, *director_.block(), machine.result(),
                             director_));
        break;
      }
      case trial::ActionKind::present:
        present(action.value, action.time_ns, spec, machine, row);
        break;
      case trial::ActionKind::silence:
        stage_->silence();
        break;
    }
  }
}

void Sitting::present(int interval, std::int64_t earliest_ns, const TrialSpec& spec, trial::Machine& machine,
                      store::TrialRow& row) {
  const auto index = static_cast<std::size_t>(interval);
  const auto times = interval_times(setup_.protocol, spec)[index];
  std::vector<scene::DrivePlan> plans;
  for (const auto& name : spec.intervals[index])
    plans.push_back(
        planner_.plan(protocol::resolve(setup_.protocol, name, spec.factors, spec.rove_dB[index])));
  const auto burst = burst_of(plans, times.starts_s, setup_.protocol.task.transition_ms.value_or(50) * 1e-3,
                              times.length_s, setup_.rig.output.rate_Hz);
  const auto onset = stage_->present(burst, earliest_ns);
  add_tones(row, plans, interval, onset.frame, burst);
  perform(machine.handle({onset.time_ns, trial::EventKind::onset, interval}), spec, machine, row);
  if (interval + 1 == static_cast<int>(spec.intervals.size())) {
    const auto last = interval_times(setup_.protocol, spec).back();
    auto zero = onset.time_ns;
    const auto ns = [](double s) { return static_cast<std::int64_t>(s * 1e9); };
    if (setup_.protocol.timing.response_zero == protocol::ResponseZero::interval_off)
      zero += ns(last.length_s);
    if (setup_.protocol.timing.response_zero == protocol::ResponseZero::change)
      zero += ns(last.starts_s.front());
    stage_->question(question_of(spec, setup_.protocol, summary_.seed), zero);
  }
}

void Sitting::finish_row(const TrialSpec& spec, const trial::Machine& machine, store::TrialRow& row) {
  fill_result(row, machine.result(), spec, setup_.protocol, started_ns_);
  row.response_offset_s = setup_.response_offset_s;
  if (const auto fit = stage_->clock_fit()) {
    row.clock_slope_ns_per_frame = fit->slope_ns_per_frame;
    row.clock_residual_ns = fit->residual_ns;
  }
}

void Sitting::count(const TrialSpec& spec, const store::TrialRow& row) {
  ++summary_.trials;
  summary_.xruns += row.xruns;
  switch (row.outcome) {
    case store::TrialOutcome::answered:
      ++summary_.answered;
      break;
    case store::TrialOutcome::timeout:
      ++summary_.timeouts;
      break;
    case store::TrialOutcome::anticipation:
      ++summary_.anticipations;
      break;
    case store::TrialOutcome::aborted:
    case store::TrialOutcome::fault:
      ++summary_.voided;
      break;
  }
  if (spec.type == store::TrialType::experimental && row.correct) ++scored_, right_ += *row.correct ? 1 : 0;
}

Sitting::Flow Sitting::show_and_wait(Page page, double at_least_s) {
  const auto earliest = stage_->now_ns() + static_cast<std::int64_t>(at_least_s * 1e9);
  show(page);
  while (stage_->now_ns() < earliest)
    if (const auto input = stage_->wait_until(earliest)) {
      note(*input);
      if (input->kind == InputKind::stop) return stop_asked_ = true, Flow::stop;
    }
  if (at_least_s > 0) {
    page.remaining_s = 0;
    show(page);
  }
  while (const auto input = stage_->wait_until(kForever)) {
    note(*input);
    if (input->kind == InputKind::next) return Flow::go_on;
    if (input->kind == InputKind::stop) {
      stop_asked_ = true;
      stop_reason_ = "stopped by the participant or the operator";
      return Flow::stop;
    }
  }
  return Flow::go_on;
}

void Sitting::replay_stored_blocks() {
  const auto& stored = log_.stored_blocks();
  if (setup_.resume_session.empty()) return;
  for (const auto& block : stored) {
    enter_stored(block.start);
    for (const auto& trial : block.trials) {
      ++trial_index_;
      if (trial.type != store::TrialType::warmup) replay(director_, trial, setup_.protocol);
    }
  }
  switch (setup_.resume_at) {
    case ResumeAt::next_trial:
      if (director_.trials_done() > 0) director_.warm_up(setup_.protocol.resume.warmup);
      break;
    case ResumeAt::block_start:
      director_.restart_block();
      break;
    case ResumeAt::session_start:
      director_.restart_session();
      break;
  }
}

/// Takes the director to a block that the log holds: by finishing what is done, or by the restart that made
/// it.
void Sitting::enter_stored(const store::BlockStart& block) {
  const auto here = [&] {
    return director_.block_index() == block.block_index && director_.attempt() == block.attempt;
  };
  if (!here() && director_.block() != nullptr && !director_.next()) director_.finish_block();
  if (!here() && block.block_index == 0 && block.attempt > director_.attempt()) director_.restart_session();
  while (!here() && director_.block_index() == block.block_index && director_.attempt() < block.attempt)
    director_.restart_block();
  if (!here())
    throw std::runtime_error("resume: the log's block " + std::to_string(block.block_index) +
                             " is not the one that the protocol runs next; they do not belong together");
}

void Sitting::show(const Page& page) {
  if (display_ != nullptr) display_->show(page);
}

void Sitting::note(const Input& input) {
  log_.event(event_row(input, trial_index_));
  if (input.kind == InputKind::note && !input.text.empty()) log_.annotate(input.text);
}

void Sitting::finish(store::SessionStatus status, const std::string& reason) {
  summary_.status = status;
  summary_.reason = reason;
  summary_.duration_s = static_cast<double>(stage_->now_ns() - started_ns_) * 1e-9;
  if (scored_ > 0) summary_.accuracy = static_cast<double>(right_) / scored_;
  log_.finish(status, reason);
}

}  // namespace turnpoint::session

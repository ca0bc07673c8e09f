#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "station/session/rows.hpp"
#include "station/session/session_run.hpp"
#include "station/terms/program_failed.hpp"
#include "station/text/number.hpp"
#include "station/trial/question.hpp"
#include "station/trial/rows.hpp"
#include "station/trial/timing.hpp"

namespace turnpoint::session {

namespace {

constexpr int kVoidsBeforeStop = 3;
/// A simulated observer that can never answer in time would otherwise go on for ever.
constexpr int kUnansweredBeforeStop = 1000;
constexpr int kRefusedBeforePage = 2;

bool is_over(trial::Phase phase) {
  return phase == trial::Phase::feedback || phase == trial::Phase::late || phase == trial::Phase::interval ||
         phase == trial::Phase::done;
}

records::EventRow event(std::int64_t time_ns, const char* kind, double value, int trial_index) {
  records::EventRow row;
  row.time_ns = time_ns;
  row.kind = kind;
  row.value = text::number(value, 9);
  row.trial_index = trial_index;
  return row;
}

}  // namespace

Flow SessionRun::run_trial(const trial::TrialSpec& spec) {
  if (prepare_trial(spec) == Flow::stop) return Flow::stop;
  log_temperature();
  Running trial{spec,
                trial::Machine(trial::timing_of(setup_.protocol, *director_.block(), spec)),
                trial::row_of(spec, setup_.protocol, trial_index()),
                {},
                {},
                {}};
  if (spec.slider) trial.slider.emplace(*spec.slider, spec.level.value_or(spec.slider->low));
  if (monitor_ != nullptr) monitor_->trial_begins(spec, *director_.block(), plans_.take(spec).plans);
  // Write this event to the disk before the amplifier is switched on. Writing may take seconds, in which the
  // session cannot do anything else.
  gate_.keep([&] { log_.presented(trial_index(), stage_->now_ns()); });
  drive_trial(trial, open_amplifier());
  stage_->close_amplifier();
  if (!trial.decided) decide(trial);
  plan_ahead();
  leave_surface();
  log_triggers();
  finish_row(trial);
  keep_raw(trial);
  gate_.keep([&] { log_.append(trial.row); });
  count(spec, trial.row);
  correct_drift();
  if (monitor_ != nullptr) monitor_->trial_ended(spec, trial.row);
  return after_trial(trial);
}

/// Does everything that may take time or fail before a trial. It processes inputs since the previous trial,
/// gets the plans, checks the rig's limits, and waits until the amplifier is armed.
Flow SessionRun::prepare_trial(const trial::TrialSpec& spec) {
  plans_.begin(spec);
  try {
    if (keep_limits(spec) == Flow::stop) return Flow::stop;
    stage_->wait_for([&] { return plans_.ready(spec); });
    check_plans(spec);
  } catch (const scene::Unreachable& unreachable) {
    gate_.stop(unreachable.what());
  } catch (const limits::LimitExceeded& limit) {
    return gate_.end_at_limit(limit.what());
  } catch (const drive::BurstRefused& refused) {
    gate_.stop(refused.what());
  }
  for (auto& stale : stage_->drain()) gate_.note(gate_.received(std::move(stale)));
  return gate_.until_clear();
}

/// Switches the amplifier on. From now on, a fault makes the trial void.
std::optional<trial::EventKind> SessionRun::open_amplifier() {
  if (gate_.stop_asked()) return trial::EventKind::abort;
  if (!gate_.fault()) gate_.set_fault(stage_->open_amplifier());
  return gate_.fault() ? std::optional(trial::EventKind::fault) : std::nullopt;
}

/// Extends the pause before the trial until the rig's limits on duty cycle and continuous vibration allow the
/// trial.
Flow SessionRun::keep_limits(const trial::TrialSpec& spec) {
  const auto now = stage_->now_ns();
  const auto begin = account_.earliest_ns(now, limits::stimuli_of(setup_.protocol, spec));
  if (begin <= now) return Flow::go_on;
  const double stretch_s = static_cast<double>(begin - now) * 1e-9;
  summary_.stretched_s += stretch_s;
  log_.event(event(now, "interval_stretched", stretch_s, trial_index()));
  const auto page = pages_.between_trials(director_.block(), director_);
  gate_.show(page);
  while (stage_->now_ns() < begin)
    if (auto input = stage_->wait_until(begin))
      if (gate_.handle_on_page(page, gate_.received(std::move(*input))) == Flow::stop) return Flow::stop;
  return Flow::go_on;
}

/// Checks the scenes against the rig's limits, just before they are presented. Throws limits::LimitExceeded.
void SessionRun::check_plans(const trial::TrialSpec& spec) {
  const auto& plans = plans_.take(spec).plans;
  const auto times = trial::interval_times(setup_.protocol, spec);
  for (std::size_t i = 0; i < plans.size(); ++i)
    for (const auto& plan : plans[i]) {
      account_.check(plan.peak_displacement_m, times[i].length_s);
      if (setup_.run_mode != terms::RunMode::live) continue;
      for (const auto& tone : plan.tones)
        if (const auto problem = limits::sound_problem(tone.frequency_Hz, tone.full_scale, setup_.sound))
          throw limits::LimitExceeded(texts::say(*problem, "en"));
    }
}

Flow SessionRun::after_trial(const Running& trial) {
  if (gate_.stop_asked()) return Flow::stop;
  const auto& row = trial.row;
  const bool repeated = trial.outside && row.outcome == terms::Outcome::fault;
  repeats_in_a_row_ = repeated ? repeats_in_a_row_ + 1 : 0;
  // A single refused stimulus can be a coincidence, so it is presented again. Two in a row stop the session.
  const bool refused = row.proof == terms::Proof::refused || row.proof == terms::Proof::stopped;
  refused_in_a_row_ = refused ? refused_in_a_row_ + 1 : 0;
  if ((row.proof == terms::Proof::stopped || refused_in_a_row_ >= kRefusedBeforePage) && !gate_.fault())
    gate_.set_fault(Fault{FaultKind::vibration, describe_proof(row)});
  unanswered_in_a_row_ = row.outcome == terms::Outcome::answered ? 0 : unanswered_in_a_row_ + 1;
  if (!setup_.observer.empty() && unanswered_in_a_row_ >= kUnansweredBeforeStop) {
    gate_.stop(
        fmt::format("the simulated observer left {} trials in a row unanswered", kUnansweredBeforeStop));
    return Flow::stop;
  }
  voids_in_a_row_ = trial.is_void() ? voids_in_a_row_ + 1 : 0;
  if (voids_in_a_row_ >= kVoidsBeforeStop) {
    gate_.stop(records::kVoidsReason +
               (gate_.fault() ? records::kVoidsLast + terms::describe(*gate_.fault()) : std::string()));
    return Flow::stop;
  }
  if (gate_.fault() && gate_.recover() == Flow::stop) return Flow::stop;
  return gate_.pause_if_asked();
}

void SessionRun::drive_trial(Running& trial, std::optional<trial::EventKind> cut_by) {
  auto& machine = trial.machine;
  if (!cut_by) trigger(protocol::TriggerEvent::trial, trial);
  perform(machine.start(stage_->now_ns()), trial);
  if (cut_by) perform(machine.handle({stage_->now_ns(), *cut_by, 0}), trial);
  while (!machine.done()) {
    const auto wake = machine.wake_ns();
    const auto follow_ns = trial.slider ? trial.slider->glide_due_ns().value_or(kForever) : kForever;
    const auto until = std::min(wake.value_or(kForever), follow_ns);
    const auto bars_ns = guide_.guides() || is_finger_watched() ? guide_due_ns_ : kForever;
    auto input = stage_->wait_until(std::min(until, bars_ns));
    if (input)
      handle_in_trial(std::move(*input), trial);
    else if (bars_ns < until)
      move_bars();
    else if (follow_ns <= until && follow_ns != kForever)
      glide(trial);
    else
      perform(machine.handle({*wake, trial::EventKind::tick, 0}), trial);
  }
}

void SessionRun::handle_in_trial(Input raw, Running& trial) {
  const bool by_button = raw.kind == InputKind::button;
  const auto input = gate_.received(std::move(raw));
  gate_.note(input);
  if (input.measured) follow_drift(*input.measured);
  if (input.measured) add_measured(trial.row, *input.measured, input.value, trial.measured++ == 0);
  if (input.forces && !trial.onsets.empty()) {
    const auto& onset = trial.onsets.front();
    add_forces(trial.row, *input.forces, {trial.friction_level, part_of(trial.spec)},
               setup_.rig.output.rate_Hz,
               {onset.frame, 1e-9 * static_cast<double>(onset.time_ns - started_ns_)});
    const bool asked = setup_.protocol.sensing && input.forces->state == sensing::ForcesState::ok;
    // A stimulus that was not the planned one makes the trial void, however the finger moved.
    const bool refuted = trial.row.proof == terms::Proof::refused ||
                         trial.row.proof == terms::Proof::stopped || trial.row.proof == terms::Proof::lost;
    trial.outside = asked && !refuted && !is_training() && input.forces->movement != sensing::Movement::ok;
    if (trial.outside && repeats_in_a_row_ < setup_.protocol.sensing->repeats)
      perform(trial.machine.handle({input.time_ns, trial::EventKind::outside, 0}), trial);
    else if (trial.spec.strokes)
      judge_strokes(input, trial);
  }
  const bool answers = input.kind == InputKind::answer || input.kind == InputKind::value ||
                       (trial.slider && input.kind == InputKind::next);
  if (answers && !trial.spec.strokes && !trial.machine.result().response) {
    trial.row.response_time_quality = name(input.quality);
    trial.by_button = by_button;
  }
  const bool answered = trial.machine.result().response.has_value();
  if (const auto event = event_in_trial(input, trial, by_button))
    perform(trial.machine.handle(*event), trial);
  if (!answered && trial.machine.result().response) trigger(protocol::TriggerEvent::response, trial);
}

void SessionRun::perform(const std::vector<trial::Action>& actions, Running& trial) {
  for (const auto& action : actions) {
    switch (action.kind) {
      case trial::ActionKind::enter: {
        const auto phase = static_cast<trial::Phase>(action.value);
        if (phase == trial::Phase::response || phase == trial::Phase::confidence || is_over(phase))
          stage_->close_amplifier();
        if (phase == trial::Phase::done) break;
        if (phase == trial::Phase::stimulus) interval_begins(trial);
        if (trial.machine.decided() && !trial.decided) decide(trial);
        show_phase(phase, trial);
        break;
      }
      case trial::ActionKind::present:
        present(action.time_ns, trial);
        break;
      case trial::ActionKind::signal:
        show_phase(trial.machine.phase(), trial);
        break;
      case trial::ActionKind::silence: {
        const auto silent_ns = stage_->silence(!trial.machine.done());
        for (auto& interval : surface_) interval.off_ns = std::min(interval.off_ns, silent_ns);
        break;
      }
    }
  }
  if (trial.machine.decided() && !trial.machine.done() && !trial.decided) decide(trial);
}

/// Presents all intervals with one call, so that the distances between them are exact numbers of frames.
void SessionRun::present(std::int64_t earliest_ns, Running& trial) {
  const auto& bursts = plans_.take(trial.spec).bursts;
  try {
    trial.onsets = stage_->present(bursts, earliest_ns);
  } catch (const drive::BurstRefused& refused) {
    gate_.stop(refused.what());
    return perform(trial.machine.handle({stage_->now_ns(), trial::EventKind::abort, 0}), trial);
  }
  if (trial.onsets.empty()) return;  // the stage has added a fault with the reason to the inputs
  const auto times = trial::interval_times(setup_.protocol, trial.spec);
  for (std::size_t i = 0; i < bursts.size(); ++i) {
    const auto on_ns = trial.onsets[i].time_ns;
    surface_.push_back({on_ns, on_ns + static_cast<std::int64_t>(times[i].length_s * 1e9)});
    perform(trial.machine.handle({on_ns, trial::EventKind::onset, static_cast<int>(i)}), trial);
  }
  trigger_intervals(trial);
  ask_observer(trial, trial.onsets.back().time_ns);
}

/// Appends this interval's tones to the row. This happens only when the interval begins, so that intervals
/// that are cancelled do not appear in the row.
void SessionRun::interval_begins(Running& trial) {
  const auto i = trial.begun++;
  const auto& planned = plans_.take(trial.spec);
  add_tones(trial.row, planned.plans[i], static_cast<int>(i), trial.onsets[i].frame, planned.bursts[i]);
  trial.friction_level = friction_level(planned.plans[i].back().scene);
}

void SessionRun::ask_observer(const Running& trial, std::int64_t onset_ns) {
  if (trial.spec.strokes) return;
  const auto times = trial::simulated_times(setup_.protocol, trial.spec, onset_ns);
  try {
    if (trial.slider)
      stage_->adjustment(trial::adjustment_of(trial.spec, setup_.protocol, summary_.seed), trial.spec, times);
    else
      stage_->question(trial::question_of(trial.spec, setup_.protocol, summary_.seed), times);
  } catch (const terms::ProgramFailed& failed) {
    // The trial ends without a result, and the session is interrupted.
    Input failure;
    failure.kind = InputKind::failure;
    failure.text = failed.what();
    stage_->simulate(failure);
  }
}

/// Called once the outcome is final. Records the result, and starts planning of the next trial, which
/// continues during the pause.
void SessionRun::decide(Running& trial) {
  trial.decided = true;
  auto& row = trial.row;
  if (trial.slider) trial.value = trial.slider->felt();
  trial::fill_result(row, trial.machine.result(), trial.spec, setup_.protocol, started_ns_, trial.value);
  trial::TrialEnd end{row.outcome, trial.machine.result().response, row.correct, {}, {}};
  if (trial.slider && end.response) end.setting = trial.value;
  end.friction = row.finger.mu;
  director_.record(end);
  row.state_hash = director_.state_hash();
  if (const auto threshold = director_.threshold()) {
    row.threshold_est = threshold->first;
    row.threshold_sd = threshold->second;
  }
  plan_ahead();
}

/// Records when the surface vibrated, in the exposure account and in the log.
void SessionRun::leave_surface() {
  for (const auto& left : std::exchange(surface_, {})) {
    if (left.off_ns <= left.on_ns) continue;
    account_.add(left.on_ns, left.off_ns);
    log_.event(
        event(left.on_ns, "stimulus", static_cast<double>(left.off_ns - left.on_ns) * 1e-9, trial_index()));
  }
}

void SessionRun::finish_row(Running& trial) {
  auto& row = trial.row;
  trial::fill_result(row, trial.machine.result(), trial.spec, setup_.protocol, started_ns_, trial.value);
  const bool good = row.proof == terms::Proof::ok || row.proof == terms::Proof::flagged;
  if (good && trial.measured < trial.begun) row.proof = terms::Proof::unproven;
  const auto& found_for = setup_.response_offset_quality;
  const bool applies = !trial.by_button && (found_for.empty() || found_for == row.response_time_quality);
  row.response_offset_s = applies ? setup_.response_offset_s : 0;
  if (const auto fit = stage_->clock_fit()) {
    row.clock_slope_ns_per_frame = fit->slope_ns_per_frame;
    row.clock_residual_ns = fit->residual_ns;
  }
}

void SessionRun::count(const trial::TrialSpec& spec, const records::TrialRow& row) {
  ++summary_.trials;
  summary_.xruns += row.xruns;
  switch (row.outcome) {
    case terms::Outcome::answered:
      ++summary_.answered;
      break;
    case terms::Outcome::timeout:
      ++summary_.timeouts;
      break;
    case terms::Outcome::anticipation:
      ++summary_.anticipations;
      break;
    case terms::Outcome::aborted:
    case terms::Outcome::fault:
      ++summary_.voided;
      break;
  }
  interludes_.score(spec.block_index, spec.attempt, director_.block()->name, row);
  if (spec.type == terms::TrialType::experimental && row.correct) ++scored_, right_ += *row.correct ? 1 : 0;
}

}  // namespace turnpoint::session

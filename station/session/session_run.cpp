#include "station/session/session_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <future>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "station/core/number.hpp"
#include "station/core/usage_error.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/sources.hpp"
#include "station/protocol/tasks.hpp"
#include "station/protocol/triggers.hpp"
#include "station/session/burst.hpp"
#include "station/session/rows.hpp"
#include "station/session/self_test_rig.hpp"
#include "station/store/signal_code.hpp"
#include "station/trial/question.hpp"
#include "station/trial/rows.hpp"
#include "station/trial/timing.hpp"

namespace turnpoint::session {

SessionRun::SessionRun(const Setup& setup, trial::Director director, store::SessionLog log,
                       const Earlier& earlier, std::unique_ptr<Stage> stage, FingerAccount account,
                       SimulatedParticipant* participant, Display* display, Monitor* monitor,
                       Programs* programs)
    : setup_(setup),
      log_(std::move(log)),
      stage_(std::move(stage)),
      account_(std::move(account)),
      participant_(participant),
      display_(display),
      monitor_(monitor),
      programs_(programs),
      plans_(setup.rig, setup.protocol, log_.session().start.seed),
      director_(std::move(director)),
      pages_(setup),
      gate_(setup, pages_, director_, *stage_, log_, display),
      interludes_(setup, pages_, director_, scores_, gate_, *stage_, participant, log_,
                  [this](const protocol::Example& example, Page page) {
                    return play_example(example, std::move(page));
                  }),
      drift_(setup, *stage_, log_),
      guide_(setup.protocol.sensing) {
  interludes_.restore(earlier);
  scores_.add(earlier.blocks);
  summary_.session_id = log_.session().session_id;
  summary_.participant = setup.participant;
  summary_.protocol_id = setup.protocol.id;
  summary_.database = setup.database;
  summary_.run_mode = store::name(setup.run_mode);
  summary_.realtime_rights = stage_->realtime_rights();
  summary_.seed = log_.session().start.seed;
  use_measured_friction();
}

Summary SessionRun::run() {
  started_ns_ = stage_->now_ns();
  const auto& signal = setup_.protocol.timing.signal;
  if (signal && signal->by == protocol::ResponseSignal::By::flash && setup_.display_latency_s)
    log_.event({started_ns_, core::kDisplayLatencyEvent, core::number(*setup_.display_latency_s, 4), {}});
  // In a pilot session without a real amplifier, nobody has to arm it.
  if (setup_.run_mode != core::RunMode::live && setup_.rig.amplifier_uri == "sim:")
    // if arming is refused, until_armed() below shows a page
    static_cast<void>(stage_->arm());
  if (gate_.until_armed({FaultKind::disarmed, ""}) == Flow::go_on && pass_self_test() == Flow::go_on)
    static_cast<void>(run_parts());  // the code below finds out why the session ended
  if (!interludes_.ended_because().empty())
    finish(core::SessionStatus::stopped, interludes_.ended_because());
  else if (gate_.stop_asked())
    finish(core::SessionStatus::interrupted, gate_.stop_reason());
  else if (!director_.ended_because().empty())
    finish(core::SessionStatus::stopped, director_.ended_because());
  else
    finish(core::SessionStatus::completed, "");
  gate_.show(pages_.end(summary_, director_));
  stage_->finish();
  return summary_;
}

/// Runs all blocks and all interludes.
Flow SessionRun::run_parts() {
  while (director_.block() != nullptr) {
    // after a block's last trial, a resumed session only has to leave the block
    const bool resumed_at_end = !next_trial();
    if (gate_.stop_asked()) return Flow::stop;
    if (!resumed_at_end && interludes_.before(director_.block_index()) == Flow::stop) return Flow::stop;
    if (run_block() == Flow::stop) return Flow::stop;
  }
  return director_.ended_because().empty() ? interludes_.before(director_.blocks()) : Flow::stop;
}

Flow SessionRun::run_block() {
  const auto block = *director_.block();
  if (pass_mixer() == Flow::stop) return Flow::stop;
  const auto start = trial::block_start(block, director_.block_index(), director_.attempt());
  gate_.keep([&] { log_.begin_block(start); });
  scores_.begin(start);
  const auto first = next_trial();
  if (!first) return gate_.stop_asked() ? Flow::stop : leave_block();
  plans_.begin(*first);
  auto page = director_.attempt() > 0 && block.practice ? pages_.practice_again(block, director_)
                                                        : pages_.instructions(block, director_);
  pages_.add_mark(page, *first);
  if (gate_.show_and_wait(std::move(page), 0) == Flow::stop) return Flow::stop;
  int trials = 0;
  while (const auto spec = next_trial()) {
    if (run_trial(*spec) == Flow::stop) return Flow::stop;
    ++trials;
    if (rest_if_due(trials) == Flow::stop) return Flow::stop;
  }
  return gate_.stop_asked() ? Flow::stop : leave_block();
}

Flow SessionRun::leave_block() {
  if (pass_mixer() == Flow::stop) return Flow::stop;
  log_estimates();
  for (auto& e : director_.estimates()) summary_.estimates.push_back(std::move(e));
  for (auto& end : director_.early_ends()) {
    log_.event({stage_->now_ns(), core::kEndedEarlyEvent, core::say(end, "en"), {}});
    summary_.early_ends.push_back(std::move(end));
  }
  if (director_.block()->kind == protocol::BlockKind::friction_table && finish_friction_table() == Flow::stop)
    return Flow::stop;
  if (const auto page = pages_.block_over(*director_.block(), scores_.of(director_.block_index()),
                                          scores_.points(), director_))
    if (gate_.show_and_wait(*page, 0) == Flow::stop) return Flow::stop;
  ++summary_.blocks;
  director_.finish_block();
  return Flow::go_on;
}

Flow SessionRun::rest_if_due(int trials) {
  const auto& block = *director_.block();
  if (!block.break_after || trials % block.break_after->trials != 0) return Flow::go_on;
  if (!next_trial()) return Flow::go_on;  // a block's last trial is not followed by a break
  director_.rested();
  return gate_.show_and_wait(pages_.rest(block, block.break_after->min_s, director_),
                             block.break_after->min_s);
}

void SessionRun::finish(core::SessionStatus status, const std::string& reason) {
  summary_.status = status;
  summary_.reason = reason;
  finish_triggers();
  summary_.duration_s = static_cast<double>(stage_->now_ns() - started_ns_) * 1e-9;
  if (setup_.protocol.payoff) summary_.points = scores_.points();
  if (scored_ > 0) summary_.accuracy = static_cast<double>(right_) / scored_;
  gate_.keep([&] { log_.finish(status, reason); });
  summary_.checksum = log_.session().checksum;
}

namespace {

constexpr int kVoidsBeforeStop = 3;
/// A simulated observer that can never answer in time would otherwise go on for ever.
constexpr int kUnansweredBeforeStop = 1000;
constexpr int kRefusedBeforePage = 2;
/// After a pause between two trials that was stretched by this time, the next trial counts as one after a
/// rest.
constexpr double kLongStretch_s = 5;

FollowPlans follow_plans_of(const PlanAhead::Plans& plans) {
  FollowPlans follows;
  for (const auto& scenes : plans) follows.push_back(scenes.front().follow);
  return follows;
}

bool is_over(trial::Phase phase) {
  return phase == trial::Phase::feedback || phase == trial::Phase::late || phase == trial::Phase::interval ||
         phase == trial::Phase::done;
}

core::EventRow event(std::int64_t time_ns, const char* kind, double value, int trial_index) {
  return {time_ns, kind, core::number(value, 9), trial_index};
}

/// Shortens the scenes of a part that was cut off at `off_ns`, because the participant asked for the
/// intervals again.
void cut_tones(core::TrialRow& row, int part, const Onset& onset, std::int64_t off_ns, int rate_Hz) {
  const std::int64_t end =
      onset.frame + std::llround(1e-9 * static_cast<double>(off_ns - onset.time_ns) * rate_Hz);
  for (auto& tone : row.tones)
    if (tone.interval_index == part)
      tone.length_frames = std::clamp(end - tone.onset_frame, std::int64_t{0}, tone.length_frames);
}

}  // namespace

Flow SessionRun::run_trial(trial::TrialSpec spec) {
  for (bool ready = false; !ready;) {
    if (prepare_trial(spec) == Flow::stop) return Flow::stop;
    // A pause may have come just before the trial, whose first part is then longer.
    const auto now = next_trial();
    if (!now) return Flow::stop;
    ready = *now == spec;
    spec = *now;
  }
  drift_.log_temperature(trial_index());
  Running trial{spec,
                spec,
                trial::Machine(trial::timing_of(setup_.protocol, *director_.block(), spec,
                                                trial::parts_of(setup_.protocol, spec))),
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
  director_.spend(trial.row.timing.duration_s);
  if (const auto share = drift_.correction(trial_index())) {
    plans_.set_drift(*share);  // a trial that is already planned is planned again
    if (auto* watch = stage_->watch()) watch->set_drift(*share);
  }
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
    const auto& planned = plans_.take(spec);
    stage_->follow(follow_plans_of(planned.plans), planned.bursts);
  } catch (const scene::Unreachable& unreachable) {
    gate_.stop(unreachable.what());
  } catch (const LimitExceeded& limit) {
    return gate_.end_at_limit(limit.what());
  } catch (const audio::BurstRefused& refused) {
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
  const auto begin = account_.earliest_ns(now, session::stimuli_of(setup_.protocol, spec));
  if (begin <= now) return Flow::go_on;
  const double stretch_s = static_cast<double>(begin - now) * 1e-9;
  summary_.stretched_s += stretch_s;
  log_.event(event(now, "interval_stretched", stretch_s, trial_index()));
  const auto page = pages_.between_trials(director_.block(), director_);
  gate_.show(page);
  while (stage_->now_ns() < begin)
    if (auto input = stage_->wait_until(begin))
      if (gate_.handle_on_page(page, gate_.received(std::move(*input))) == Flow::stop) return Flow::stop;
  if (stretch_s >= kLongStretch_s) director_.rested();
  return Flow::go_on;
}

/// Checks the scenes against the rig's limits, just before they are presented. Throws LimitExceeded.
void SessionRun::check_plans(const trial::TrialSpec& spec) {
  const auto& plans = plans_.take(spec).plans;
  const auto parts = trial::parts_of(setup_.protocol, spec);
  for (std::size_t i = 0; i < plans.size(); ++i)
    for (const auto& plan : plans[i]) {
      const double gain = plan.follow ? plan.follow->map.most_gain() : 1;
      account_.check(gain * plan.peak_displacement_m, parts[i].length_s);
      if (setup_.run_mode != core::RunMode::live) continue;
      for (const auto& tone : plan.tones)
        if (const auto problem =
                session::sound_problem(tone.frequency_Hz, gain * tone.full_scale, setup_.sound))
          throw LimitExceeded(core::say(*problem, "en"));
    }
}

Flow SessionRun::after_trial(const Running& trial) {
  if (gate_.stop_asked()) return Flow::stop;
  const auto& row = trial.row;
  const bool repeated = trial.outside && row.outcome == core::Outcome::fault;
  repeats_in_a_row_ = repeated ? repeats_in_a_row_ + 1 : 0;
  // A single refused stimulus can be a coincidence, so it is presented again. Two in a row stop the session.
  const bool refused = row.surface.proof == core::Proof::refused || row.surface.proof == core::Proof::stopped;
  refused_in_a_row_ = refused ? refused_in_a_row_ + 1 : 0;
  if ((row.surface.proof == core::Proof::stopped || refused_in_a_row_ >= kRefusedBeforePage) &&
      !gate_.fault())
    gate_.set_fault(Fault{FaultKind::vibration, describe_proof(row.surface)});
  unanswered_in_a_row_ = row.outcome == core::Outcome::answered ? 0 : unanswered_in_a_row_ + 1;
  if (!setup_.observer.empty() && unanswered_in_a_row_ >= kUnansweredBeforeStop) {
    gate_.stop(
        fmt::format("the simulated observer left {} trials in a row unanswered", kUnansweredBeforeStop));
    return Flow::stop;
  }
  voids_in_a_row_ = trial.is_void() ? voids_in_a_row_ + 1 : 0;
  if (voids_in_a_row_ >= kVoidsBeforeStop) {
    gate_.stop(core::kVoidsReason +
               (gate_.fault() ? core::kVoidsLast + core::describe(*gate_.fault()) : std::string()));
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
  const bool by_button = raw.is<input::Button>();
  const auto input = gate_.received(std::move(raw));
  gate_.note(input);
  const auto* measured = input.as<input::Measured>();
  if (measured) drift_.follow(*measured->result);
  if (measured)
    add_measured(trial.row, *measured->result, static_cast<int>(trial.first) + measured->interval,
                 trial.measured++ == 0);
  if (measured && measured->forces && !trial.onsets.empty()) {
    const auto& forces = *measured->forces;
    const auto& onset = trial.onsets.front();
    // the row describes the finger in the last presentation
    std::erase_if(trial.row.signal_rows, [](const auto& signal) { return signal.stream == kFingerStream; });
    add_forces(trial.row, forces, {trial.friction_level, part_of(trial.spec)}, setup_.rig.output.rate_Hz,
               {onset.frame, 1e-9 * static_cast<double>(onset.time_ns - started_ns_)});
    const bool asked = setup_.protocol.sensing && forces.state == sensing::ForcesState::ok;
    // A stimulus that was not the planned one makes the trial void, however the finger moved.
    const bool refuted = trial.row.surface.proof == core::Proof::refused ||
                         trial.row.surface.proof == core::Proof::stopped ||
                         trial.row.surface.proof == core::Proof::lost;
    trial.outside = asked && !refuted && !is_training() && forces.movement != sensing::Movement::ok;
    if (trial.outside && repeats_in_a_row_ < setup_.protocol.sensing->repeats)
      perform(trial.machine.handle({input.time_ns, trial::EventKind::outside, 0}), trial);
    else if (trial.spec.strokes)
      judge_strokes(forces, input, trial);
  }
  const bool answers =
      input.is<input::Answer>() || input.is<input::Value>() || (trial.slider && input.is<input::Next>());
  if (answers && !trial.spec.strokes && !trial.machine.result().response) {
    trial.row.timing.response_time_quality = name(input.quality);
    trial.by_button = by_button;
  }
  const bool answered = trial.machine.result().response.has_value();
  const bool confides = trial.machine.phase() == trial::Phase::confidence;
  if (const auto event = event_in_trial(input, trial, by_button))
    perform(trial.machine.handle(*event), trial);
  // A page takes one answer each time it is shown.
  if (confides && input.is<input::Answer>() && !by_button &&
      trial.machine.phase() == trial::Phase::confidence)
    show_phase(trial::Phase::confidence, trial);
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
  if (trial.machine.result().again > 0) {
    const auto after_ns = prepare_again(earliest_ns, trial);
    if (!after_ns) return;
    earliest_ns = *after_ns;
  }
  const auto& planned = plans_.take(trial.shown);
  const auto& bursts = planned.bursts;
  try {
    trial.onsets = stage_->present(bursts, earliest_ns);
  } catch (const audio::BurstRefused& refused) {
    gate_.stop(refused.what());
    return perform(trial.machine.handle({stage_->now_ns(), trial::EventKind::abort, 0}), trial);
  }
  if (trial.onsets.empty()) return;  // the stage has added a fault with the reason to the inputs
  trial.follows = follow_plans_of(planned.plans);
  trial.presented.clear();
  const auto parts = trial::parts_of(setup_.protocol, trial.spec);
  for (std::size_t i = 0; i < bursts.size(); ++i) {
    const auto on_ns = trial.onsets[i].time_ns;
    trial.presented.push_back({trial.onsets[i].frame, trial.onsets[i].frame + bursts[i].length_frames});
    surface_.push_back({on_ns, on_ns + static_cast<std::int64_t>(parts[i].length_s * 1e9)});
    perform(trial.machine.handle({on_ns, trial::EventKind::onset, static_cast<int>(i)}), trial);
  }
  trigger_intervals(trial);
  ask_observer(trial, trial.onsets.back().time_ns);
}

/// Does before the intervals are presented again what prepare_trial() does before a trial: records what the
/// finger has felt, finds the time from which the rig's limits allow the intervals, and switches the
/// amplifier on. Returns that time; nothing if the trial has ended instead.
std::optional<std::int64_t> SessionRun::prepare_again(std::int64_t earliest_ns, Running& trial) {
  stage_->close_amplifier();
  if (trial.slider) {
    const auto& adjusts = protocol::of_task(setup_.protocol, trial.spec.task).task.adjusts;
    trial.shown.factors[adjusts] = trial.slider->glide(stage_->now_ns());
    trial.slider->followed();
    plans_.begin(trial.shown);
  }
  cut_tones(trial.row, static_cast<int>(trial.begun) - 1, trial.onsets.back(), surface_.back().off_ns,
            setup_.rig.output.rate_Hz);
  leave_surface();
  std::optional<trial::EventKind> cut_by;
  try {
    check_plans(trial.shown);
    const auto now = stage_->now_ns();
    const auto begin = account_.earliest_ns(now, session::stimuli_of(setup_.protocol, trial.spec));
    if (begin > now) {
      earliest_ns += begin - now;
      const double stretch_s = static_cast<double>(begin - now) * 1e-9;
      summary_.stretched_s += stretch_s;
      log_.event(event(now, "interval_stretched", stretch_s, trial_index()));
    }
    // Write to the disk while the amplifier is off, as before the trial.
    stage_->wait_for(
        [&] { return stage_->amplifier() != audio::AmplifierState::enabled && plans_.ready(trial.shown); });
    gate_.keep([&] { log_.presented(trial_index(), stage_->now_ns()); });
    record_followed(trial);
    const auto& planned = plans_.take(trial.shown);
    stage_->follow(follow_plans_of(planned.plans), planned.bursts);
    cut_by = open_amplifier();
  } catch (const LimitExceeded& limit) {
    gate_.stop(limit.what());
    cut_by = trial::EventKind::abort;
  } catch (const audio::BurstRefused& refused) {
    gate_.stop(refused.what());
    cut_by = trial::EventKind::abort;
  }
  trial.first = trial.begun;
  if (!cut_by) return earliest_ns;
  perform(trial.machine.handle({stage_->now_ns(), *cut_by, 0}), trial);
  return std::nullopt;
}

/// Appends this part's tones to the row. This happens only when the part begins, so that parts that are
/// cancelled do not appear in the row.
void SessionRun::interval_begins(Running& trial) {
  const auto number = trial.begun++, i = number - trial.first;
  const auto& planned = plans_.take(trial.shown);
  const auto interval = trial::parts_of(setup_.protocol, trial.spec)[i].interval;
  add_tones(trial.row, planned.plans[i], static_cast<int>(number), interval, trial.onsets[i].frame,
            planned.bursts[i]);
  trial.friction_level = friction_level(planned.plans[i].back().scene);
}

void SessionRun::ask_observer(const Running& trial, std::int64_t onset_ns) {
  if (!participant_ || trial.spec.strokes) return;
  const auto now_ns = stage_->now_ns();
  const auto times = trial::simulated_times(setup_.protocol, trial.spec,
                                            trial::parts_of(setup_.protocol, trial.spec).back(), onset_ns);
  try {
    if (trial.slider)
      participant_->set(trial::adjustment_of(trial.spec, setup_.protocol, summary_.seed), trial.spec, times,
                        now_ns, trial.machine.result().again);
    else
      participant_->answer(trial::question_of(trial.spec, setup_.protocol, summary_.seed), times, now_ns,
                           trial.machine.result().again);
  } catch (const core::ProgramFailed& failed) {
    // The trial ends without a result, and the session is interrupted.
    participant_->will({now_ns, input::Failure{failed.what()}}, now_ns);
  }
}

/// Called once the outcome is final. Records the result, and starts planning of the next trial, which
/// continues during the pause.
void SessionRun::decide(Running& trial) {
  trial.decided = true;
  auto& row = trial.row;
  if (trial.slider) trial.value = trial.slider->felt();
  trial::fill_result(row, trial.machine.result(), trial.spec, setup_.protocol, started_ns_, trial.value);
  trial::TrialEnd end{row.outcome, trial.machine.result().response, row.given.correct, {}, {}};
  if (trial.slider && end.response) end.setting = trial.value;
  end.friction = row.finger.mu;
  director_.record(end);
  row.learned.state_hash = director_.state_hash();
  if (const auto threshold = director_.threshold()) {
    row.learned.threshold_est = threshold->first;
    row.learned.threshold_sd = threshold->second;
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

/// Records what the intervals of the last presentation did that follow the finger; once for each
/// presentation.
void SessionRun::record_followed(Running& trial) {
  const auto followed = stage_->followed();
  auto follows = std::exchange(trial.follows, {});
  if (trial.onsets.empty()) return;
  const auto& onset = trial.onsets.front();
  follows.resize(std::min(follows.size(), trial.begun - trial.first));  // the others were not presented
  add_followed(trial.row, followed, follows, trial.presented, setup_.rig.output.rate_Hz,
               {onset.frame, 1e-9 * static_cast<double>(onset.time_ns - started_ns_)});
}

void SessionRun::finish_row(Running& trial) {
  auto& row = trial.row;
  record_followed(trial);
  trial::fill_result(row, trial.machine.result(), trial.spec, setup_.protocol, started_ns_, trial.value);
  const bool good = row.surface.proof == core::Proof::ok || row.surface.proof == core::Proof::flagged;
  if (good && trial.measured < trial.begun) row.surface.proof = core::Proof::unproven;
  const auto& found_for = setup_.response_offset_quality;
  const bool applies =
      !trial.by_button && (found_for.empty() || found_for == row.timing.response_time_quality);
  row.timing.response_offset_s = applies ? setup_.response_offset_s : 0;
  if (const auto fit = stage_->clock_fit()) {
    row.timing.clock_slope_ns_per_frame = fit->slope_ns_per_frame;
    row.timing.clock_residual_ns = fit->residual_ns;
  }
}

void SessionRun::count(const trial::TrialSpec& spec, const core::TrialRow& row) {
  ++summary_.trials;
  summary_.xruns += row.presented.xruns;
  switch (row.outcome) {
    case core::Outcome::answered:
      ++summary_.answered;
      break;
    case core::Outcome::timeout:
      ++summary_.timeouts;
      break;
    case core::Outcome::anticipation:
      ++summary_.anticipations;
      break;
    case core::Outcome::aborted:
    case core::Outcome::fault:
      ++summary_.voided;
      break;
  }
  scores_.add(trial::block_start(*director_.block(), spec.block_index, spec.attempt), row);
  if (spec.type == core::TrialType::experimental && row.given.correct)
    ++scored_, right_ += *row.given.correct ? 1 : 0;
}

// The part of SessionRun that runs adjustments, in which the surface follows a slider.

void SessionRun::show_phase(trial::Phase phase, const Running& trial) {
  auto page = pages_.of_phase(phase, trial.machine.interval(), trial.spec, *director_.block(),
                              trial.machine.result(), director_);
  const bool adjusting = phase == trial::Phase::stimulus || phase == trial::Phase::response;
  // A tone or a buzz is the signal itself: a band on the screen would come a few frames of the screen later,
  // as a second one.
  const auto& signal = setup_.protocol.timing.signal;
  page.answer_now = adjusting && trial.machine.signalled() && signal && !protocol::in_stimulus(*signal);
  if (page.answer_now && signal->by == protocol::ResponseSignal::By::flash)
    page.flash_ns = *trial.machine.result().zero_ns + std::llround(1e9 * *trial.spec.signal_s);
  const bool before_last = phase == trial::Phase::stimulus && !trial.is_set();
  if (trial.slider && adjusting && !before_last)
    pages_.add_slider(page, *trial.spec.slider, trial.slider->setting(),
                      trial.slider->setting() != trial.spec.level.value_or(trial.spec.slider->low));
  if (phase == trial::Phase::late && trial.machine.result().outcome == core::Outcome::fault)
    page.text = pages_.movement(trial.row.finger.sensing);
  const bool judged = phase == trial::Phase::feedback || phase == trial::Phase::late;
  if (judged && director_.block() != nullptr && director_.block()->feedback == protocol::Feedback::trial)
    if (const auto points = trial::points_of(trial.machine.result(), trial.spec, setup_.protocol))
      pages_.add_points(
          page, *points,
          director_.block()->practice ? std::nullopt : std::optional(scores_.points() + *points));
  page.again =
      (phase == trial::Phase::stimulus || phase == trial::Phase::response) && trial.machine.may_ask_again();
  if (trial.spec.strokes && phase == trial::Phase::feedback)
    page.text = pages_.movement(trial.row.finger.sensing);
  hold_bars(phase, trial);
  page.guidance = guide_.bars();
  gate_.show(page);
}

std::optional<trial::Event> SessionRun::event_in_trial(const Input& input, Running& trial, bool by_button) {
  const trial::Event touch{input.time_ns, trial::EventKind::touch, 0};
  const bool confiding = trial.machine.phase() == trial::Phase::confidence;
  const auto& answer = protocol::of_task(setup_.protocol, trial.spec.task).task.value;
  if (const auto* given = input.as<input::Value>()) {
    const auto value = answer ? protocol::accepted(*answer, given->number) : std::nullopt;
    if (!value || confiding) return touch;
    if (!trial.machine.result().response) trial.value = value;
    return trial::Event{input.time_ns, trial::EventKind::answer, 0};
  }
  // If a number is expected, a button or a touch beside the number pad is no answer. A button cannot give a
  // confidence rating either.
  if (input.is<input::Answer>() && (confiding ? by_button : answer.has_value())) return touch;
  if (trial.spec.strokes) {
    const auto event = event_of(input);
    return event && event->kind == trial::EventKind::answer ? touch : event;
  }
  if (!trial.slider) return event_of(input);
  // Ignore slider movements in silence: the participant could not feel their effect.
  const auto* slider = input.as<input::Slider>();
  if (slider && trial.is_set()) trial.slider->move(slider->value);
  if (input.is<input::Next>()) return trial::Event{input.time_ns, trial::EventKind::answer, 0};
  return event_of(input);
}

/// Makes the surface follow the slider. The trial's row contains the starting scene, and the last scene with
/// its onset. All movements in between are in the log of events.
void SessionRun::glide(Running& trial) {
  const double wanted = trial.slider->glide(stage_->now_ns());
  if (!trial.is_set()) return;
  auto spec = trial.spec;
  spec.factors[protocol::of_task(setup_.protocol, spec.task).task.adjusts] = wanted;
  plans_.begin(spec);
  stage_->wait_for([&] { return plans_.ready(spec); });
  const auto plan = plans_.take(spec).plans.back().back();
  account_.check(plan.peak_displacement_m, trial::parts_of(setup_.protocol, spec).back().length_s);
  const auto at_frame = stage_->glide(tones_of(plan), trial::kGlide_s);
  if (!at_frame) return;
  trial.slider->followed();
  set_scene(trial.row, plan, static_cast<int>(trial.begun) - 1, *at_frame);
  if (monitor_ != nullptr) monitor_->surface_follows(spec, plan);
}

// The part of SessionRun for blocks in which the finger strokes the surface and nothing is asked.

namespace {

std::string in_words(const sensing::FrictionTable& table, bool used) {
  std::string text = used ? "used" : "not used";
  if (table.half_displacement_m)
    text += fmt::format("; half friction at {:.3f} um (SE {:.3f})", 1e6 * *table.half_displacement_m,
                        1e6 * table.half_displacement_sd_m);
  if (table.unused > 0) text += fmt::format("; {} trials do not count", table.unused);
  return text;
}

}  // namespace

bool SessionRun::is_training() const { return director_.block()->kind == protocol::BlockKind::training; }

/// Ends a trial in which nothing is asked, once it is known how the finger moved. The trial is void if the
/// forces are unknown.
void SessionRun::judge_strokes(const sensing::TrialForces& forces, const Input& input, Running& trial) {
  const bool known = forces.state == sensing::ForcesState::ok;
  const int movement = forces.movement == sensing::Movement::ok ? 0 : 1;
  if (known) trial.row.timing.response_time_quality = name(input.quality);
  perform(trial.machine.handle({input.time_ns, known ? trial::EventKind::answer : trial::EventKind::refuted,
                                known ? movement : 0}),
          trial);
}

/// Computes the friction table from the trials of a block. Throws core::UsageError if a level has too few
/// valid trials.
sensing::FrictionTable SessionRun::measured_friction(int block_index) const {
  std::vector<sensing::TableStroke> strokes;
  for (const auto& stroke : director_.strokes(block_index))
    strokes.push_back(
        {1e-6 * stroke.displacement_um, stroke.friction.value_or(std::numeric_limits<double>::quiet_NaN())});
  return sensing::friction_table(strokes, summary_.seed);
}

/// Computes and stores the friction table of the block that has just ended.
Flow SessionRun::finish_friction_table() {
  const auto& block = *director_.block();
  sensing::FrictionTable table;
  try {
    table = measured_friction(director_.block_index());
  } catch (const core::UsageError& error) {
    gate_.stop(fmt::format("block \"{}\": {}; \"turnpoint resume --policy block\" repeats the block",
                           block.name, error.what()));
    return Flow::stop;
  }
  core::EventRow event{stage_->now_ns(), "friction_table", in_words(table, block.strokes.used), std::nullopt};
  for (const auto& level : table.levels)
    event.friction_levels.push_back({1e6 * level.displacement_m, level.strokes, level.measured,
                                     level.relative_friction, level.sd, level.interval.low,
                                     level.interval.high});
  gate_.keep([&] { log_.event(event); });
  if (table.half_displacement_m)
    summary_.estimates.push_back({block.name, "half friction at (um)", 1e6 * *table.half_displacement_m,
                                  1e6 * table.half_displacement_sd_m, ""});
  if (block.strokes.used) plans_.use_friction(table);
  return Flow::go_on;
}

/// In a resumed session, plans trials with the newest friction table of an earlier block, as the session did
/// before it was interrupted.
void SessionRun::use_measured_friction() {
  for (int i = director_.block_index() - 1; i >= 0; --i) {
    const auto& block = director_.all_blocks()[static_cast<std::size_t>(i)];
    if (block.kind != protocol::BlockKind::friction_table || !block.strokes.used) continue;
    return plans_.use_friction(measured_friction(i));
  }
}

// The part of SessionRun that moves the bars which guide the finger, and tells the operator of the finger.

bool SessionRun::is_finger_watched() const {
  return monitor_ != nullptr && monitor_->watches_finger() && rig::has_force_cells(setup_.rig);
}

/// Moves the bars if Guide::kEvery_ns has passed since they were last moved.
void SessionRun::move_bars() {
  const bool watched = is_finger_watched();
  if ((!guide_.guides() && !watched) || stage_->now_ns() < guide_due_ns_) return;
  guide_due_ns_ = stage_->now_ns() + Guide::kEvery_ns;
  auto* watch = stage_->watch();
  const auto finger = watch ? watch->finger_now() : std::nullopt;
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
  const auto& bursts = plans_.take(trial.shown).bursts;
  const auto parts = trial::parts_of(setup_.protocol, trial.spec);
  for (std::size_t i = 0; i < bursts.size(); ++i) {
    add(TriggerEvent::onset, trial.onsets[i], 0);
    for (std::size_t c = 0; c < parts[i].changes; ++c)
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
  log_.event({now, "notice", "no more trigger codes on lines: " + done.failure, {}});
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

namespace {

/// Returns the names of the failed checks, with what they found.
std::string failures(const std::vector<CheckRow>& checks) {
  std::string text;
  for (const auto& check : checks)
    if (check.verdict == Verdict::failed) text += (text.empty() ? "" : "; ") + check.name + ": " + check.what;
  return text;
}

}  // namespace

/// Runs the self-test, if the session has one, and stores it. If a check failed, the session continues only
/// with the operator's reason, which is stored too.
Flow SessionRun::pass_self_test() {
  if (!setup_.self_test) return Flow::go_on;
  SelfTestParts parts;
  parts.rig = &setup_.rig;
  parts.stage = stage_.get();
  parts.amplifier = stage_->guarded_amplifier();
  parts.capture = stage_->capture();
  const auto card = card_capture_of(setup_.rig);
  if (card && parts.amplifier != nullptr) parts.capture = card->setup;
  if (parts.capture) parts.room = stage_.get();
  parts.data_folder = std::filesystem::absolute(setup_.database).parent_path().string();
  parts.other = [this](Input input) { gate_.note(gate_.received(std::move(input))); };
  core::EventRow event{stage_->now_ns(), "self_test", "passed", std::nullopt};
  const auto checks = self_test(*self_test_rig(std::move(parts)));
  for (const auto& check : checks) event.checks.push_back(row_of(check));
  if (passed(checks)) {
    log_.event(std::move(event));
    return gate_.stop_asked() ? Flow::stop : Flow::go_on;
  }
  const auto what = failures(event.checks);
  const auto mixer = row_of(judged(read_mixer(setup_.rig))).name;
  for (const auto& check : event.checks)
    if (check.name == mixer && check.verdict == Verdict::failed) known_mixer_ = check.what;
  const auto reason = reason_despite("the self-test failed: ", what);
  event.value = reason.empty() ? "failed" : "failed; continued: " + reason;
  log_.event(std::move(event));
  return gate_.stop_asked() ? Flow::stop : Flow::go_on;
}

/// Returns the operator's reason for going on although a check failed. Without one, the session is stopped;
/// `stopped_by` begins its reason.
std::string SessionRun::reason_despite(const std::string& stopped_by, const std::string& failed) {
  auto reason = setup_.despite;
  if (reason.empty() && !gate_.stop_asked())
    reason = gate_.reason_to_continue({FaultKind::self_test, failed});
  if (reason.empty() && !gate_.stop_asked()) gate_.stop(stopped_by + failed);
  return reason;
}

/// Compares the mixer's levels with those of the calibration once more. Another program may change them after
/// the self-test, and without pick-ups nothing else shows it.
Flow SessionRun::pass_mixer() {
  const auto check = row_of(judged(read_mixer(setup_.rig)));
  if (check.verdict != Verdict::failed) known_mixer_.clear();
  if (check.verdict != Verdict::failed || check.what == known_mixer_) return Flow::go_on;
  known_mixer_ = check.what;
  const auto reason = reason_despite("", check.name + ": " + check.what);
  const auto answer = reason.empty() ? "" : "; continued: " + reason;
  gate_.keep([&] { log_.event({stage_->now_ns(), "mixer", check.what + answer, {}}); });
  return gate_.stop_asked() ? Flow::stop : Flow::go_on;
}

namespace {

// Time between pressing the example's button and the stimulus: the participant needs it to move the finger to
// the surface.
constexpr std::int64_t kToSurface_ns = 800'000'000;

}  // namespace

/// Presents an example of an explanation, under the same limits and with the same amplifier guard as a trial.
/// An example that is interrupted is not repeated: the participant can press its button again.
Flow SessionRun::play_example(const protocol::Example& example, Page page) {
  trial::TrialSpec spec;
  spec.block_index = director_.block_index();
  spec.trial_in_block = -++examples_;
  spec.factors = example.with;
  spec.intervals = {{example.scene}};
  spec.rove_dB = {0};
  spec.length_s = example.duration_s;
  if (prepare_trial(spec) == Flow::stop) return Flow::stop;
  if (open_amplifier()) return gate_.recover();
  gate_.show(page);
  const auto onsets = stage_->present(plans_.take(spec).bursts, stage_->now_ns() + kToSurface_ns);
  if (!onsets.empty()) {
    const auto on_ns = onsets.front().time_ns;
    auto off_ns = on_ns + static_cast<std::int64_t>(1e9 * example.duration_s);
    while (stage_->now_ns() < off_ns) {
      auto waited = stage_->wait_until(off_ns);
      if (!waited) continue;
      const auto input = gate_.received(std::move(*waited));
      gate_.note(input);
      if (gate_.stop_asked() || gate_.fault() || input.is<input::Pause>()) {
        off_ns = std::min(off_ns, stage_->silence(false));
        break;
      }
    }
    if (off_ns > on_ns) account_.add(on_ns, off_ns);
  }
  stage_->close_amplifier();
  if (gate_.stop_asked()) return Flow::stop;
  if (gate_.fault() && gate_.recover() == Flow::stop) return Flow::stop;
  return gate_.pause_if_asked();
}

// The part of SessionRun for procedures and observers that are separate programs.

/// Returns the next trial, after waiting for the program that chooses its level. If the program fails, the
/// session pauses: the page of the fault stands until the operator has pressed Continue, which starts the
/// program again. Nobody could do that in a simulated session, so it is interrupted. Returns nothing if the
/// block is done or the session is to stop. A pause or a fault page since the last call counts as a rest.
std::optional<trial::TrialSpec> SessionRun::next_trial() {
  while (!gate_.stop_asked()) {
    if (std::exchange(holds_, gate_.holds()) != gate_.holds()) director_.rested();
    stage_->wait_for([this] { return director_.ready(); });
    try {
      if (const auto failed = std::exchange(failed_program_, std::nullopt))
        throw core::ProgramFailed(*failed);
      auto spec = director_.next();
      log_programs();
      return spec;
    } catch (const core::ProgramFailed& failed) {
      log_.event(
          {stage_->now_ns(), "fault", fmt::format("{}: {}", name(FaultKind::program), failed.what()), {}});
      log_programs();
      if (!setup_.observer.empty()) {
        gate_.stop(failed.what());
        continue;
      }
      gate_.set_fault(Fault{FaultKind::program, failed.what()});
      static_cast<void>(gate_.recover());  // the loop ends if somebody stops the session instead
    }
  }
  return std::nullopt;
}

/// Starts to plan the next trial, unless the program that chooses its level has not replied yet.
void SessionRun::plan_ahead() {
  if (failed_program_ || !director_.ready()) return;
  try {
    if (const auto next = director_.next()) plans_.begin(*next);
  } catch (const core::ProgramFailed& failed) {
    failed_program_ = failed.what();
  }
}

/// Stores which programs were started.
void SessionRun::log_programs() {
  if (programs_ == nullptr) return;
  auto started = programs_->take_started();
  if (started.empty()) return;
  core::EventRow event{stage_->now_ns(), core::kProgramEvent, started.front().program, {}};
  event.programs = std::move(started);
  log_.event(std::move(event));
}

/// Stores what the programs of the block have estimated.
void SessionRun::log_estimates() {
  core::EventRow event{stage_->now_ns(), core::kEstimatesEvent, director_.block()->name, {}};
  for (const auto& found : director_.estimates())
    if (protocol::is_program(setup_.protocol, found.procedure))
      event.estimates.push_back({director_.block_index(), director_.attempt(), found.procedure,
                                 found.parameter, found.mean, found.sd, found.basis});
  if (!event.estimates.empty()) log_.event(std::move(event));
}

namespace {

/// Returns the captured frames as a signal, without the time of its first point. Takes up to seconds.
core::SignalRow raw_signal(const sensing::RawCapture& raw) {
  core::SignalRow signal;
  signal.stream = core::kRawStream;
  signal.start_frame = raw.first_frame;
  signal.rate_Hz = raw.rate_Hz;
  for (int c = 0; c < raw.channels; ++c) signal.channels.push_back({"channel_" + std::to_string(c), "", 1});
  store::encode(signal, std::span(raw.samples));
  return signal;
}

}  // namespace

/// Adds what was captured last, on all channels, to the row of a void trial. Compressing and storing it takes
/// a while. Until it is compressed and the amplifier is off, the stage attends to its devices.
void SessionRun::keep_raw(Running& trial) {
  const auto* watch = stage_->watch();
  if (!trial.is_void() || trial.onsets.empty() || !watch) return;
  auto raw = watch->raw();
  if (raw.samples.empty()) return;
  auto packed = std::async(std::launch::async, [raw = std::move(raw)] { return raw_signal(raw); });
  stage_->wait_for([&] {
    return packed.wait_for(std::chrono::seconds(0)) == std::future_status::ready &&
           stage_->amplifier() != audio::AmplifierState::enabled;
  });
  auto signal = packed.get();
  const auto& onset = trial.onsets.front();
  signal.start_s = 1e-9 * static_cast<double>(onset.time_ns - started_ns_) +
                   static_cast<double>(signal.start_frame - onset.frame) / setup_.rig.output.rate_Hz;
  trial.row.signal_rows.push_back(std::move(signal));
}

}  // namespace turnpoint::session

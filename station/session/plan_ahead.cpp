#include "station/session/plan_ahead.hpp"

#include <cmath>
#include <utility>

#include "station/core/draws.hpp"
#include "station/protocol/resolve.hpp"
#include "station/protocol/tasks.hpp"
#include "station/protocol/triggers.hpp"
#include "station/scene/measures.hpp"
#include "station/scene/scaled.hpp"
#include "station/session/burst.hpp"
#include "station/session/stage.hpp"
#include "station/trial/timing.hpp"

namespace turnpoint::session {

PlanAhead::PlanAhead(const rig::Rig& rig, const protocol::Protocol& protocol, std::uint64_t seed)
    : rig_(rig), protocol_(protocol), seed_(seed), planner_(rig) {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

PlanAhead::~PlanAhead() = default;

void PlanAhead::use_friction(const sensing::FrictionTable& table) {
  std::unique_lock lock(mutex_);
  waiting_ = false;
  changed_.wait(lock, [this] { return !planning_; });
  rig_.friction.measured = true;
  rig_.friction.table.clear();
  for (const auto& point : table.points())
    rig_.friction.table.emplace_back(point.displacement_m, point.relative_friction);
  planner_ = scene::Planner(rig_);
  wanted_.reset(), done_for_.reset();
}

void PlanAhead::set_drift(double share) {
  const std::lock_guard lock(mutex_);
  drift_ = share;
}

void PlanAhead::begin(const trial::TrialSpec& trial) {
  const std::lock_guard lock(mutex_);
  if (wanted_ == Request{trial, drift_}) return;
  wanted_ = Request{trial, drift_};
  waiting_ = true;
  changed_.notify_all();
}

bool PlanAhead::ready(const trial::TrialSpec& trial) {
  const std::lock_guard lock(mutex_);
  return done_for_ == Request{trial, drift_};
}

const PlanAhead::Planned& PlanAhead::take(const trial::TrialSpec& trial) {
  begin(trial);
  std::unique_lock lock(mutex_);
  const Request request{trial, drift_};
  changed_.wait(lock, [&] { return done_for_ == request; });
  if (failed_) std::rethrow_exception(failed_);
  return done_;
}

void PlanAhead::run(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return waiting_; })) {
    const Request request = *wanted_;
    waiting_ = false;
    planning_ = true;
    lock.unlock();
    Planned planned;
    std::exception_ptr failed;
    try {
      planned = plan(request.trial, request.drift);
    } catch (...) {
      failed = std::current_exception();
    }
    lock.lock();
    done_ = std::move(planned);
    failed_ = failed;
    done_for_ = request;
    planning_ = false;
    changed_.notify_all();
  }
}

PlanAhead::Planned PlanAhead::plan(const trial::TrialSpec& trial, double drift) {
  Planned planned;
  if (trial.strokes) {
    planned.plans = {{plan_strokes(trial)}};
    for (auto& tone : planned.plans.front().front().tones) tone.frequency_Hz *= 1 + drift;
    planned.bursts = bursts_of(trial, planned.plans);
    return planned;
  }
  const auto parts = trial::parts_of(protocol_, trial);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    auto& scenes = planned.plans.emplace_back();
    const auto of_the_task = parts[i].changes + 1;
    for (const auto& name : parts[i].scenes) {
      // A buzz, which follows the task's scenes, is the same in all trials: compared with it, a strength that
      // was roved could be recognised.
      const bool is_buzz = parts[i].scenes.size() > of_the_task && scenes.size() == of_the_task;
      const double rove_dB = is_buzz ? 0 : trial.rove_dB[i];
      scenes.push_back(planner_.plan(protocol::resolve(protocol_, name, trial.factors, rove_dB)));
    }
    for (auto& made : scenes) {
      planner_.add_level_uncertainty(made);
      for (auto& tone : made.tones) tone.frequency_Hz *= 1 + drift;
    }
  }
  planned.bursts = bursts_of(trial, planned.plans);
  return planned;
}

/// Plans a trial of a friction table, whose level is the displacement of the surface.
scene::DrivePlan PlanAhead::plan_strokes(const trial::TrialSpec& trial) {
  const auto& strokes = *trial.strokes;
  if (*trial.level == 0) {
    scene::DrivePlan rest;
    rest.scene.name = strokes.scene;
    return rest;
  }
  const auto plan = planner_.plan(protocol::resolve(protocol_, strokes.scene, {}, 0));
  const double reference_m =
      scene::mean_displacement_m(planner_, plan, {1e-3 * strokes.from_mm, 1e-3 * strokes.to_mm});
  auto made = scene::scaled(planner_, plan, 1e-6 * *trial.level / reference_m);
  planner_.add_level_uncertainty(made);
  scene::refuse_beyond_limits(rig_, made);
  return made;
}

std::vector<audio::PreparedBurst> PlanAhead::bursts_of(const trial::TrialSpec& trial,
                                                       const Plans& plans) const {
  const auto stream = stream_of(rig_);
  const int rate_Hz = stream.output.rate_Hz;
  const auto parts = trial::parts_of(protocol_, trial);
  const auto& task = protocol::of_task(protocol_, trial.task).task;
  core::Draws noise(
      {seed_, core::Stream::masking_noise, trial.block_index, trial.attempt, trial.trial_in_block});
  MarkerCodes codes{protocol::trigger_code(protocol_, protocol::TriggerEvent::onset, trial.factors),
                    protocol::trigger_code(protocol_, protocol::TriggerEvent::change, trial.factors)};
  std::vector<audio::PreparedBurst> bursts;
  std::int64_t start_frame = 0;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const auto& part = parts[i];
    auto burst = burst_of(plans[i], part.starts_s, part.transitions_s, part.length_s, rate_Hz);
    codes.changes = part.changes;
    if (rig_.marker) mark(burst, *rig_.marker, rate_Hz, codes);
    if (rig_.noise && task.sound == protocol::Sound::masking_noise) mask(burst, *rig_.noise, noise.bits());
    const auto& response = protocol_.timing.signal;
    const bool tone = response && response->by == protocol::ResponseSignal::By::tone;
    if (const auto at_s = trial::signal_in_stimulus_s(protocol_, trial);
        at_s && tone && rig_.noise && rig_.noise->signal && i + 1 == plans.size())
      signal(burst, *rig_.noise, *at_s, rate_Hz);
    burst.start_frame = start_frame += std::llround(part.silence_s * rate_Hz);
    start_frame += burst.length_frames;
    bursts.push_back(audio::prepare(burst, audio::format_of(stream.output), stream.limits));
  }
  return bursts;
}

}  // namespace turnpoint::session

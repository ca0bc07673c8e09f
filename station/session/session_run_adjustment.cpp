#include <cmath>

#include "station/protocol/answers.hpp"
#include "station/session/burst.hpp"
#include "station/session/rows.hpp"
#include "station/session/session_run.hpp"
#include "station/trial/timing.hpp"

namespace turnpoint::session {

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
  if (trial.slider && adjusting) pages_.add_slider(page, *trial.spec.slider, trial.slider->setting());
  if (phase == trial::Phase::late && trial.machine.result().outcome == terms::Outcome::fault)
    page.text = pages_.movement(trial.row.finger.sensing);
  if (trial.spec.strokes && phase == trial::Phase::feedback)
    page.text = pages_.movement(trial.row.finger.sensing);
  hold_bars(phase, trial);
  page.guidance = guide_.bars();
  gate_.show(page);
}

std::optional<trial::Event> SessionRun::event_in_trial(const Input& input, Running& trial, bool by_button) {
  const trial::Event touch{input.time_ns, trial::EventKind::touch, 0};
  const bool confiding = trial.machine.phase() == trial::Phase::confidence;
  const auto& answer = setup_.protocol.task.value;
  if (input.kind == InputKind::value) {
    const auto value = answer ? protocol::accepted(*answer, input.number) : std::nullopt;
    if (!value || confiding) return touch;
    if (!trial.machine.result().response) trial.value = value;
    return trial::Event{input.time_ns, trial::EventKind::answer, 0};
  }
  // If a number is expected, a button or a touch beside the number pad is no answer. A button cannot give a
  // confidence rating either.
  if (input.kind == InputKind::answer && (confiding ? by_button : answer.has_value())) return touch;
  if (trial.spec.strokes) {
    const auto event = event_of(input);
    return event && event->kind == trial::EventKind::answer ? touch : event;
  }
  if (!trial.slider) return event_of(input);
  // Ignore slider movements in silence: the participant could not feel their effect.
  if (input.kind == InputKind::slider && trial.machine.phase() == trial::Phase::stimulus)
    trial.slider->move(input.number);
  if (input.kind == InputKind::next) return trial::Event{input.time_ns, trial::EventKind::answer, 0};
  return event_of(input);
}

/// Makes the surface follow the slider. The trial's row contains the starting scene, and the last scene with
/// its onset. All movements in between are in the log of events.
void SessionRun::glide(Running& trial) {
  const double wanted = trial.slider->glide(stage_->now_ns());
  if (trial.machine.phase() != trial::Phase::stimulus) return;
  auto spec = trial.spec;
  spec.factors[setup_.protocol.task.adjusts] = wanted;
  plans_.begin(spec);
  stage_->wait_for([&] { return plans_.ready(spec); });
  const auto plan = plans_.take(spec).plans.front().back();
  account_.check(plan.peak_displacement_m, trial::interval_times(setup_.protocol, spec).front().length_s);
  const auto at_frame = stage_->glide(tones_of(plan), trial::kGlide_s);
  if (!at_frame) return;
  trial.slider->followed();
  set_scene(trial.row, plan, *at_frame);
  if (monitor_ != nullptr) monitor_->surface_follows(spec, plan);
}

}  // namespace turnpoint::session

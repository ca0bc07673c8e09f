#include "station/trial/timing.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "station/core/limits.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/tasks.hpp"

namespace turnpoint::trial {

namespace {

std::int64_t ns(double s) { return std::llround(s * 1e9); }

/// Rounds down, as simulated sessions always did.
std::int64_t whole_ns(double s) { return static_cast<std::int64_t>(s * 1e9); }

/// The parts that the task names; a buzz, if there is one, is not among them.
std::vector<Part> task_parts(const protocol::Protocol& protocol, const TrialSpec& spec) {
  const auto& task = protocol::of_task(protocol, spec.task).task;
  const auto value = [&](const protocol::Linear& time_s) { return protocol::evaluate(time_s, spec.factors); };
  std::vector<Part> parts;
  bool fresh = spec.fresh;  // only one part of a trial is longer
  // An example of an explanation, whose length the spec states, is a single scene.
  const auto before = spec.length_s ? 0 : task.before.size();
  std::vector<std::vector<protocol::Part>> intervals;
  if (spec.length_s)
    intervals.push_back(protocol::parts_of(task, spec.intervals.front()));
  else
    intervals = protocol::parts_of_trial(task, spec.intervals);
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    double silence_s = i > 0 && task.gap_s ? value(*task.gap_s) : 0;
    for (const auto& from : intervals[i]) {
      Part part;
      part.interval = parts.size() < before ? kBeforeIntervals : static_cast<int>(i);
      for (const auto& silence : from.silences_s) silence_s += value(silence);
      part.silence_s = std::exchange(silence_s, 0);
      // A part that is explored lasts until the answer, but at most explore_s or, if that is not set, until
      // the deadline.
      const auto* length = protocol::length_of(task, from);
      const double whole = spec.length_s ? *spec.length_s
                           : length      ? value(*length)
                                    : protocol.timing.explore_s.value_or(spec.foreperiod_s + spec.deadline_s);
      const bool is_long = fresh && from.first_s.has_value();
      part.length_s = is_long ? *from.first_s : whole;
      fresh = fresh && !is_long;
      part.scenes = from.scenes;
      part.changes = part.scenes.size() - 1;
      const double even = whole / static_cast<double>(part.scenes.size());
      const double step = task.foreperiod_s ? spec.foreperiod_s : even;
      for (std::size_t s = 1; s < part.scenes.size(); ++s) {
        part.starts_s.push_back(step * static_cast<double>(s));
        part.transitions_s.push_back(task.transition_ms.value_or(50) * 1e-3);
      }
      parts.push_back(std::move(part));
    }
  }
  return parts;
}

/// The response signal of this trial if it is a buzz of the surface; otherwise null.
const protocol::ResponseSignal* buzz_of(const protocol::Protocol& protocol, const TrialSpec& spec) {
  const auto& signal = protocol.timing.signal;
  return spec.signal_s && signal && signal->by == protocol::ResponseSignal::By::buzz ? &*signal : nullptr;
}

}  // namespace

std::vector<Part> parts_of(const protocol::Protocol& protocol, const TrialSpec& spec) {
  if (spec.strokes) return {{0, 0, spec.strokes->duration_s, spec.intervals.front(), {}, {}, 0}};
  auto parts = task_parts(protocol, spec);
  if (const auto* buzz = buzz_of(protocol, spec)) {
    const double at_s = *signal_in_stimulus_s(protocol, spec);
    auto& last = parts.back();
    last.starts_s.insert(last.starts_s.end(), {at_s, at_s + buzz->length_s});
    last.transitions_s.insert(last.transitions_s.end(), 2, core::kBuzzRamp_s);
    last.scenes.insert(last.scenes.end(), {buzz->scene, std::string(last.scenes.back())});
  }
  return parts;
}

std::optional<double> signal_in_stimulus_s(const protocol::Protocol& protocol, const TrialSpec& spec) {
  const auto& signal = protocol.timing.signal;
  if (!spec.signal_s || !signal || !protocol::in_stimulus(*signal)) return std::nullopt;
  const bool at_change = zero_of(protocol, spec) == core::ResponseZero::change;
  return *spec.signal_s + (at_change ? task_parts(protocol, spec).back().starts_s.front() : 0);
}

core::ResponseZero zero_of(const protocol::Protocol& protocol, const TrialSpec& spec) {
  return spec.strokes ? core::ResponseZero::interval_off : protocol.timing.response_zero;
}

double cue_s(const protocol::Protocol& protocol, const TrialSpec& spec) {
  return spec.strokes ? protocol::kCue_s
                      : protocol::evaluate(protocol::of_task(protocol, spec.task).task.cue_s, spec.factors);
}

double reach_s(double length_s) { return std::min(0.2, 0.5 * length_s); }

SimulatedTimes simulated_times(const protocol::Protocol& protocol, const TrialSpec& spec, const Part& last,
                               std::int64_t onset_ns) {
  SimulatedTimes times{onset_ns, onset_ns, {}, {}, onset_ns};
  if (spec.strokes || !protocol::explored(protocol::of_task(protocol, spec.task).task))
    times.open_ns += whole_ns(last.length_s);
  if (last.changes > 0) times.slider_ns += whole_ns(last.starts_s[last.changes - 1]);
  switch (zero_of(protocol, spec)) {
    case core::ResponseZero::go_cue:
      break;
    case core::ResponseZero::change:
      times.zero_ns += whole_ns(last.starts_s.front());
      break;
    case core::ResponseZero::interval_off:
      times.zero_ns += whole_ns(last.length_s);
      break;
    case core::ResponseZero::first_contact:
      times.touch_ns = times.zero_ns += whole_ns(reach_s(last.length_s));
      times.slider_ns = std::max(times.slider_ns, times.zero_ns);
      break;
    case core::ResponseZero::lift_off:
      times.touch_ns = onset_ns + whole_ns(reach_s(last.length_s));
      times.lift_ns = times.zero_ns += whole_ns(last.length_s);
      break;
  }
  return times;
}

std::vector<Event> simulated_events(const SimulatedTimes& times, const simulation::Reply& reply,
                                    int presented_again) {
  std::vector<Event> events;
  if (times.touch_ns) events.push_back({*times.touch_ns, EventKind::contact, 1});
  if (!reply.choice) {
    if (times.lift_ns) events.push_back({*times.lift_ns, EventKind::contact, 0});
    return events;
  }
  auto at_ns = times.zero_ns + whole_ns(reply.response_time_s);
  if (reply.response_time_s >= 0) at_ns = std::max(at_ns, times.open_ns);
  auto lift_ns = times.lift_ns;
  if (times.touch_ns && !lift_ns && reply.travel_s > 0)
    lift_ns = std::max(*times.touch_ns, at_ns - whole_ns(reply.travel_s));
  if (lift_ns) events.push_back({*lift_ns, EventKind::contact, 0});
  const bool asks_again = presented_again < reply.again;
  if (asks_again)
    events.push_back({at_ns, EventKind::again, 0});
  else
    events.push_back({at_ns, EventKind::answer, *reply.choice});
  if (reply.confidence && !asks_again)
    events.push_back({at_ns + whole_ns(reply.confidence_time_s), EventKind::answer, *reply.confidence - 1});
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return a.time_ns < b.time_ns; });
  return events;
}

std::vector<Event> simulated_events(const SimulatedTimes& times, const TrialSpec& spec,
                                    const simulation::Setting& setting, int presented_again) {
  auto events = simulated_events(times, simulation::Reply{});
  if (presented_again < setting.again)
    events.push_back(
        {std::max(times.open_ns, times.slider_ns + whole_ns(setting.again_s)), EventKind::again, 0});
  else
    events.push_back({simulated_done_ns(times, spec, setting.done_s), EventKind::answer, 0});
  return events;
}

std::int64_t simulated_done_ns(const SimulatedTimes& times, const TrialSpec& spec, double done_s) {
  const double press_s = std::min(0.5, 0.5 * (spec.deadline_s - spec.anticipation_s));
  const auto done_ns = times.slider_ns + whole_ns(done_s);
  return done_ns >= times.zero_ns + whole_ns(spec.anticipation_s)
             ? done_ns
             : times.zero_ns + whole_ns(spec.anticipation_s + press_s);
}

Timing timing_of(const protocol::Protocol& protocol, const protocol::Block& block, const TrialSpec& spec,
                 const std::vector<Part>& parts) {
  Timing plan;
  const auto& task = protocol::of_task(protocol, spec.task).task;
  plan.cue_ns = ns(cue_s(protocol, spec));
  plan.watermark_ns = core::kWatermark_ns;
  for (const auto& part : parts) {
    IntervalTiming timed{ns(part.length_s), {}, ns(part.silence_s)};
    for (const double start : part.starts_s) timed.scene_starts_ns.push_back(ns(start));
    plan.intervals.push_back(std::move(timed));
  }
  plan.answer_ends_stimulus = !spec.strokes && protocol::explored(task);
  plan.response_zero = zero_of(protocol, spec);
  plan.deadline_ns = ns(spec.deadline_s);
  plan.anticipation_ns = ns(spec.anticipation_s);
  if (spec.signal_s) plan.signal_ns = ns(*spec.signal_s);
  plan.feedback_ns = block.feedback == protocol::Feedback::trial ? ns(protocol::kFeedback_s) : 0;
  plan.late_ns = ns(protocol::kLate_s);
  plan.iti_ns = ns(spec.iti_s);
  plan.correct = spec.correct;
  const auto delay_ns = [&](const protocol::Linear& delay_s) {
    return ns(protocol::evaluate(delay_s, spec.factors));
  };
  plan.wrong_delay_ns = delay_ns(protocol.timing.delay_s.wrong);
  plan.late_delay_ns = delay_ns(protocol.timing.delay_s.late);
  plan.early_delay_ns = delay_ns(protocol.timing.delay_s.early);
  if (spec.strokes) {
    plan.answers = 2;  // the two possible "answers": the movement was right or wrong
    if (block.kind == protocol::BlockKind::training) plan.feedback_ns = ns(protocol::kLate_s);
    return plan;
  }
  plan.answers = task.kind == protocol::TaskKind::adjustment ? 1 : protocol::answer_count(task);
  plan.unsure = protocol::answer_index(task, protocol::kUnsure);
  plan.again = task.again;
  if (task.confidence) plan.confidence = static_cast<int>(task.confidence->labels.size());
  return plan;
}

}  // namespace turnpoint::trial

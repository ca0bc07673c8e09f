#include "station/trial/timing.hpp"

#include <cmath>

#include "station/protocol/answers.hpp"
#include "station/terms/limits.hpp"

namespace turnpoint::trial {

namespace {

std::int64_t ns(double s) { return std::llround(s * 1e9); }

/// The times of the scenes that the task names; a buzz, if there is one, is not among them.
std::vector<IntervalTimes> task_times(const protocol::Protocol& protocol, const TrialSpec& spec) {
  const auto& task = protocol.task;
  std::vector<IntervalTimes> times;
  for (const auto& scenes : spec.intervals) {
    IntervalTimes interval;
    // An explored interval lasts until the answer, but at most explore_s or, if that is not set, until the
    // deadline.
    const double whole = protocol::explored(task)
                             ? protocol.timing.explore_s.value_or(spec.foreperiod_s + spec.deadline_s)
                             : task.duration_s.value_or(0);
    interval.length_s = spec.length_s.value_or(whole);
    const double step =
        scenes.size() > 1 ? (task.foreperiod_s ? spec.foreperiod_s : whole / scenes.size()) : 0;
    for (std::size_t i = 1; i < scenes.size(); ++i) {
      interval.starts_s.push_back(step * static_cast<double>(i));
      interval.transitions_s.push_back(task.transition_ms.value_or(50) * 1e-3);
    }
    times.push_back(std::move(interval));
  }
  return times;
}

/// The response signal of this trial if it is a buzz of the surface; otherwise null.
const protocol::ResponseSignal* buzz_of(const protocol::Protocol& protocol, const TrialSpec& spec) {
  const auto& signal = protocol.timing.signal;
  return spec.signal_s && signal && signal->by == protocol::ResponseSignal::By::buzz ? &*signal : nullptr;
}

}  // namespace

std::vector<IntervalTimes> interval_times(const protocol::Protocol& protocol, const TrialSpec& spec) {
  if (spec.strokes) return {{spec.strokes->duration_s, {}, {}}};
  auto times = task_times(protocol, spec);
  if (const auto* buzz = buzz_of(protocol, spec)) {
    const double at_s = *signal_in_stimulus_s(protocol, spec);
    auto& last = times.back();
    last.starts_s.insert(last.starts_s.end(), {at_s, at_s + buzz->length_s});
    last.transitions_s.insert(last.transitions_s.end(), 2, terms::kBuzzRamp_s);
  }
  return times;
}

std::vector<std::vector<std::string>> presented_scenes(const protocol::Protocol& protocol,
                                                       const TrialSpec& spec) {
  auto scenes = spec.intervals;
  if (const auto* buzz = buzz_of(protocol, spec)) {
    auto& last = scenes.back();
    last.insert(last.end(), {buzz->scene, std::string(last.back())});
  }
  return scenes;
}

std::optional<double> signal_in_stimulus_s(const protocol::Protocol& protocol, const TrialSpec& spec) {
  const auto& signal = protocol.timing.signal;
  if (!spec.signal_s || !signal || !protocol::in_stimulus(*signal)) return std::nullopt;
  const bool at_change = zero_of(protocol, spec) == terms::ResponseZero::change;
  return *spec.signal_s + (at_change ? task_times(protocol, spec).back().starts_s.front() : 0);
}

terms::ResponseZero zero_of(const protocol::Protocol& protocol, const TrialSpec& spec) {
  return spec.strokes ? terms::ResponseZero::interval_off : protocol.timing.response_zero;
}

Timing timing_of(const protocol::Protocol& protocol, const protocol::Block& block, const TrialSpec& spec) {
  Timing plan;
  plan.cue_ns = ns(kCue_s);
  plan.watermark_ns = terms::kWatermark_ns;
  for (const auto& interval : interval_times(protocol, spec)) {
    IntervalTiming timed{ns(interval.length_s), {}};
    for (const double start : interval.starts_s) timed.scene_starts_ns.push_back(ns(start));
    plan.intervals.push_back(std::move(timed));
  }
  plan.gap_ns = ns(protocol.task.gap_s.value_or(0));
  plan.answer_ends_stimulus = !spec.strokes && protocol::explored(protocol.task);
  plan.response_zero = zero_of(protocol, spec);
  plan.deadline_ns = ns(spec.deadline_s);
  plan.anticipation_ns = ns(spec.anticipation_s);
  if (spec.signal_s) plan.signal_ns = ns(*spec.signal_s);
  plan.feedback_ns = block.feedback == protocol::Feedback::trial ? ns(kFeedback_s) : 0;
  plan.late_ns = ns(kLate_s);
  plan.iti_ns = ns(spec.iti_s);
  plan.answers = protocol.task.kind == protocol::TaskKind::adjustment
                     ? 1
                     : static_cast<int>(protocol.task.choices.size());
  plan.correct = spec.correct;
  if (spec.strokes) {
    plan.answers = 2;  // the two possible "answers": the movement was right or wrong
    if (block.kind == protocol::BlockKind::training) plan.feedback_ns = ns(kLate_s);
    return plan;
  }
  if (protocol.task.confidence) plan.confidence = static_cast<int>(protocol.task.confidence->labels.size());
  return plan;
}

}  // namespace turnpoint::trial

#include "station/view/trial_timeline.hpp"

#include <optional>

#include "station/core/trial.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/expression.hpp"

namespace turnpoint::view {

namespace {

std::size_t interval_count(const protocol::Task& task) {
  using Kind = protocol::TaskKind;
  switch (task.kind) {
    case Kind::two_interval:
    case Kind::same_different:
      return 2;
    case Kind::several_intervals:
      return task.choices.size();
    case Kind::comparison:
      return task.intervals.size();
    case Kind::oddity:
    case Kind::abx:
    case Kind::match_to_sample:
      return 3;
    default:
      return task.value && !task.standard.empty() ? 2 : 1;
  }
}

/// Returns the time from which an answer counts; empty if it depends on the participant.
std::optional<double> answer_from(const protocol::Protocol& protocol, double begin_s, double end_s) {
  using Zero = protocol::ResponseZero;
  const auto& foreperiod = protocol.task.foreperiod_s;
  switch (protocol.timing.response_zero) {
    case Zero::go_cue:
      return begin_s;
    case Zero::interval_off:
      return end_s;
    case Zero::change:
      return begin_s + (foreperiod ? (foreperiod->low + foreperiod->high) / 2 : 0);
    default:
      return std::nullopt;
  }
}

}  // namespace

std::vector<TrialPart> trial_timeline(const protocol::Protocol& protocol) {
  const auto& timing = protocol.timing;
  const auto& task = protocol.task;
  const auto middle = [&](const protocol::Linear& time_s) {
    const auto [low, high] = protocol::bounds(time_s, protocol.factors);
    return 0.5 * (low + high);
  };
  const double gap_s = task.gap_s ? middle(*task.gap_s) : 0;
  double now_s = (timing.iti_s.low + timing.iti_s.high) / 2, begin_s = now_s;
  std::vector<TrialPart> parts{{TrialPart::Kind::pause, 0, now_s}};
  const auto add = [&](TrialPart::Kind kind, double duration_s) {
    parts.push_back({kind, now_s, now_s + duration_s});
    now_s += duration_s;
  };
  const auto count = interval_count(task);
  std::vector<std::vector<std::string>> intervals;
  for (std::size_t i = 0; i < count; ++i)
    intervals.push_back(i < task.intervals.size() ? task.intervals[i]
                        : task.intervals.empty()
                            ? std::vector<std::string>{i + 1 < count ? task.standard : task.target}
                            : task.intervals.back());
  const auto lists = protocol::parts_of_trial(task, intervals);
  for (std::size_t i = 0; i < lists.size(); ++i) {
    if (i > 0 && gap_s > 0) add(TrialPart::Kind::gap, gap_s);
    for (const auto& part : lists[i]) {
      double silence_s = 0;
      for (const auto& silence : part.silences_s) silence_s += middle(silence);
      if (silence_s > 0) add(TrialPart::Kind::gap, silence_s);
      begin_s = now_s;
      const auto* length = protocol::length_of(task, part);
      add(TrialPart::Kind::interval, length ? middle(*length) : timing.explore_s.value_or(0));
    }
  }
  const auto from_s = answer_from(protocol, begin_s, now_s);
  if (from_s && timing.deadline_s && timing.deadline_s->is_constant())
    parts.push_back({TrialPart::Kind::answer, *from_s, *from_s + timing.deadline_s->constant});
  return parts;
}

}  // namespace turnpoint::view

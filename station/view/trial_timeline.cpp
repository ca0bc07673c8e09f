#include "station/view/trial_timeline.hpp"

#include <optional>

#include "station/core/trial.hpp"

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
  const double each_s = protocol.task.duration_s.value_or(timing.explore_s.value_or(0));
  const double gap_s = protocol.task.gap_s.value_or(0);
  double now_s = (timing.iti_s.low + timing.iti_s.high) / 2, begin_s = now_s;
  std::vector<TrialPart> parts{{TrialPart::Kind::pause, 0, now_s}};
  const auto add = [&](TrialPart::Kind kind, double duration_s) {
    parts.push_back({kind, now_s, now_s + duration_s});
    now_s += duration_s;
  };
  const auto count = interval_count(protocol.task);
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0 && gap_s > 0) add(TrialPart::Kind::gap, gap_s);
    begin_s = now_s;
    add(TrialPart::Kind::interval, each_s);
  }
  const auto from_s = answer_from(protocol, begin_s, now_s);
  if (from_s && timing.deadline_s && timing.deadline_s->is_constant())
    parts.push_back({TrialPart::Kind::answer, *from_s, *from_s + timing.deadline_s->constant});
  return parts;
}

}  // namespace turnpoint::view

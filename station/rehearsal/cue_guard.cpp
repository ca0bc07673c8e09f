#include "station/rehearsal/cue_guard.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <tuple>

#include "station/protocol/answers.hpp"
#include "station/rehearsal/cue_search.hpp"

namespace turnpoint::rehearsal {

namespace {

using protocol::Protocol;
using protocol::TaskKind;

constexpr double smallest_difference = 1e-3, smallest_difference_dB = 0.01;

std::pair<double, double> range_of(const std::vector<Look>& looks, std::size_t intervals) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto& look : looks)
    for (std::size_t i = 0; i < intervals; ++i)
      low = std::min(low, look.x[i]), high = std::max(high, look.x[i]);
  return {low, high};
}

CueReport report_on(CueObserver& observer, CueSearch& search, const Protocol& protocol, const CueKind& kind,
                    const Cells& all) {
  CueReport report;
  report.cue = kind.name, report.unit = kind.unit;
  const auto [low, high] =
      range_of(observer.looks(kind, Feature::last, all, Draws::to_choose), observer.asked().intervals);
  report.low = kind.scale * low, report.high = kind.scale * high;
  Grain grain{smallest_difference_dB, 0};
  if (!kind.in_dB())
    grain = {smallest_difference * std::max(std::fabs(low), std::fabs(high)), smallest_difference};
  const auto best = observer.best_strategy(kind, grain, all);
  if (kind.source == Source::duration)  // those of the part that tells most
    std::tie(report.low, report.high) =
        range_of(observer.looks(kind, best.feature, all, Draws::to_choose), observer.asked().intervals);
  const auto reached = observer.score(kind, best, all);
  report.chance = observer.chance(reached);
  report.accuracy = std::max(reached.accuracy(), report.chance);
  if (!needs_own_sessions(protocol)) return report;
  const bool is_searched = protocol.task.kind == TaskKind::single_interval && observer.asked().answers == 2;
  const auto found = is_searched ? search.best(kind, grain, all) : std::nullopt;
  report.whole_sessions = observer.by_itself(kind, found.value_or(best), all);
  if (const auto& own = *report.whole_sessions; own.gain() > report.accuracy - report.chance)
    report.accuracy = own.accuracy, report.chance = own.chance, report.error = own.error;
  return report;
}

CueReport report_on_keys(CueObserver& observer, const Protocol& protocol, const CueKind& kind,
                         const Cells& all) {
  Reached best{observer.guessing(), observer.guessing(), 0};
  for (int key = 0; key < static_cast<int>(observer.asked().answers); ++key)
    if (const auto reached = observer.by_key(kind, key, all); reached.accuracy > best.accuracy)
      best = reached;
  CueReport report;
  report.cue = kind.name;
  report.accuracy = best.accuracy, report.chance = best.chance, report.error = best.error;
  if (levels_follow_answers(protocol)) report.whole_sessions = best;
  return report;
}

void add_reports(CueObserver& observer, const Protocol& protocol, const Steps& steps, CueGuard& guard) {
  const auto all = observer.cells_of(census_of(protocol));
  std::size_t count = 0;
  for (const auto& [presentations, trials] : all) count += presentations->size();
  if (count == 0) return;
  observer.set_points(std::clamp(static_cast<int>(40'000 / (count + 1)), 16, 256));
  CueSearch search(observer);
  for (const auto& kind : cue_kinds) {
    if (steps.finish.stop_requested()) throw Finished();
    guard.reports.push_back(kind.source == Source::nothing
                                ? report_on_keys(observer, protocol, kind, all)
                                : report_on(observer, search, protocol, kind, all));
    if (steps.progress)
      steps.progress("cues compared", static_cast<int>(guard.reports.size()), std::size(cue_kinds));
  }
}

}  // namespace

namespace {

/// The cues of the protocol as one of its tasks sees it.
CueGuard guard_of_task(const Protocol& protocol, const rig::Rig& rig, const protocol::Survey& survey,
                       const std::stop_token& stop, const Steps& steps) {
  CueGuard guard;
  if (protocol.task.kind == TaskKind::adjustment) {
    guard.nothing_to_tell = "in an adjustment no setting is right or wrong";
    return guard;
  }
  if (protocol.task.kind == TaskKind::comparison) {
    guard.nothing_to_tell = "in a comparison no answer is right or wrong";
    return guard;
  }
  if (protocol::judges(protocol.task)) {
    guard.nothing_to_tell = "no rating and no number is right or wrong";
    return guard;
  }
  try {
    CueObserver observer(protocol, rig, survey, stop, steps);
    add_reports(observer, protocol, steps, guard);
    if (guard.reports.empty()) guard.nothing_to_tell = "no answer outside practice is right or wrong";
  } catch (const NotPlanned& missing) {
    guard.not_compared = missing.what();
    guard.reports.clear();
  } catch (const Finished&) {
    guard.stopped = true;
  }
  for (auto& report : guard.reports) report.task = protocol.task.name;
  return guard;
}

}  // namespace

CueGuard cue_guard(const Protocol& protocol, const rig::Rig& rig, const protocol::Survey& survey,
                   const std::stop_token& stop, const Steps& steps) {
  if (protocol.by_task.empty()) return guard_of_task(protocol, rig, survey, stop, steps);
  CueGuard all;
  for (std::size_t i = 0; i < protocol.by_task.size() && !all.stopped; ++i) {
    auto one = guard_of_task(protocol.by_task[i], rig, survey.by_task.at(i), stop, steps);
    std::move(one.reports.begin(), one.reports.end(), std::back_inserter(all.reports));
    const auto say = [&](const std::string& words, std::string& in) {
      if (!words.empty()) in += (in.empty() ? "" : "; ") + protocol.by_task[i].task.name + ": " + words;
    };
    say(one.nothing_to_tell, all.nothing_to_tell);
    say(one.not_compared, all.not_compared);
    all.stopped = one.stopped;
  }
  return all;
}

}  // namespace turnpoint::rehearsal

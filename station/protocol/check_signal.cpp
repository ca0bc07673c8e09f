#include <algorithm>
#include <optional>
#include <set>

#include "station/core/limits.hpp"
#include "station/core/number.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/combinations.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/reading.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

namespace {

using By = ResponseSignal::By;
using core::number;

/// True if the time of a signal within the stimulus is known before the stimulus begins. Otherwise reports
/// why it is not.
bool time_is_known(const Protocol& protocol, const core::Phrase& what, core::Findings& findings) {
  const auto& signal = *protocol.timing.signal;
  if (!explored(protocol.task)) {
    findings.add(signal.by_place,
                 phrase("%1 is part of the stimulus, but this task is answered after its intervals", {what}),
                 phrase("%1 or \"flash\", or a task with a single interval", {plain("by = \"screen\"")}));
    return false;
  }
  const auto zero = protocol.timing.response_zero;
  if (zero == ResponseZero::go_cue || zero == ResponseZero::change) return true;
  findings.add(signal.by_place,
               phrase("%1 is part of the stimulus, but \"response_zero\" is \"%2\", whose time is not known "
                      "when the stimulus begins",
                      {what, plain(name(zero))}),
               phrase("%1 or \"flash\", or a \"response_zero\" of \"go_cue\" or \"change\"",
                      {plain("by = \"screen\"")}));
  return false;
}

/// A buzz is the same in all trials. The search for cues does not look at it, so it must not depend on
/// anything that could tell the answer.
void check_same_buzz(const Reading& reading) {
  const auto& scenes = reading.protocol.scenes;
  // A zone is designed for the friction of its base scene, so the factors of the base scenes count, too.
  for (auto at = scenes.find(reading.protocol.timing.signal->scene); at != scenes.end();
       at = scenes.find(at->second.base))
    for (const auto& name : factors_of(at->second))
      return reading.findings.add(
          reading.places.of("timing.response_signal.scene"),
          phrase("the buzz depends on \"%1\", so it could tell something of the answer", {plain(name)}),
          phrase("a scene that is the same in all trials"));
}

/// A lag that depends on what makes an answer right would tell something of the answer.
void check_telling_lag(const Reading& reading) {
  std::set<std::string> deciding;
  for (const auto& [id, comparison] : reading.protocol.task.correct_answer)
    for (const auto* side : {&comparison.left, &comparison.right})
      for (const auto& name : factors_in(*side)) deciding.insert(name);
  for (const auto& name : factors_in(reading.protocol.timing.signal->after_s))
    if (deciding.count(name))
      return reading.findings.add(
          reading.places.of("timing.response_signal.after_s"),
          phrase("the time of the signal depends on \"%1\", which decides the right answer", {plain(name)}),
          phrase("other factors"));
}

/// The lags of the signal are the axis of the curve, which needs several of them in each condition.
void check_conditions(const Reading& reading) {
  const auto& by = reading.protocol.analysis.by;
  for (const auto& name : factors_in(reading.protocol.timing.signal->after_s))
    if (std::ranges::find(by, name) != by.end())
      return reading.findings.add(
          reading.places.of("analysis.by"),
          phrase(
              "the time of the signal depends on \"%1\", so each condition would have one lag and no curve",
              {plain(name)}),
          phrase("other factors; the report has all lags on one axis without it"));
}

/// A buzz takes the place of the last scene, which must have been reached, and be long enough before to be
/// measured.
void check_buzz(const Reading& reading) {
  check_same_buzz(reading);
  const auto& protocol = reading.protocol;
  const auto& task = protocol.task;
  const bool changes = !task.intervals.empty() && task.intervals.back().size() > 1;
  if (!changes) return;
  const auto& signal = *protocol.timing.signal;
  if (protocol.timing.response_zero != ResponseZero::change)
    return reading.findings.add(
        signal.by_place,
        phrase("a buzz that is timed from \"go_cue\" could meet the change to the second scene"),
        phrase("%1, or an interval of one scene", {plain("response_zero = \"change\"")}));
  const double first_s = bounds(signal.after_s, protocol.factors).first;
  const double changed_s = 1e-3 * task.transition_ms.value_or(0) + core::kBetweenChanges_s;
  if (first_s < changed_s)
    reading.findings.add(reading.places.of("timing.response_signal.after_s"),
                         phrase("the buzz can begin %1 s after the change begins, which takes %2 ms",
                                {plain(number(first_s)), plain(number(task.transition_ms.value_or(0)))}),
                         phrase("at least %1", {plain(number(changed_s) + " s")}));
}

/// All lags of a signal, if they are a list; empty if a factor varies over a range.
std::set<double> lags_of(const Linear& after_s, const std::vector<Factor>& factors) {
  std::vector<Factors> combinations{{}};
  for (const auto& name : factors_in(after_s)) {
    const auto* factor = find_factor(factors, name);
    if (factor == nullptr || !span(*factor) || factor->levels.empty()) return {};
    std::vector<Factors> next;
    for (const auto& level : factor->levels)
      for (auto combination : combinations) {
        combination[name] = level;
        next.push_back(std::move(combination));
      }
    combinations = std::move(next);
  }
  std::set<double> lags;
  for (const auto& combination : combinations) lags.insert(evaluate(after_s, combination));
  return lags;
}

/// A screen shows a flash with its next frame or the one after. A lag that is not longer than that, or that
/// differs from another one by less than a frame, is not the lag that people get.
void check_flash(const Reading& reading) {
  const auto& after_s = reading.protocol.timing.signal->after_s;
  const auto place = reading.places.of("timing.response_signal.after_s");
  const auto& factors = reading.protocol.factors;
  const double first_s = bounds(after_s, factors).first;
  if (first_s < core::kSignalLate_s - 1e-9)
    reading.findings.add(
        place,
        phrase("the flash can be due %1 s after \"%2\", but a screen may need three frames to show it",
               {plain(number(first_s)), plain(name(reading.protocol.timing.response_zero))}),
        phrase("at least %1 s, or %2", {plain(number(core::kSignalLate_s)), plain("by = \"tone\"")}));
  std::optional<double> before_s;
  for (const double lag_s : lags_of(after_s, factors)) {
    const double apart_s = lag_s - before_s.value_or(-1);
    if (apart_s > 1e-9 && apart_s < core::kFrame_s - 1e-9)
      return reading.findings.add(place,
                                  phrase("the lags %1 and %2 s differ by less than a frame of the screen, so "
                                         "a flash cannot present both",
                                         {plain(number(*before_s)), plain(number(lag_s))}),
                                  phrase("lags that differ by at least %1 s, or %2",
                                         {plain(number(core::kFrame_s, 3)), plain("by = \"tone\"")}));
    before_s = lag_s;
  }
}

}  // namespace

void check_signal(const Reading& reading) {
  const auto& protocol = reading.protocol;
  const auto& signal = protocol.timing.signal;
  if (!signal) return;
  check_telling_lag(reading);
  check_conditions(reading);
  if (signal->by == By::screen) return;
  if (signal->by == By::flash) return check_flash(reading);
  const bool tone = signal->by == By::tone;
  if (!time_is_known(protocol, tone ? phrase("a tone") : phrase("a buzz"), reading.findings)) return;
  if (!tone) check_buzz(reading);
  const auto end = stimulus_end(protocol);
  const double length_s = tone ? core::kSignal_s : signal->length_s + core::kBuzzRamp_s;
  const double latest_s = bounds(signal->after_s, protocol.factors).second + length_s;
  if (end && latest_s > end->earliest_s)
    reading.findings.add(
        reading.places.of("timing.response_signal.after_s"),
        tone ? phrase("the tone can end %1 s after \"%2\", but the stimulus can end %3 s after it",
                      {plain(number(latest_s)), plain(name(protocol.timing.response_zero)),
                       plain(number(end->earliest_s))})
             : phrase("the buzz can end %1 s after \"%2\", but the stimulus can end %3 s after it",
                      {plain(number(latest_s)), plain(name(protocol.timing.response_zero)),
                       plain(number(end->earliest_s))}),
        phrase("a longer \"explore_s\", or at most %1 s", {plain(number(end->earliest_s - length_s))}));
}

}  // namespace turnpoint::protocol

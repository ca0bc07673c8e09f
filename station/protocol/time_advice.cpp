#include <algorithm>
#include <optional>

#include "station/core/number.hpp"
#include "station/protocol/advice_list.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/tasks.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

namespace {

using core::number;

// No part of a trial takes minutes. A larger number was probably meant in milliseconds.
constexpr double longest_s = 120;

void check_length(AdviceList& advice, const std::string& key, double seconds) {
  if (seconds > longest_s)
    advice.add(key, phrase("%1 s are %2 minutes", {plain(number(seconds)), plain(number(seconds / 60, 3))}),
               phrase("times are in seconds: write 0.8 for 800 ms"));
}

// A person may think about what was felt, but nobody remembers it for longer than this. Typing a number takes
// longer, so it is not meant here.
constexpr double longest_after_s = 30;

/// Warns of a deadline that nobody can meet, because answers are accepted only when the intervals have ended,
/// and of one so long after the stimulus that it was probably meant otherwise.
void check_reach(AdviceList& advice, const std::string& key, const Linear& deadline) {
  const auto& protocol = advice.protocol;
  const std::string zero = name(protocol.timing.response_zero);
  const bool explores = explored(protocol.task);
  std::vector<const Linear*> lengths, times{&deadline};
  const auto last = last_parts(protocol.task);
  for (const auto& part : last)
    if (const auto* length = length_of(protocol.task, part)) lengths.push_back(length);
  times.insert(times.end(), lengths.begin(), lengths.end());
  if (const auto& foreperiod = protocol.task.foreperiod_s; foreperiod && foreperiod->expression)
    times.push_back(&*foreperiod->expression);
  // The deadline may depend on the factors that set the length, so both are compared at the same values. Of
  // all values, those count at which the deadline comes soonest after the end.
  std::optional<StimulusEnd> end;
  double shortest = 0, longest = 0, tones_s = 0, least_s = 0, most_s = 0;
  bool is_first = true;
  for (const auto& corner : corners(times, protocol.factors)) {
    const auto here = stimulus_end(protocol, corner);
    const double at_s = evaluate(deadline, corner);
    double long_s = 0;
    for (const auto* length : lengths) long_s = std::max(long_s, evaluate(*length, corner));
    const double left_s = at_s - (here ? here->latest_s : long_s);
    if (is_first || left_s < least_s) least_s = left_s, shortest = at_s, tones_s = long_s, end = here;
    if (is_first || left_s > most_s) most_s = left_s, longest = at_s;
    is_first = false;
  }
  if (protocol.timing.response_zero == ResponseZero::first_contact && !explores && shortest < tones_s)
    advice.add(key,
               phrase("people who touch the surface at once cannot meet the deadline of %1 s after \"%2\": "
                      "answers are accepted when the last interval of %3 s has ended",
                      {plain(number(shortest)), plain(zero), plain(number(tones_s))}),
               phrase("%1 s or more, or %2", {plain(number(tones_s + shortest_deadline_s)),
                                              plain("response_zero = \"interval_off\"")}));
  if (!end) return;
  const double answers_from_s = explores ? 0 : end->latest_s;
  if (answers_from_s > 0 && shortest < answers_from_s + shortest_deadline_s)
    advice.add(key,
               phrase("the deadline of %1 s cannot be met: answers are accepted when the last interval has "
                      "ended, up to %2 s after \"%3\"",
                      {plain(number(shortest)), plain(number(answers_from_s)), plain(zero)}),
               phrase("%1 s or more, or %2", {plain(number(answers_from_s + shortest_deadline_s)),
                                              plain("response_zero = \"interval_off\"")}));
  else if (!protocol.task.value && most_s > longest_after_s && longest <= longest_s)
    advice.add(key, phrase("the deadline is %1 s after the stimulus has ended", {plain(number(most_s))}),
               phrase("nobody remembers for longer than %1 s what was felt: at most %2 s",
                      {plain(number(longest_after_s)), plain(number(longest - most_s + longest_after_s))}));
}

void check_deadline(AdviceList& advice, const std::string& key, const Linear& deadline) {
  const auto [seconds, longest] = bounds(deadline, advice.protocol.factors);
  check_length(advice, key, longest);
  if (seconds >= shortest_deadline_s) check_reach(advice, key, deadline);
  if (seconds < shortest_deadline_s)
    advice.add(key, phrase("nobody can answer within %1 s", {plain(number(seconds))}),
               phrase("%1 s or more", {plain(number(shortest_deadline_s))}));
  const double below_s = advice.protocol.analysis.exclude_below_s;
  if (below_s >= seconds)
    advice.add("analysis.response_time_exclude.below_s",
               phrase("\"below_s\" excludes all answers up to %1 s, but the deadline is only %2 s",
                      {plain(number(below_s)), plain(number(seconds))}),
               phrase("set it well below every deadline"));
}

// Checks that the change to the second scene, which follows the foreperiod, is complete before the tones end.
// A foreperiod that is longer than the tones is a problem (see check_foreperiod()).
void check_change(AdviceList& advice) {
  const auto change = latest_change(advice.protocol);
  if (!change || change->change_s + 1e-3 * advice.protocol.task.transition_ms.value_or(0) < change->whole_s)
    return;
  const double latest_s = change->change_s + 1e-3 * advice.protocol.task.transition_ms.value_or(0);
  advice.add(
      key_of(advice.protocol.task, "foreperiod_s"),
      phrase("the change can end %1 s after the tones begin, but the tones last only %2 s",
             {plain(number(latest_s)), plain(number(change->whole_s))}),
      phrase("the foreperiod plus the transition must be well below %1 s", {plain(number(change->whole_s))}));
}

// A person who slides over the surface judges what it does at the signal. After the tones there is nothing to
// feel.
void check_lag(AdviceList& advice, const ResponseSignal& signal) {
  const double latest_s = bounds(signal.after_s, advice.protocol.factors).second;
  const auto end = stimulus_end(advice.protocol);
  const std::string key = "timing.response_signal.after_s";
  const bool is_felt =
      explored(advice.protocol.task) && advice.protocol.timing.response_zero != ResponseZero::interval_off;
  if (end && is_felt && !in_stimulus(signal) && latest_s > end->earliest_s)
    advice.add(key,
               phrase("the signal can come %1 s after \"%2\", when the tones may have ended %3 s before",
                      {plain(number(latest_s)), plain(name(advice.protocol.timing.response_zero)),
                       plain(number(latest_s - end->earliest_s))}),
               phrase("at most %1 s, or longer tones", {plain(number(end->earliest_s))}));
}

}  // namespace

void advise_on_times(AdviceList& advice) {
  const auto& task = advice.protocol.task;
  const auto& timing = advice.protocol.timing;
  if (timing.deadline_s) check_deadline(advice, "timing.deadline_s", *timing.deadline_s);
  for (const auto& [name, instruction] : advice.protocol.instructions)
    if (instruction.deadline_s)
      check_deadline(advice, "instructions." + name + ".deadline_s", *instruction.deadline_s);
  if (timing.signal && timing.signal->window_s < shortest_deadline_s)
    advice.add("timing.response_signal.window_s",
               phrase("nobody can answer within %1 s of a signal", {plain(number(timing.signal->window_s))}),
               phrase("%1 s or more", {plain(number(shortest_deadline_s))}));
  if (timing.signal) check_lag(advice, *timing.signal);
  check_length(advice, "timing.iti_s", timing.iti_s.high);
  check_length(advice, "timing.explore_s", timing.explore_s.value_or(0));
  const auto longest = [&](const std::optional<Linear>& time) {
    return time ? bounds(*time, advice.protocol.factors).second : 0;
  };
  check_length(advice, key_of(task, "duration_s"), longest(task.duration_s));
  for (const auto& [name, parts] : task.parts)
    for (const auto& part : parts) {
      check_length(advice, key_of(task, "parts.") + name, longest(part.duration_s));
      check_length(advice, key_of(task, "parts.") + name, part.first_s.value_or(0));
      for (const auto& silence : part.silences_s)
        check_length(advice, key_of(task, "parts.") + name, longest(silence));
    }
  const auto before = key_of(task, "before");
  for (const auto& part : task.before) {
    check_length(advice, before, std::max(longest(part.duration_s), part.first_s.value_or(0)));
    for (const auto& silence : part.silences_s) check_length(advice, before, longest(silence));
  }
  for (const auto& silence : task.before_silences_s) check_length(advice, before, longest(silence));
  check_length(advice, key_of(task, "foreperiod_s"), task.foreperiod_s.value_or(Distribution{}).high);
  check_change(advice);
}

}  // namespace turnpoint::protocol

#include <algorithm>
#include <charconv>
#include <cmath>
#include <tuple>
#include <utility>

#include "station/store/export_tables.hpp"

namespace turnpoint::store {

namespace {

std::map<int, int> segments_of_trials(const StoredSession& stored) {
  std::map<int, int> segments;
  for (const auto& block : stored.blocks)
    for (const auto& trial : block.trials) segments[trial.trial_index] = trial.segment_index;
  return segments;
}

}  // namespace

double event_length_s(const EventRow& event) {
  double length = 0;
  if (event.kind == "stimulus")
    std::from_chars(event.value.data(), event.value.data() + event.value.size(), length);
  return length;
}

std::map<int, StimulusSpan> stimulus_spans(const StoredSession& stored) {
  const auto segments = segments_of_trials(stored);
  std::map<int, std::pair<std::int64_t, std::int64_t>> spans_ns;
  for (const auto& event : stored.events) {
    if (event.kind != "stimulus" || !event.trial_index) continue;
    const auto trial = segments.find(*event.trial_index);
    if (trial == segments.end() || trial->second != event.segment_index) continue;
    const auto origin = stored.segments.at(static_cast<std::size_t>(event.segment_index) - 1).monotonic_ns;
    const auto start_ns = event.time_ns - origin;
    const std::int64_t end_ns = start_ns + std::llround(event_length_s(event) * 1e9);
    const auto [found, fresh] = spans_ns.try_emplace(*event.trial_index, start_ns, end_ns);
    if (!fresh)
      found->second = {std::min(found->second.first, start_ns), std::max(found->second.second, end_ns)};
  }
  std::map<int, StimulusSpan> spans;
  for (const auto& [trial, span] : spans_ns)
    spans[trial] = {static_cast<double>(span.first) * 1e-9,
                    static_cast<double>(span.second - span.first) * 1e-9};
  return spans;
}

std::optional<StimulusSpan> span_of(const std::map<int, StimulusSpan>& spans, const TrialRow& trial) {
  const auto found = spans.find(trial.trial_index);
  return found == spans.end() ? std::nullopt : std::optional(found->second);
}

std::vector<EventRow> in_order_of_time(std::vector<EventRow> events) {
  std::stable_sort(events.begin(), events.end(), [](const auto& a, const auto& b) {
    return std::tie(a.segment_index, a.time_ns) < std::tie(b.segment_index, b.time_ns);
  });
  return events;
}

}  // namespace turnpoint::store

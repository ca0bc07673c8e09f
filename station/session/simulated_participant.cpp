#include "station/session/simulated_participant.hpp"

#include <algorithm>
#include <utility>

namespace turnpoint::session {

namespace {

Input at(std::int64_t time_ns, std::int64_t now_ns, InputKind kind) {
  Input input;
  input.time_ns = std::max(now_ns, time_ns);
  input.kind = kind;
  input.quality = TimeQuality::simulated;
  return input;
}

}  // namespace

SimulatedParticipant::SimulatedParticipant(simulation::Respondent observer)
    : observer_(std::move(observer)) {}

void SimulatedParticipant::answer(const simulation::Question& question, const trial::SimulatedTimes& times,
                                  std::int64_t now_ns) {
  const auto reply = observer_.answer(question);
  next_.clear();
  for (const auto& event : trial::simulated_events(times, reply)) {
    auto& input = next_.emplace_back(at(event.time_ns, now_ns, InputKind::answer));
    input.value = event.value;
    if (event.kind == trial::EventKind::contact) {
      input.kind = InputKind::contact, input.number = -1;
    } else if (reply.value) {
      input.kind = InputKind::value, input.number = *reply.value;
    }
  }
}

void SimulatedParticipant::set(const simulation::Adjustment& adjustment, const trial::TrialSpec& spec,
                               const trial::SimulatedTimes& times, std::int64_t now_ns) {
  const auto settings = observer_.adjust(adjustment);
  next_.clear();
  for (const auto& event : trial::simulated_events(times, {})) {
    auto& input = next_.emplace_back(at(event.time_ns, now_ns, InputKind::contact));
    input.value = event.value, input.number = -1;
  }
  for (const auto& move : settings.moves)
    next_
        .emplace_back(
            at(times.slider_ns + static_cast<std::int64_t>(move.time_s * 1e9), now_ns, InputKind::slider))
        .number = move.value;
  next_.push_back(at(trial::simulated_done_ns(times, spec, settings.done_s), now_ns, InputKind::next));
  std::stable_sort(next_.begin(), next_.end(),
                   [](const Input& a, const Input& b) { return a.time_ns < b.time_ns; });
}

void SimulatedParticipant::will(Input input, std::int64_t now_ns) {
  input.quality = TimeQuality::simulated;
  input.time_ns = std::max(now_ns, input.time_ns);
  next_ = {std::move(input)};
}

std::optional<std::int64_t> SimulatedParticipant::next_ns() const {
  return next_.empty() ? std::nullopt : std::optional(next_.front().time_ns);
}

Input SimulatedParticipant::take() {
  auto input = std::move(next_.front());
  next_.pop_front();
  return input;
}

}  // namespace turnpoint::session

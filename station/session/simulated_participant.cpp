#include "station/session/simulated_participant.hpp"

#include <algorithm>
#include <utility>

namespace turnpoint::session {

SimulatedParticipant::SimulatedParticipant(simulation::Respondent observer)
    : observer_(std::move(observer)) {}

void SimulatedParticipant::answer(const simulation::Question& question, const trial::SimulatedTimes& times,
                                  std::int64_t now_ns, int presented_again) {
  const auto reply = observer_.answer(question);
  next_.clear();
  for (const auto& event : trial::simulated_events(times, reply, presented_again)) {
    auto& input = next_.emplace_back(
        Input{std::max(now_ns, event.time_ns), input::Answer{event.value}, TimeQuality::simulated});
    if (event.kind == trial::EventKind::contact)
      input.content = input::Contact{event.value == 1, {}};
    else if (event.kind == trial::EventKind::again)
      input.content = input::Again{};
    else if (reply.value)
      input.content = input::Value{*reply.value};
  }
}

void SimulatedParticipant::set(const simulation::Adjustment& adjustment, const trial::TrialSpec& spec,
                               const trial::SimulatedTimes& times, std::int64_t now_ns, int presented_again) {
  const auto setting = observer_.adjust(adjustment);
  next_.clear();
  const auto plan = [&](std::int64_t time_ns, auto content) {
    next_.push_back({std::max(now_ns, time_ns), content, TimeQuality::simulated});
  };
  if (presented_again >= setting.again)
    for (const auto& move : setting.moves)
      plan(times.slider_ns + static_cast<std::int64_t>(move.time_s * 1e9), input::Slider{move.value});
  for (const auto& event : trial::simulated_events(times, spec, setting, presented_again)) {
    if (event.kind == trial::EventKind::contact)
      plan(event.time_ns, input::Contact{event.value == 1, {}});
    else if (event.kind == trial::EventKind::again)
      plan(event.time_ns, input::Again{});
    else
      plan(event.time_ns, input::Next{});
  }
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

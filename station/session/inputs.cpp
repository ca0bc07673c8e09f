#include "station/session/inputs.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace turnpoint::session {

const char* name(TimeQuality quality) {
  switch (quality) {
    case TimeQuality::kernel:
      return "kernel";
    case TimeQuality::toolkit:
      return "toolkit";
    case TimeQuality::simulated:
      return "simulated";
  }
  return "";
}

std::optional<trial::Event> event_of(const Input& input) {
  using trial::EventKind;
  switch (input.kind) {
    case InputKind::answer:
      return trial::Event{input.time_ns, EventKind::answer, input.value};
    case InputKind::touch_down:
      return trial::Event{input.time_ns, EventKind::touch, 0};
    case InputKind::contact:
      return trial::Event{input.time_ns, EventKind::contact, input.value};
    case InputKind::xrun:
      return trial::Event{input.time_ns, EventKind::xrun, input.value};
    case InputKind::heard:
      return trial::Event{input.time_ns, EventKind::heard, input.value};
    case InputKind::measured:
      if (!input.measured || input.measured->verdict < core::Proof::refused) break;
      return trial::Event{input.time_ns, EventKind::refuted, input.value};
    case InputKind::fault:
      return trial::Event{input.time_ns, EventKind::fault, 0};
    case InputKind::stop:
    case InputKind::pause:
    case InputKind::failure:
    case InputKind::repeat:
      return trial::Event{input.time_ns, EventKind::abort, 0};
    case InputKind::disarm:
      return trial::Event{input.time_ns, EventKind::fault, 0};
    case InputKind::next:
    case InputKind::back:
    case InputKind::value:
    case InputKind::slider:
    case InputKind::button:
    case InputKind::glitch:
    case InputKind::sync:
    case InputKind::notice:
    case InputKind::arm:
    case InputKind::note:
    case InputKind::frames_lost:
    case InputKind::signal_shown:
      break;
  }
  return std::nullopt;
}

void Inputs::push(Input input) {
  {
    const std::lock_guard lock(mutex_);
    const auto later = std::upper_bound(queue_.begin(), queue_.end(), input,
                                        [](const Input& a, const Input& b) { return a.time_ns < b.time_ns; });
    queue_.insert(later, std::move(input));
  }
  arrived_.notify_one();
}

void Inputs::push(InputKind kind, std::int64_t time_ns, std::string text, int value) {
  Input input;
  input.time_ns = time_ns;
  input.kind = kind;
  input.value = value;
  input.text = std::move(text);
  push(std::move(input));
}

void Inputs::push_fault(std::int64_t time_ns, FaultKind kind, std::string detail) {
  Input input;
  input.time_ns = time_ns;
  input.kind = InputKind::fault;
  input.fault = kind;
  input.text = std::move(detail);
  push(std::move(input));
}

std::optional<Input> Inputs::wait_until(std::int64_t deadline_ns) {
  // On Linux, steady_clock is CLOCK_MONOTONIC, the clock of all time stamps.
  const std::chrono::steady_clock::time_point deadline{std::chrono::nanoseconds(deadline_ns)};
  std::unique_lock lock(mutex_);
  if (!arrived_.wait_until(lock, deadline, [this] { return !queue_.empty(); })) return std::nullopt;
  Input first = std::move(queue_.front());
  queue_.pop_front();
  return first;
}

std::deque<Input> Inputs::drain() {
  const std::lock_guard lock(mutex_);
  return std::exchange(queue_, {});
}

}  // namespace turnpoint::session

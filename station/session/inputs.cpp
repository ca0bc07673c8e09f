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

namespace {

/// Finds the event of the trial machine that an input is.
struct ToEvent {
  using Event = std::optional<trial::Event>;
  using Kind = trial::EventKind;
  std::int64_t time_ns;

  Event event(Kind kind, int value = 0) const { return trial::Event{time_ns, kind, value}; }

  Event operator()(const input::Answer& answer) const { return event(Kind::answer, answer.index); }
  Event operator()(const input::Again&) const { return event(Kind::again); }
  Event operator()(const input::Touch&) const { return event(Kind::touch); }
  Event operator()(const input::Contact& contact) const { return event(Kind::contact, contact.on ? 1 : 0); }
  Event operator()(const input::Xrun& xrun) const { return event(Kind::xrun, xrun.in_stimulus ? 1 : 0); }
  Event operator()(const input::Heard& heard) const { return event(Kind::heard, heard.interval); }
  Event operator()(const input::Measured& measured) const {
    if (measured.result->verdict < core::Proof::refused) return std::nullopt;
    return event(Kind::refuted, measured.interval);
  }
  Event operator()(const input::Fault&) const { return event(Kind::fault); }
  Event operator()(const input::Disarm&) const { return event(Kind::fault); }
  Event operator()(const input::Stop&) const { return event(Kind::abort); }
  Event operator()(const input::Pause&) const { return event(Kind::abort); }
  Event operator()(const input::Failure&) const { return event(Kind::abort); }
  Event operator()(const input::Repeat&) const { return event(Kind::abort); }
  template <class Other>
  Event operator()(const Other&) const {
    return std::nullopt;
  }
};

}  // namespace

std::optional<trial::Event> event_of(const Input& input) {
  return std::visit(ToEvent{input.time_ns}, input.content);
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

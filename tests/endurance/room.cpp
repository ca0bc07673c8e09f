#include "tests/endurance/room.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace endurance {

using namespace turnpoint;
using audio::AmplifierState;
using session::FaultKind;
using session::Input;
namespace input = session::input;

namespace {

constexpr std::int64_t kForever = std::numeric_limits<std::int64_t>::max();
// time for which the virtual stage waits on a page before it continues
constexpr std::int64_t kContinue_ns = 1'000'000'000;
// the same times as on the stage with real devices
constexpr std::int64_t kSettle_ns = 50'000'000, kTail_ns = 20'000'000;
constexpr std::int64_t kDay_ns = 86'400'000'000'000;

}  // namespace

Room::Room(World& world, Disk disk, std::unique_ptr<session::Stage> inner, int rate_Hz)
    : world_(world),
      disk_(std::move(disk)),
      inner_(std::move(inner)),
      ns_per_frame_(1e9 / rate_Hz),
      born_ns_(world.now_ns) {
  world_.amplifier.begin(born_ns_);
}

Room::~Room() {
  // When the process ends for whatever reason, the kernel releases the enable line, and the pull-down
  // resistor takes it low.
  world_.amplifier.line(world_ns(), false);
  for (const char* what : {"amplifier line", "stop pressed", "lines gone"}) world_.amplifier.over(what);
  world_.now_ns = world_ns();
  world_.session_ns += now_ns();
}

void Room::line() {
  if (!disk_.dead()) world_.amplifier.line(world_ns(), guard_.outputs().enable == 1);
}

void Room::plan(std::int64_t in_ns, std::function<void()> happens) {
  planned_.push_back({now_ns() + in_ns, std::move(happens)});
  std::stable_sort(planned_.begin(), planned_.end(),
                   [](const auto& a, const auto& b) { return a.time_ns < b.time_ns; });
}

void Room::push(input::Any content) {
  inputs_.push_back({now_ns(), std::move(content), session::TimeQuality::simulated});
}

/// With real devices, the thread of the amplifier's guard and the session do this
/// between two events.
void Room::attend() {
  if (disk_.dead()) throw Died("in a write");
  const auto now = now_ns();
  guard_.audio_alive(now);
  guard_.session_alive(now);
  guard_.tick(now);
  if (closing_ && now >= quiet_ns_ + kTail_ns) {
    guard_.disable();
    closing_ = false;
  }
  line();
}

std::optional<Input> Room::wait_until(std::int64_t deadline_ns) {
  for (;;) {
    attend();
    if (!inputs_.empty()) {
      auto input = std::move(inputs_.front());
      inputs_.pop_front();
      return input;
    }
    const auto now = now_ns();
    const auto off_ns = closing_ ? std::max(now + 1, quiet_ns_ + kTail_ns) : kForever;
    const auto mine = planned_.empty() ? kForever : planned_.front().time_ns;
    const auto fault = std::max(now, world_.next_fault_ns - born_ns_);
    const auto next = std::min({off_ns, mine, fault});
    if (deadline_ns == kForever && next > now + kContinue_ns) return inner_->wait_until(kForever);
    if (auto input = inner_->wait_until(std::min(deadline_ns, next))) return attend(), input;
    if (now_ns() >= mine) {
      auto due = std::move(planned_.front());
      planned_.erase(planned_.begin());
      due.happens();
    } else if (now_ns() >= fault) {
      world_.next_fault_ns = world_ns() + world_.course.until_next_ns();
      strike(world_.course.next());
    }
    if (now_ns() >= deadline_ns && inputs_.empty()) return attend(), std::nullopt;
  }
}

std::vector<Input> Room::drain() {
  inner_->drain();
  return {std::make_move_iterator(inputs_.begin()),
          std::make_move_iterator(std::exchange(inputs_, {}).end())};
}

std::vector<session::Onset> Room::present(std::span<const audio::PreparedBurst> intervals,
                                          std::int64_t earliest_ns) {
  attend();
  const auto onsets = inner_->present(intervals, std::max(earliest_ns, opened_ns_ + kSettle_ns));
  stimuli_.clear();
  for (std::size_t i = 0; i < onsets.size(); ++i) {
    const auto length_ns =
        static_cast<std::int64_t>(static_cast<double>(intervals[i].length_frames) * ns_per_frame_);
    stimuli_.emplace_back(onsets[i].time_ns, onsets[i].time_ns + length_ns);
    quiet_ns_ = std::max(quiet_ns_, onsets[i].time_ns + length_ns);
    world_.amplifier.stimulus(born_ns_ + onsets[i].time_ns, born_ns_ + onsets[i].time_ns + length_ns);
  }
  return onsets;
}

std::int64_t Room::silence(bool awaits_heard) {
  quiet_ns_ = inner_->silence(awaits_heard);
  for (auto& [from_ns, until_ns] : stimuli_) until_ns = std::min(until_ns, quiet_ns_);
  return quiet_ns_;
}

/// Simulates an underrun. The stream reports the lost frames once the gap is over. The loss affects the
/// stimulus that is being presented.
void Room::strike_underrun() {
  const auto now = now_ns();
  const bool in_stimulus = std::any_of(stimuli_.begin(), stimuli_.end(), [now](const auto& stimulus) {
    return stimulus.first <= now && now < stimulus.second;
  });
  push(input::Xrun{in_stimulus, "960 frames lost"});
}

Room::Refusal Room::arm() {
  attend();
  const auto refusal = guard_.arm(now_ns());
  if (refusal) return session::Fault{refusal->kind, ""};
  world_.amplifier.armed(world_ns()), fault_told_ = false;
  return std::nullopt;
}

Room::Refusal Room::clear() {
  if (!missing_.empty()) return session::Fault{FaultKind::lines_gone, missing_};
  const auto refusal = guard_.clear();
  return refusal ? Refusal(session::Fault{refusal->kind, ""}) : std::nullopt;
}

void Room::disarm() {
  world_.amplifier.cause(world_ns(), "disarmed by the operator");
  guard_.disarm();
  line();
}

Room::Refusal Room::open_amplifier() {
  attend();
  closing_ = false;
  if (amplifier() == AmplifierState::enabled) return std::nullopt;
  opened_ns_ = now_ns();
  const auto refusal = guard_.enable(now_ns());
  line();
  return refusal ? Refusal(session::Fault{refusal->kind, ""}) : std::nullopt;
}

void Room::finish() {
  guard_.disarm();
  line();
  world_.amplifier.cause(world_ns(), "the session's end");
}

/// Plays the operator: whenever a page requires arming, arms after some seconds, even if the cause of the
/// fault is still present.
void Room::show(const session::Page& page) {
  if (disk_.dead()) return;
  world_.amplifier.page(world_ns(), page.kind);
  if (page.kind != session::PageKind::fault) return;
  disk_.bytes_left(-1);
  const bool wanted = page.amplifier == "disarmed" || page.amplifier == "faulted";
  if (!wanted || std::exchange(arm_planned_, true)) return;
  plan(world_.course.seconds(1, 8), [this] {
    arm_planned_ = false;
    push(input::Arm{});
  });
}

// Reports a guard's fault to the session as the stage with real devices does: once for each latched fault.
void Room::tell_guard_fault() {
  line();
  if (guard_.state() != AmplifierState::faulted || std::exchange(fault_told_, true)) return;
  push(session::Fault{guard_.fault().kind, guard_.fault().detail});
}

void Room::strike_line(const char* what, void (io::Guard::*change)(std::int64_t, bool) noexcept) {
  world_.amplifier.cause(world_ns(), what);
  world_.amplifier.lasts(what);
  if (world_.plant != Plant::deaf_guard) (guard_.*change)(now_ns(), true);
  tell_guard_fault();
  plan(world_.course.seconds(0.01, 20), [this, what, change] {
    world_.amplifier.over(what);
    (guard_.*change)(now_ns(), false);
  });
}

void Room::strike_device() {
  world_.amplifier.cause(world_ns(), "converter gone");
  guard_.trip(now_ns(), FaultKind::converter_gone);
  tell_guard_fault();
  plan(world_.course.seconds(0.5, 10), [this] { push(input::Notice{"the converter is back"}); });
}

/// Simulates the loss of the GPIO chip. Buttons and amplifier are both on it, so its loss is reported twice.
/// Arming is refused until the chip is back.
void Room::strike_chip() {
  world_.amplifier.cause(world_ns(), "lines gone");
  world_.amplifier.lasts("lines gone");
  missing_ = "the chip is gone";
  push(session::Fault{FaultKind::lines_gone, "panel: " + missing_});
  guard_.trip(now_ns(), FaultKind::lines_gone);
  tell_guard_fault();
  plan(world_.course.seconds(0.1, 20), [this] {
    world_.amplifier.over("lines gone");
    missing_.clear();
    push(input::Notice{"panel: the lost device is connected again"});
  });
}

void Room::strike(Fault fault) {
  switch (fault) {
    case Fault::amplifier_line:
      return strike_line("amplifier line", &io::Guard::fault_line);
    case Fault::stop_pressed:
      return strike_line("stop pressed", &io::Guard::stop_line);
    case Fault::converter_gone:
      return strike_device();
    case Fault::lines_gone:
      return strike_chip();
    case Fault::audio_silent: {
      guard_.session_alive(now_ns() + 150'000'000);
      guard_.tick(now_ns() + 150'000'000);  // the audio thread's last report is then 150 ms old
      if (guard_.state() == AmplifierState::faulted) world_.amplifier.cause(world_ns(), "audio silent");
      return tell_guard_fault();
    }
    case Fault::underrun:
      return strike_underrun();
    case Fault::touch_gone:
      return push(session::Fault{FaultKind::touch_gone, "panel: it was unplugged"});
    case Fault::disarm:
      return push(input::Disarm{});
    case Fault::repeat:
      return push(input::Repeat{});
    case Fault::pause:
      return push(input::Pause{});
    case Fault::end_session:
      return push(input::Stop{});
    case Fault::clock_jump: {
      const auto by_ns = world_.course.between(-3 * kDay_ns, 3 * kDay_ns);
      world_.wall_offset_ns += by_ns;
      return push(input::Notice{"the wall clock was set"});
    }
    case Fault::disk_full:
      return disk_.bytes_left(world_.course.between(0, 40'000));
    case Fault::kill_in_write:
    case Fault::power_cut_in_write:
      return disk_.die_later(fault, static_cast<int>(world_.course.between(1, 40)));
    case Fault::kill:
    case Fault::power_cut:
      disk_.die(fault);
      throw Died(name(fault));
  }
}

}  // namespace endurance

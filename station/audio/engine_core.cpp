#include "station/audio/engine_core.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "station/audio/sine.hpp"
#include "station/core/usage_error.hpp"

namespace turnpoint::audio {
namespace {

constexpr const char* not_taken = "burst refused: the audio thread has not processed the last 32 commands";

}  // namespace

EngineCore::EngineCore(const StreamConfig& config) : config_(config), synth_(format_of(config.output)) {
  if (!config.carrier) return;
  const auto& carrier = *config.carrier;
  const auto& output = config.output;
  if (!(carrier.frequency_Hz > 0 &&
        carrier.frequency_Hz < config.limits.highest_relative_Hz * output.rate_Hz) ||
      carrier.channel < 0 || carrier.channel >= output.channels ||
      !(carrier.amplitude > 0 && carrier.amplitude <= config.limits.peak))
    throw core::UsageError(fmt::format(
        "carrier of {} Hz and {} of full scale on channel {}: not possible at "
        "{} Hz with {} channels",
        carrier.frequency_Hz, carrier.amplitude, carrier.channel, output.rate_Hz, output.channels));
  synth_.set_carrier(rendered(carrier, output.rate_Hz));
}

void EngineCore::send(const Command& command) {
  if (!commands_->push(command)) throw BurstRefused(not_taken);
}

// Refuses a burst if too many others are waiting, or if the peaks of overlapping bursts add up to too much.
void EngineCore::check_room(const PreparedBurst& burst) const {
  std::array<double, max_channels> sum = burst.peak;
  if (config_.carrier) sum[static_cast<std::size_t>(config_.carrier->channel)] += config_.carrier->amplitude;
  std::size_t voices = 0;
  for (const Open& other : open_) {
    if (other.rendered || other.burst.id == burst.id) continue;
    ++voices;
    if (other.end_frame <= burst.start_frame ||
        burst.start_frame + burst.length_frames <= other.burst.start_frame)
      continue;
    for (std::size_t c = 0; c < max_channels; ++c) sum[c] += other.burst.peak[c];
  }
  if (voices >= Synth::max_voices)
    throw BurstRefused(fmt::format("burst refused: {} bursts are already waiting or playing", voices));
  const double limit = largest_peak(format_of(config_.output), config_.limits);
  for (std::size_t c = 0; c < max_channels; ++c)
    if (sum[c] > limit)
      throw BurstRefused(
          fmt::format("burst refused: together with the bursts already playing, channel {} could reach "
                      "{:.6f} of full scale; the limit is {:.6f}",
                      c, sum[c], limit));
}

std::uint32_t EngineCore::schedule(const Burst& burst, const Earliest& earliest_frame) {
  const PreparedBurst prepared = prepare(burst, format_of(config_.output), config_.limits);
  const auto only_then = [&] {
    const auto earliest = earliest_frame();
    if (burst.start_frame < earliest)
      throw BurstRefused(fmt::format(
          "burst refused: start frame {} is already past; the earliest possible start is frame {}",
          burst.start_frame, earliest));
    return earliest;
  };
  return schedule_together({&prepared, 1}, only_then).front().burst;
}

std::vector<Scheduled> EngineCore::schedule_together(std::span<const PreparedBurst> bursts,
                                                     const Earliest& earliest_frame) {
  gather();
  if (commands_->room() < bursts.size()) throw BurstRefused(not_taken);
  const auto before = open_.size();
  std::vector<Scheduled> scheduled;
  const auto later = std::max<std::int64_t>(0, earliest_frame() - bursts.front().start_frame);
  try {
    for (PreparedBurst burst : bursts) {
      burst.id = ++last_id_;
      burst.start_frame += later;
      check_room(burst);
      open_.push_back({burst, burst.start_frame + burst.length_frames});
      scheduled.push_back({burst.id, burst.start_frame});
    }
  } catch (const BurstRefused&) {
    open_.resize(before);
    throw;
  }
  outgoing_->kind = CommandKind::start;
  for (std::size_t i = before; i < open_.size(); ++i) {
    outgoing_->start = open_[i].burst;
    send(*outgoing_);
  }
  return scheduled;
}

void EngineCore::change(std::uint32_t burst, const Change& change) {
  gather();
  Open* const found = find(burst);
  if (found == nullptr || found->rendered)
    throw BurstRefused(fmt::format("change refused: burst {} has ended", burst));
  outgoing_->kind = CommandKind::change;
  outgoing_->burst = burst;
  PreparedBurst changed = found->burst;
  outgoing_->change = prepare_change(change, changed, format_of(config_.output), config_.limits);
  check_room(changed);
  send(*outgoing_);
  found->burst = changed;
}

void EngineCore::stop(std::uint32_t burst, const Ramp& ramp, std::optional<std::int64_t> frame) {
  outgoing_->kind = CommandKind::stop;
  outgoing_->burst = burst;
  outgoing_->frame = frame.value_or(0);
  outgoing_->ramp = ramp;
  send(*outgoing_);
}

EngineCore::Open* EngineCore::find(std::uint32_t burst) {
  const auto found =
      std::find_if(open_.begin(), open_.end(), [&](const Open& open) { return open.burst.id == burst; });
  return found == open_.end() ? nullptr : &*found;
}

// Marks as damaged the bursts that lost any frame of [first_frame, end_frame). Returns the number of the
// first such burst, or 0.
std::uint32_t EngineCore::damage(std::int64_t first_frame, std::int64_t end_frame) {
  std::uint32_t first = 0;
  for (Open& open : open_) {
    if (open.damaged || open.burst.start_frame >= end_frame || open.end_frame <= first_frame) continue;
    open.damaged = true;
    if (first == 0) first = open.burst.id;
  }
  return first;
}

// Updates the list of open bursts when the audio side reports an event.
void EngineCore::follow(Event& event) {
  constexpr auto forever = std::numeric_limits<std::int64_t>::max();
  switch (event.kind) {
    case EventKind::burst_started:
      if (Open* const open = find(event.burst)) open->begun = true;
      break;
    case EventKind::burst_ended:
      if (Open* const open = find(event.burst)) open->rendered = true, open->end_frame = event.frame;
      std::erase_if(open_, [](const Open& open) { return open.rendered && !open.begun; });
      break;
    case EventKind::burst_missed:
      std::erase_if(open_, [&](const Open& open) { return open.burst.id == event.burst; });
      break;
    case EventKind::underrun:
      event.burst = damage(event.frame, event.retimed ? forever : event.frame + event.frames);
      break;
    case EventKind::device_lost:
      event.burst = damage(event.frame, forever);
      break;
    case EventKind::device_back:
      event.burst = damage(0, forever);
      break;
    case EventKind::burst_unfollowed:
    case EventKind::burst_follows:
    case EventKind::burst_heard:
    case EventKind::rate_wrong:
      break;
  }
}

void EngineCore::gather() {
  // Read this position before the events are read: the events then include all losses before this frame.
  const std::int64_t heard = atomics_.heard.load();
  Event event;
  while (events_->pop(event)) {
    follow(event);
    gathered_.push_back(event);
  }
  const auto over = [heard](const Open& open) { return open.rendered && open.end_frame <= heard; };
  for (const Open& open : open_)
    if (over(open) && !open.damaged)
      gathered_.push_back({EventKind::burst_heard, open.burst.id, open.end_frame});
  std::erase_if(open_, over);
}

std::optional<Event> EngineCore::poll() {
  gather();
  if (gathered_.empty()) return std::nullopt;
  const Event event = gathered_.front();
  gathered_.pop_front();
  return event;
}

Counters EngineCore::counters() const noexcept {
  Counters counters;
  counters.frames = atomics_.frames.load();
  counters.heard = atomics_.heard.load();
  counters.bursts = atomics_.bursts.load();
  counters.missed = atomics_.missed.load();
  counters.underruns = atomics_.underruns.load();
  counters.lost_frames = atomics_.lost_frames.load();
  counters.saturated = atomics_.saturated.load();
  counters.device_losses = atomics_.device_losses.load();
  counters.events_dropped = atomics_.events_dropped.load();
  return counters;
}

void EngineCore::report(const Event& event) noexcept {
  switch (event.kind) {
    case EventKind::burst_started:
      atomics_.bursts.fetch_add(1);
      break;
    case EventKind::burst_missed:
      atomics_.missed.fetch_add(1);
      break;
    case EventKind::underrun:
      atomics_.underruns.fetch_add(1);
      atomics_.lost_frames.fetch_add(event.frames);
      break;
    case EventKind::device_lost:
      atomics_.device_losses.fetch_add(1);
      break;
    case EventKind::burst_ended:
    case EventKind::burst_unfollowed:
    case EventKind::burst_follows:
    case EventKind::burst_heard:
    case EventKind::device_back:
    case EventKind::rate_wrong:
      break;
  }
  if (!events_->push(event)) atomics_.events_dropped.fetch_add(1);
}

void EngineCore::lose(const Event& event, std::int64_t next_frame) noexcept {
  synth_.skip_to(next_frame);
  // Store the frame before sending the event. Otherwise somebody who reads the event could schedule a burst
  // into the gap.
  atomics_.frames.store(next_frame);
  report(event);
}

void EngineCore::take_commands() noexcept {
  while (commands_->pop(*incoming_)) {
    switch (incoming_->kind) {
      case CommandKind::start:
        if (!synth_.start(incoming_->start))
          report({EventKind::burst_missed, incoming_->start.id, incoming_->start.start_frame});
        break;
      case CommandKind::change:
        // A change has no effect if the burst has just ended; an event reports the end.
        static_cast<void>(synth_.change(incoming_->burst, incoming_->change));
        break;
      case CommandKind::stop:
        synth_.stop(incoming_->burst, incoming_->frame, incoming_->ramp);
        break;
    }
  }
  // After the commands, because gains belong to a burst that has been sent before them.
  for (GainPeriod gains; gains_->pop(gains);) synth_.follow(gains);
}

// Sends the synthesiser's events up to `frame` to the control thread.
void EngineCore::report_until(std::int64_t frame) noexcept {
  for (const SynthEvent& event : synth_.events()) {
    const EventKind kind = event.kind == SynthEventKind::started      ? EventKind::burst_started
                           : event.kind == SynthEventKind::ended      ? EventKind::burst_ended
                           : event.kind == SynthEventKind::missed     ? EventKind::burst_missed
                           : event.kind == SynthEventKind::unfollowed ? EventKind::burst_unfollowed
                                                                      : EventKind::burst_follows;
    report({kind, event.burst, event.frame});
  }
  synth_.clear_events();
  atomics_.saturated.store(static_cast<std::int64_t>(synth_.saturated()));
  atomics_.frames.store(frame);
}

std::vector<system::MemoryRange> EngineCore::memory() const {
  return {system::range_of(*incoming_), system::range_of(*commands_), system::range_of(*events_),
          system::range_of(*gains_), synth_.memory()};
}

void EngineCore::process(std::int64_t frame, std::span<std::int32_t> samples) noexcept {
  take_commands();
  synth_.render(frame, samples);
  report_until(frame + static_cast<std::int64_t>(samples.size()) / config_.output.channels);
}

void EngineCore::pass(std::int64_t frame, std::int64_t frames) noexcept {
  take_commands();
  synth_.pass(frame, frames);
  report_until(frame + frames);
}

}  // namespace turnpoint::audio

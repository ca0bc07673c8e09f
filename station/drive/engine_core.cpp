#include "station/drive/engine_core.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace turnpoint::drive {

EngineCore::EngineCore(const StreamConfig& config)
    : config_(config), synth_(format_of(config.output), config.precision) {}

void EngineCore::send(const Command& command) {
  if (!commands_->push(command))
    throw BurstRefused("burst refused: the audio thread has not taken the last 16 commands");
}

// Peaks of bursts that overlap add up, channel by channel.
void EngineCore::check_room(const PreparedBurst& burst) const {
  if (open_.size() >= Synth::max_voices)
    throw BurstRefused(fmt::format("burst refused: {} bursts wait or sound already", open_.size()));
  std::array<double, max_channels> sum = burst.peak;
  for (const PreparedBurst& other : open_) {
    if (other.start_frame + other.length_frames <= burst.start_frame ||
        burst.start_frame + burst.length_frames <= other.start_frame)
      continue;
    for (std::size_t c = 0; c < max_channels; ++c) sum[c] += other.peak[c];
  }
  for (std::size_t c = 0; c < max_channels; ++c)
    if (sum[c] > config_.limits.peak)
      throw BurstRefused(
          fmt::format("burst refused: with what sounds already, channel {} may reach {:.6f}; allowed {:.6f}",
                      c, sum[c], config_.limits.peak));
}

std::uint32_t EngineCore::schedule(const Burst& burst, const Earliest& earliest_frame) {
  gather();
  PreparedBurst prepared = prepare(burst, format_of(config_.output), config_.limits);
  if (const auto earliest = earliest_frame(); burst.start_frame < earliest)
    throw BurstRefused(
        fmt::format("burst refused: frame {} is gone; the soonest is {}", burst.start_frame, earliest));
  return start(prepared);
}

Scheduled EngineCore::schedule_soon(const Burst& burst, const Earliest& earliest_frame) {
  gather();
  PreparedBurst prepared = prepare(burst, format_of(config_.output), config_.limits);
  prepared.start_frame = std::max(prepared.start_frame, earliest_frame());
  return {start(prepared), prepared.start_frame};
}

std::uint32_t EngineCore::start(PreparedBurst& burst) {
  check_room(burst);
  burst.id = ++last_id_;
  outgoing_->kind = CommandKind::start;
  outgoing_->start = burst;
  send(*outgoing_);
  open_.push_back(burst);
  return burst.id;
}

void EngineCore::change(std::uint32_t burst, const Change& change) {
  gather();
  const auto found = std::find_if(open_.begin(), open_.end(), [&](const auto& b) { return b.id == burst; });
  if (found == open_.end()) throw BurstRefused(fmt::format("change refused: burst {} has ended", burst));
  outgoing_->kind = CommandKind::change;
  outgoing_->burst = burst;
  outgoing_->change = prepare_change(change, *found, format_of(config_.output), config_.limits);
  send(*outgoing_);
  const PreparedChange& sent = outgoing_->change;
  for (auto i = static_cast<std::size_t>(found->tone_count); i < static_cast<std::size_t>(sent.count); ++i)
    found->tones[i] = sent.to[i];
  found->tone_count = sent.count;
}

void EngineCore::stop(std::uint32_t burst, const Ramp& ramp, std::optional<std::int64_t> frame) {
  outgoing_->kind = CommandKind::stop;
  outgoing_->burst = burst;
  outgoing_->frame = frame.value_or(0);
  outgoing_->ramp = ramp;
  send(*outgoing_);
}

void EngineCore::gather() {
  Event event;
  while (events_->pop(event)) {
    if (event.kind == EventKind::burst_ended || event.kind == EventKind::burst_missed)
      std::erase_if(open_, [&](const PreparedBurst& burst) { return burst.id == event.burst; });
    gathered_.push_back(event);
  }
}

std::optional<Event> EngineCore::poll() {
  gather();
  if (gathered_.empty()) return std::nullopt;
  const Event event = gathered_.front();
  gathered_.pop_front();
  return event;
}

Counters EngineCore::counters() const noexcept {
  return {atomics_.frames.load(),        atomics_.bursts.load(),        atomics_.missed.load(),
          atomics_.underruns.load(),     atomics_.lost_frames.load(),   atomics_.saturated.load(),
          atomics_.device_losses.load(), atomics_.events_dropped.load()};
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
    case EventKind::device_back:
    case EventKind::rate_wrong:
      break;
  }
  if (!events_->push(event)) atomics_.events_dropped.fetch_add(1);
}

void EngineCore::take_commands() noexcept {
  while (commands_->pop(*incoming_)) {
    switch (incoming_->kind) {
      case CommandKind::start:
        if (!synth_.start(incoming_->start))
          report({EventKind::burst_missed, incoming_->start.id, incoming_->start.start_frame});
        break;
      case CommandKind::change:
        // A burst that has just ended cannot change any more; its end is reported.
        static_cast<void>(synth_.change(incoming_->burst, incoming_->change));
        break;
      case CommandKind::stop:
        synth_.stop(incoming_->burst, incoming_->frame, incoming_->ramp);
        break;
    }
  }
}

// What the synth said up to `frame`.
void EngineCore::report_until(std::int64_t frame) noexcept {
  for (const SynthEvent& event : synth_.events()) {
    const EventKind kind = event.kind == SynthEventKind::started ? EventKind::burst_started
                           : event.kind == SynthEventKind::ended ? EventKind::burst_ended
                                                                 : EventKind::burst_missed;
    report({kind, event.burst, event.frame});
  }
  synth_.clear_events();
  atomics_.saturated.store(static_cast<std::int64_t>(synth_.saturated()));
  atomics_.frames.store(frame);
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

}  // namespace turnpoint::drive

#include "station/session/triggers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "station/audio/trigger_code.hpp"
#include "station/protocol/triggers.hpp"

namespace turnpoint::session {

static_assert(rig::trigger_code_bits == audio::trigger_bits + audio::trigger_quiet_bits);

namespace {

// a captured pulse begins where the signal exceeds this fraction of full scale
constexpr double kPulse = 0.25;
// longest wait until a code is found in the captured signal, or set on the lines
constexpr std::int64_t kWait_ns = 2'000'000'000;

}  // namespace

TriggerSetup trigger_setup_of(const rig::Rig& rig) {
  TriggerSetup setup;
  if (rig.marker && rig.marker->kind == rig::Marker::Kind::code) setup.marker = rig.marker;
  if (setup.marker) setup.bit_frames = 2 * std::llround(setup.marker->duration_s * rig.output.rate_Hz / 2);
  setup.lines = rig.trigger_lines_uri.has_value();
  if (rig.capture) setup.marker_channel = rig.capture->marker_channel;
  if (rig.sync) setup.sync_channel = rig.sync->channel;
  setup.simulated_sync = rig.sync && rig.sync->uri == "sim:";
  return setup;
}

TriggerCapture::TriggerCapture(const TriggerSetup& setup, double delay_frames) : delay_frames_(delay_frames) {
  if (setup.marker_channel) decoder_.emplace(*setup.marker_channel, setup.bit_frames);
  if (setup.sync_channel) edges_.emplace(*setup.sync_channel, kPulse);
}

void TriggerCapture::push(const sensing::CaptureBlock& block) {
  const std::lock_guard lock(mutex_);
  const auto delay = std::llround(delay_frames_);
  if (edges_)
    for (const auto edge : edges_->push(block)) news_.edges.push_back(edge - delay);
  if (!decoder_) return;
  decoder_->push(block);
  for (auto found : decoder_->take()) {
    found.frame -= delay_frames_;
    news_.heard.push_back(found);
  }
  const auto first = block.first_frame - delay, end = first + block.frames();
  auto& captured = news_.captured;
  if (!captured.empty() && captured.back().second == first)
    captured.back().second = end;
  else
    captured.emplace_back(first, end);
}

TriggerCapture::News TriggerCapture::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, {});
}

Triggers::Triggers(const TriggerSetup& setup, audio::Stream& stream, io::TriggerLines* lines)
    : setup_(setup), stream_(stream), lines_(lines) {}

std::int64_t Triggers::code_frames() const { return audio::trigger_bits * setup_.bit_frames; }

void Triggers::add(Open open) {
  auto& trigger = open.trigger;
  if (setup_.marker && trigger.refused.empty()) {
    free_from_ = std::max(free_from_, trigger.frame + rig::trigger_code_bits * setup_.bit_frames);
    if (setup_.marker_channel) trigger.read_back = Trigger::ReadBack::pending;
  }
  if (lines_ != nullptr)
    lines_->give(trigger.code, trigger.time_ns);
  else if (setup_.lines)
    trigger.lines_ns = trigger.time_ns;
  open_.push_back(std::move(open));
}

void Triggers::scheduled(Trigger trigger) { add({std::move(trigger), 0}); }

void Triggers::send(Trigger trigger, std::int64_t now_ns) {
  std::uint32_t burst_id = 0;
  trigger.time_ns = now_ns;
  if (setup_.marker) {
    audio::Burst burst;
    burst.start_frame = free_from_;
    burst.length_frames = rig::trigger_code_bits * setup_.bit_frames;
    burst.ramp.frames = 0;
    burst.marker = {audio::MarkerKind::code,  setup_.marker->channel,
                    setup_.marker->amplitude, 0,
                    setup_.bit_frames,        {static_cast<std::uint8_t>(trigger.code)}};
    try {
      const auto scheduled = stream_.schedule_soon(burst);
      burst_id = scheduled.burst;
      trigger.frame = scheduled.start_frame;
      trigger.time_ns = stream_.time_of(scheduled.start_frame).value_or(now_ns);
    } catch (const audio::BurstRefused& refused) {
      trigger.refused = refused.what();
    }
  }
  add({std::move(trigger), burst_id});
}

void Triggers::cut(std::int64_t from_frame, std::int64_t silent_frame, std::int64_t now_ns) {
  if (lines_ != nullptr) lines_->cancel(now_ns);
  std::erase_if(open_, [&](const Open& open) {
    return open.trigger.frame >= from_frame && open.trigger.time_ns > now_ns;
  });
  if (!setup_.marker) return;
  for (auto& open : open_)
    if (open.trigger.frame + code_frames() > silent_frame) {
      open.trigger.cut = true;
      if (open.trigger.read_back == Trigger::ReadBack::pending)
        open.trigger.read_back = Trigger::ReadBack::none;
    }
  free_from_ = std::min(free_from_, silent_frame + setup_.bit_frames);
}

bool Triggers::owns(std::uint32_t burst) const {
  return std::any_of(open_.begin(), open_.end(), [&](const Open& open) { return open.burst == burst; });
}

void Triggers::missed(std::uint32_t burst) {
  for (auto& open : open_)
    if (open.burst == burst) {
      open.trigger.refused = "it came too late to be played";
      open.trigger.read_back = Trigger::ReadBack::none;
    }
}

bool Triggers::needs(std::int64_t first_frame, std::int64_t end_frame) const {
  const auto margin = 4 * setup_.bit_frames;
  return std::any_of(open_.begin(), open_.end(), [&](const Open& open) {
    return open.trigger.read_back == Trigger::ReadBack::pending && open.trigger.frame - margin < end_frame &&
           open.trigger.frame + code_frames() + margin > first_frame;
  });
}

void Triggers::captured(const TriggerCapture::News& news) {
  for (const auto& heard : news.heard) {
    const auto sent = std::find_if(open_.begin(), open_.end(), [&](const Open& open) {
      return open.trigger.read_back == Trigger::ReadBack::pending && open.trigger.code == heard.code &&
             std::abs(heard.frame - static_cast<double>(open.trigger.frame)) <
                 0.25 * static_cast<double>(setup_.bit_frames);
    });
    if (sent == open_.end()) {
      extra_.push_back(heard);
      continue;
    }
    sent->trigger.read_back = Trigger::ReadBack::right;
    sent->trigger.error_frames = heard.frame - static_cast<double>(sent->trigger.frame);
  }
  for (const auto& [first, end] : news.captured) {
    conclude(first, end);
    covered_ = first == covered_.second ? std::pair{covered_.first, end} : std::pair{first, end};
  }
}

/// Judges the codes that ended before `end_frame`. The newest range of captured frames begins at
/// `first_frame`. A code can be judged only if the capture contains all of it, with some bits before and
/// after it.
void Triggers::conclude(std::int64_t first_frame, std::int64_t end_frame) {
  const auto margin = 2 * setup_.bit_frames;
  const auto from = first_frame == covered_.second ? covered_.first : first_frame;
  for (auto& open : open_) {
    auto& trigger = open.trigger;
    if (trigger.read_back != Trigger::ReadBack::pending) continue;
    const auto begin = trigger.frame - margin, end = trigger.frame + code_frames() + 2 * margin;
    const bool before = begin >= covered_.first && end <= covered_.second;
    if (before || (begin >= from && end <= end_frame))
      trigger.read_back = Trigger::ReadBack::missed;
    else if (begin < from && trigger.frame < end_frame)
      trigger.read_back = Trigger::ReadBack::lost;
  }
}

Triggers::Done Triggers::take(std::int64_t now_ns) {
  Done done;
  if (lines_ != nullptr) {
    for (const auto& given : lines_->take())
      for (auto& open : open_)
        if (!open.trigger.lines_ns && open.trigger.code == given.code &&
            open.trigger.time_ns == given.due_ns) {
          open.trigger.lines_ns = given.time_ns;
          break;
        }
    if (!failure_told_) done.failure = lines_->failure();
    failure_told_ = failure_told_ || !done.failure.empty();
  }
  for (auto& open : open_) {
    auto& trigger = open.trigger;
    const bool late = now_ns > trigger.time_ns + kWait_ns;
    if (late && trigger.read_back == Trigger::ReadBack::pending) trigger.read_back = Trigger::ReadBack::lost;
  }
  const auto known = [&](const Open& open) {
    const auto& trigger = open.trigger;
    const bool late = now_ns > trigger.time_ns + kWait_ns;
    const bool on_lines = !setup_.lines || trigger.lines_ns || late || failure_told_;
    return now_ns >= trigger.time_ns && on_lines && trigger.read_back != Trigger::ReadBack::pending;
  };
  for (const auto& open : open_)
    if (known(open)) done.triggers.push_back(open.trigger);
  std::erase_if(open_, known);
  done.extra = std::exchange(extra_, {});
  return done;
}

std::vector<core::EventRow> rows_of(const Trigger& trigger) {
  const auto what = fmt::format("{} {} frame {}", trigger.code, protocol::name(trigger.event), trigger.frame);
  const auto row = [&](const char* kind, const std::string& value) {
    return core::EventRow{trigger.time_ns, kind, value, trigger.trial_index};
  };
  if (!trigger.refused.empty() && !trigger.lines_ns)
    return {row("trigger_missed", what + ", not sent: " + trigger.refused)};
  auto value = what;
  if (trigger.lines_ns)
    value +=
        fmt::format("; lines {:+.0f} us", 1e-3 * static_cast<double>(*trigger.lines_ns - trigger.time_ns));
  if (trigger.cut) value += "; cut short";
  if (!trigger.refused.empty()) value += "; not on the marker channel: " + trigger.refused;
  if (trigger.read_back == Trigger::ReadBack::right)
    // Adding 0 turns -0 into 0, which would be printed as "-0.00".
    value += fmt::format("; read back {:+.2f} frames", std::round(100 * trigger.error_frames) / 100 + 0.0);
  if (trigger.read_back == Trigger::ReadBack::lost) value += "; not captured";
  std::vector<core::EventRow> rows{row("trigger", value)};
  if (trigger.read_back == Trigger::ReadBack::missed) rows.push_back(row("trigger_missed", what));
  return rows;
}

core::EventRow row_of_extra(const sensing::DecodedTrigger& extra, std::int64_t time_ns, int trial_index) {
  return {time_ns, "trigger_extra", fmt::format("{} frame {:.0f}", extra.code, extra.frame), trial_index};
}

}  // namespace turnpoint::session

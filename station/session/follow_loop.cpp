#include "station/session/follow_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace turnpoint::session {

static_assert(audio::gains_per_period == follow::kGains);

/// What the capture's thread needs in one trial. The session makes it, and frees it when the capture has
/// taken the next one.
struct FollowLoop::Trial {
  struct One {
    std::int32_t interval = 0;
    Burst burst;
    std::int64_t lead_frames = 0;  ///< from the end of a captured period to the first frame that it changes
    follow::Follower follower;
  };

  std::uint64_t number = 0;
  follow::Bridges bridges;
  follow::Timing timing;
  std::vector<double> drive_Hz;
  follow::BridgeWindow window;
  std::vector<One> all;
  Alignment alignment;
  bool forces_known = true;  ///< false: the readings without a finger are not known, or frames were lost
  /// Bit i: the gains of interval i were not played. From the session to the capture.
  std::atomic<std::uint32_t> unplayed{0};
};

follow::Bridges bridges_of(const sensing::FingerSetup& finger, const sensing::Readings& tare) {
  const auto& cells = finger.bridges;
  follow::Bridges bridges;
  bridges.carrier_Hz = cells.carrier_Hz;
  bridges.channels = cells.channels;
  bridges.reference = cells.reference;
  bridges.bridges = cells.bridges;
  bridges.reference_amplitude = cells.reference_amplitude;
  bridges.full_scale = cells.full_scale;
  bridges.rotation_rad = cells.rotation_rad;
  bridges.tare = tare;
  bridges.matrix = finger.calibration.matrix();
  for (auto& row : bridges.matrix) row[2] *= 1e-3;  // from N mm
  return bridges;
}

FollowLoop::FollowLoop(audio::Stream& stream, int channels) : stream_(stream), channels_(channels) {
  lock({system::range_of(*this), system::range_of(*done_)});
}

/// An ordinary stream, which needs no rights, locks nothing.
void FollowLoop::lock(const std::vector<system::MemoryRange>& memory) {
  if (!stream_.rights().asked) return;
  if (const auto rights = system::lock_memory(memory); !rights.memory_locked) not_locked_ = rights.note;
}

FollowLoop::~FollowLoop() = default;

void FollowLoop::prepare(const FollowPlans& plans, std::span<const audio::PreparedBurst> bursts,
                         const std::optional<sensing::FingerSetup>& finger) {
  next_.reset();
  end();
  const auto refuse = [](const std::string& why) {
    throw audio::BurstRefused("the surface cannot follow the finger: " + why);
  };
  if (std::none_of(plans.begin(), plans.end(), [](const auto& plan) { return plan != nullptr; })) return;
  if (!finger || finger->own_clock)
    refuse("its force cells must be calibrated, and captured by the sound card that plays");
  auto trial = std::make_unique<Trial>();
  trial->bridges = bridges_of(*finger, {});
  const int rate_Hz = stream_.config().output.rate_Hz;
  try {
    for (std::size_t i = 0; i < plans.size(); ++i) {
      if (!plans[i]) continue;
      const auto& timing = plans[i]->timing;
      const auto& output = stream_.config().output;
      const auto buffered = std::int64_t{output.period_frames} * output.periods;
      const auto planned = std::int64_t{timing.period_frames} * timing.buffer_periods;
      if (timing.rate_Hz == rate_Hz && buffered > planned)
        refuse(fmt::format(
            "the sound device buffers {} periods of {} frames ({:.2f} ms), and {:.2f} ms were planned",
            output.periods, output.period_frames, 1e3 * static_cast<double>(buffered) / rate_Hz,
            1e3 * static_cast<double>(planned) / rate_Hz));
      if (timing.rate_Hz != rate_Hz)
        refuse(fmt::format("it was planned for {} Hz, and the sound device plays at {} Hz", timing.rate_Hz,
                           rate_Hz));
      if (!trial->all.empty() && (timing.period_frames != trial->timing.period_frames ||
                                  timing.window_frames != trial->timing.window_frames ||
                                  timing.converter_s != trial->timing.converter_s))
        refuse("the intervals of a trial have different periods");
      trial->timing = timing;
      const auto lead = std::int64_t{timing.buffer_periods} * timing.period_frames +
                        std::llround(timing.converter_s * rate_Hz);
      trial->all.push_back({static_cast<std::int32_t>(i), {}, lead, follow::Follower(*plans[i])});
    }
    for (const auto& burst : bursts) {
      const auto add = [&](const audio::Partial& tone) {
        if (tone.amplitude > 0)
          trial->drive_Hz.push_back(static_cast<double>(tone.increment) * 0x1p-64 * rate_Hz);
      };
      for (int k = 0; k < burst.tone_count; ++k) add(burst.tones[static_cast<std::size_t>(k)]);
      for (int c = 0; c < burst.change_count; ++c)
        for (int k = 0; k < burst.changes[static_cast<std::size_t>(c)].count; ++k)
          add(burst.changes[static_cast<std::size_t>(c)].to[static_cast<std::size_t>(k)]);
    }
    trial->window = follow::BridgeWindow(trial->bridges, trial->timing, trial->drive_Hz);
  } catch (const std::invalid_argument& problem) {
    refuse(problem.what());
  }
  lock({system::range_of(*trial), system::range_of(trial->all)});
  next_ = std::move(trial);
}

std::string DelayCheck::sentence() const {
  const auto stated = fmt::format(
      "the rig states {:.2f} ms as the delay of its converters (\"converter_delay_ms\")", 1e3 * stated_s);
  if (tight())
    return fmt::format(
        "{}, but {:.2f} to {:.2f} ms are needed: {} gains come too late, and the surface rests; state {:.1f} "
        "ms",
        stated, 1e3 * least_s, 1e3 * most_s, too_short() ? "all" : "some", std::ceil(1e4 * most_s) / 10);
  if (too_long())
    return fmt::format(
        "{}, but {:.2f} ms are enough: the surface follows the finger {:.2f} ms later than it could", stated,
        1e3 * most_s, 1e3 * (stated_s - most_s));
  return fmt::format("{}, and {:.2f} ms are needed", stated, 1e3 * most_s);
}

std::optional<DelayCheck> FollowLoop::check_delay(const Alignment& alignment) const {
  if (!next_) return std::nullopt;
  std::uint32_t version = 0;
  std::int64_t least = 0, most = 0;
  do {
    version = ahead_version_.load();
    if (version == 0 || ahead_numbering_.load() != alignment.numbering) return std::nullopt;
    least = least_ahead_.load(), most = most_ahead_.load();
  } while (version % 2 != 0 || version != ahead_version_.load());
  const auto& timing = next_->timing;
  const auto buffer = std::int64_t{timing.buffer_periods} * timing.period_frames;
  const auto seconds = [&](std::int64_t frames) {
    return static_cast<double>(frames - alignment.shift - buffer) / timing.rate_Hz;
  };
  return DelayCheck{timing.converter_s, seconds(least), seconds(most),
                    static_cast<double>(timing.period_frames) / timing.rate_Hz};
}

void FollowLoop::begin(std::span<const Burst> bursts, const std::optional<sensing::Readings>& tare,
                       const Alignment& alignment) {
  static_cast<void>(take());  // what was left of the trial before
  begun_.clear();
  if (!next_) return;
  auto trial = std::move(next_);
  trial->alignment = alignment;
  trial->forces_known = tare.has_value();
  if (tare) {
    trial->bridges.tare = *tare;
    trial->window = follow::BridgeWindow(trial->bridges, trial->timing, trial->drive_Hz);
  }
  for (auto& one : trial->all) {
    one.burst = bursts[static_cast<std::size_t>(one.interval)];
    const auto& plan = one.follower.plan();
    begun_.push_back({static_cast<std::size_t>(one.interval), one.burst, plan.timing});
  }
  current_ = trial.get();
  offer(std::move(trial));
  active_ = true;
}

void FollowLoop::end() {
  current_ = nullptr;
  if (!std::exchange(active_, false)) return;
  auto nothing = std::make_unique<Trial>();
  lock({system::range_of(*nothing)});
  offer(std::move(nothing));
}

/// Hands a trial to the capture's thread, and frees those that it no longer uses.
void FollowLoop::offer(std::unique_ptr<Trial> trial) {
  trial->number = ++last_number_;
  offered_.store(trial.get(), std::memory_order_release);
  kept_.push_back(std::move(trial));
  const auto taken = taken_.load(std::memory_order_acquire);
  while (kept_.front()->number < taken) kept_.pop_front();
}

void FollowLoop::cut(std::int64_t frame) { followed_.cut_frame = std::min(followed_.cut_frame, frame); }

void FollowLoop::note(const audio::Event& event) {
  const auto one = std::find_if(begun_.begin(), begun_.end(),
                                [&](const Begun& begun) { return begun.burst.burst == event.burst; });
  if (one == begun_.end()) return;
  auto& late = followed_.late;
  if (event.kind == audio::EventKind::burst_follows && !late.empty() && late.back().burst == event.burst)
    late.back().to_frame = event.frame;
  if (event.kind != audio::EventKind::burst_unfollowed) return;
  late.push_back({event.burst, event.frame});
  // The follower counts on gains that were not played; the frames that it leaves out tell it.
  if (current_ != nullptr) current_->unplayed.fetch_or(1u << one->interval);
}

void FollowLoop::gather() {
  for (follow::Recorded period; done_->pop(period);) followed_.periods.push_back(period);
}

/// Drops the updates whose gains were not played as they say.
void FollowLoop::drop_unplayed() {
  std::erase_if(followed_.periods, [&](const follow::Recorded& one) {
    const auto begun = std::find_if(begun_.begin(), begun_.end(), [&](const Begun& of) {
      return of.interval == static_cast<std::size_t>(one.interval);
    });
    if (begun == begun_.end()) return true;
    const auto end = one.frame + begun->timing.period_frames;
    return end > followed_.cut_frame ||
           std::any_of(followed_.late.begin(), followed_.late.end(), [&](const Followed::Late& late) {
             return late.burst == begun->burst.burst && one.frame < late.to_frame && end > late.from_frame;
           });
  });
}

sensing::CommandedEnvelope FollowLoop::commanded(std::size_t interval) {
  gather();
  drop_unplayed();
  sensing::CommandedEnvelope envelope;
  const auto begun =
      std::find_if(begun_.begin(), begun_.end(), [&](const Begun& one) { return one.interval == interval; });
  if (begun == begun_.end()) return envelope;
  const std::int64_t period = begun->timing.period_frames, eighth = period / follow::kGains;
  const auto is_of = [&](const follow::Recorded& one) {
    return one.interval == static_cast<std::int32_t>(interval);
  };
  const auto first = std::find_if(followed_.periods.begin(), followed_.periods.end(), is_of);
  if (first == followed_.periods.end()) return envelope;
  const auto last = std::find_if(followed_.periods.rbegin(), followed_.periods.rend(), is_of);
  envelope.start_frame = first->frame + eighth;
  envelope.step_frames = static_cast<int>(eighth);
  envelope.gain.assign(static_cast<std::size_t>((last->frame - first->frame) / eighth + follow::kGains),
                       std::nan(""));
  for (const auto& one : followed_.periods)
    for (std::size_t k = 0; k < follow::kGains && is_of(one); ++k)
      envelope.gain[static_cast<std::size_t>((one.frame - first->frame) / eighth) + k] =
          static_cast<double>(one.update.gain[k]);
  return envelope;
}

Followed FollowLoop::take() {
  gather();
  drop_unplayed();
  followed_.not_recorded = not_recorded_.exchange(0);
  return std::exchange(followed_, {});
}

/// A gain for playback frame f must have come when frames up to f have been rendered.
void FollowLoop::watch_delay(std::int64_t captured_end, std::uint32_t numbering) noexcept {
  if (numbering != ahead_.numbering) ahead_ = {};
  ahead_.numbering = numbering;
  const std::int64_t ahead = stream_.counters().frames - captured_end;
  ahead_.least = std::min(ahead_.least, ahead);
  ahead_.most = std::max(ahead_.most, ahead);
  if (++ahead_.blocks < kAheadBlocks) return;
  ahead_version_.fetch_add(1);
  ahead_numbering_.store(numbering);
  least_ahead_.store(ahead_.least);
  most_ahead_.store(ahead_.most);
  ahead_version_.fetch_add(1);
  ahead_ = {};
  ahead_.numbering = numbering;
}

void FollowLoop::captured(std::int64_t first_frame, std::uint32_t numbering,
                          std::span<const std::int32_t> samples) noexcept {
  watch_delay(first_frame + static_cast<std::int64_t>(samples.size()) / channels_, numbering);
  if (Trial* const offered = offered_.load(std::memory_order_acquire); offered != trial_) {
    trial_ = offered;
    taken_.store(trial_->number, std::memory_order_release);
  }
  if (trial_ == nullptr || trial_->all.empty()) return;
  Trial& trial = *trial_;
  if (numbering != trial.alignment.numbering) trial.forces_known = false;
  const int period = trial.timing.period_frames;
  auto left = static_cast<std::int64_t>(samples.size()) / channels_;
  const std::int32_t* frames = samples.data();
  while (left > 0) {
    const auto count = std::min<std::int64_t>(left, period - first_frame % period);
    trial.window.push(first_frame + trial.alignment.shift, frames, static_cast<int>(count));
    first_frame += count, left -= count, frames += count * channels_;
    if (first_frame % period == 0) update(trial, first_frame);
  }
}

/// Computes and sends the gains that follow from what was captured up to this frame.
void FollowLoop::update(Trial& trial, std::int64_t captured_end) noexcept {
  auto sample = trial.window.sample();
  if (!trial.forces_known) sample.fault = follow::Fault::force;
  const int period = trial.timing.period_frames;
  for (auto& one : trial.all) {
    const auto frame = captured_end + trial.alignment.shift + one.lead_frames;
    if (frame + period <= one.burst.start_frame || frame >= one.burst.end_frame) continue;
    const auto bit = 1u << one.interval;
    if ((trial.unplayed.load(std::memory_order_relaxed) & bit) != 0) {
      trial.unplayed.fetch_and(~bit);
      continue;
    }
    const auto& update = one.follower.update(frame, sample);
    // If the audio thread does not take gains, it does not play either; it will find that they are missing.
    static_cast<void>(stream_.follow({one.burst.burst, period, frame, update.gain}));
    if (!done_->push({one.interval, frame, sample.frame, update})) not_recorded_.fetch_add(1);
  }
}

}  // namespace turnpoint::session

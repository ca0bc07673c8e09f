#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "station/io/guard.hpp"
#include "station/session/presented.hpp"

namespace turnpoint::session {

namespace {

class VirtualStage : public Stage {
 public:
  VirtualStage(const audio::StreamConfig& config, SimulatedParticipant& participant, Inputs& inputs,
               std::unique_ptr<SimulatedRoom> room, const TriggerSetup& triggers)
      : stream_(audio::open_synchronous(config)),
        triggers_(triggers, *stream_, nullptr),
        simulated_sync_(triggers.simulated_sync),
        participant_(participant),
        inputs_(inputs),
        room_(std::move(room)) {
    if (room_) {
      watch_.emplace(room_->capture());
      capture_.emplace(triggers, room_->capture().delay_frames);
      loop_.emplace(*stream_, room_->capture().channels);
      stream_->listen([this](std::int64_t first_frame, std::span<const std::int32_t> played) {
        const auto frames = static_cast<std::int64_t>(played.size()) / stream_->config().output.channels;
        const bool watched =
            touchable_ || watch_->needs(first_frame - kLead_frames, first_frame + frames + kLead_frames);
        if (!watched && !triggers_.needs(first_frame - kLead_frames, first_frame + frames)) return;
        const auto captured = room_->advance(first_frame, played);
        loop_->captured(captured.first_frame, 0, captured.samples);
        loop_->gather();
        if (watched) watch_->push(captured);
        capture_->push(captured);
      });
    }
    static_cast<void>(arm());  // a simulated amplifier never refuses at the start
  }

  std::int64_t now_ns() override { return now_ns_; }

  std::optional<Input> wait_until(std::int64_t deadline_ns) override {
    if (!simulated_sync_) return wait_for_input(deadline_ns);
    // A pulse may have become due since the last call: report it first, with its own time stamp.
    if (sync_due_ns_ <= now_ns_) return pulse();
    return wait_for_input(deadline_ns);
  }

  std::optional<Input> wait_for_input(std::int64_t deadline_ns) {
    const auto next_ns = participant_.next_ns();
    if (auto heard = next_heard(std::min(deadline_ns, next_ns.value_or(deadline_ns)))) return heard;
    if (next_ns && *next_ns <= deadline_ns) {
      advance_to(*next_ns);
      return participant_.take();
    }
    if (deadline_ns != kForever) {
      advance_to(deadline_ns);
      return std::nullopt;
    }
    advance_to(now_ns_ + kContinue_ns);
    return Input{now_ns_, input::Next{}, TimeQuality::simulated};
  }

  /// Returns only requests to stop the session, which take effect before the next trial. So a simulated
  /// session that was stopped and resumed equals one that was not interrupted. A trial takes only
  /// milliseconds of real time, so nobody waits long.
  std::vector<Input> drain() override {
    participant_.forget();
    unheard_.clear();
    measured_ = false;
    touchable_ = false;
    if (loop_) loop_->end();
    std::vector<Input> stops;
    for (auto& input : inputs_.drain()) {
      if (!input.is<input::Stop>()) continue;
      input.time_ns = now_ns_;
      stops.push_back(std::move(input));
    }
    return stops;
  }

  void wait_for(const std::function<bool()>&) override {
    // Nothing to do: the next call of the session waits for the planner, and virtual time stands still
    // meanwhile.
  }

  std::vector<Onset> present(std::span<const audio::PreparedBurst> intervals,
                             std::int64_t earliest_ns) override {
    // The bursts of an aborted trial may still be ramping down. They occupy the drive until they are silent.
    advance_to(quiet_ns_);
    if (watch_) earliest_ns = std::max(earliest_ns, now_ns_ + kExpected_ns);
    if (triggers_.active())
      earliest_ns = std::max(earliest_ns, stream_->time_of(triggers_.free_from()).value());
    const auto onsets = schedule(*stream_, intervals, earliest_ns, presented_);
    unheard_ = presented_;
    measured_ = false;  // a fault may have ended the last trial after `measured` and before `heard`
    if (watch_) {
      const auto bursts = scheduled(intervals, presented_);
      room_->expect(intervals);
      watch_->expect(bursts, stream_->frame(), [this](std::size_t i) { return loop_->commanded(i); });
      room_->touch(bursts.back().start_frame + bursts.back().length_frames - stream_->frame());
      if (loop_->prepared()) {
        const auto delay = static_cast<std::int64_t>(std::floor(room_->capture().delay_frames));
        loop_->begin(followed_of(presented_), watch_->zero(), {-delay, 0});
      }
    }
    return onsets;
  }

  void follow(const FollowPlans& plans, std::span<const audio::PreparedBurst> intervals) override {
    if (!loop_) return Stage::follow(plans, intervals);
    loop_->prepare(plans, intervals, room_->capture().finger);
  }
  Followed followed() override { return loop_ ? loop_->take() : Followed{}; }

  std::optional<std::int64_t> glide(const audio::ToneSet& to, double seconds) override {
    const auto change = glide_to(*stream_, presented_, to, seconds);
    if (!change) return std::nullopt;
    if (watch_) watch_->changed(presented_.size() - 1, *change, audio::format_of(stream_->config().output));
    return presented_.back().start_frame + change->at_frame;
  }

  std::int64_t silence(bool) override {
    const auto from = stream_->earliest_frame();
    std::erase_if(unheard_, [from](const Presented& interval) { return interval.start_frame >= from; });
    for (auto& interval : unheard_)
      interval.end_frame = std::min(interval.end_frame, from + presented_.back().ramp.frames);
    if (watch_) {
      watch_->cut(from);
      room_->lift(from - stream_->frame());
      loop_->cut(from);
    }
    quiet_ns_ = ramp_down(*stream_, presented_, now_ns_);
    triggers_.cut(from, stream_->frame_at(quiet_ns_).value(), now_ns_);
    return quiet_ns_;
  }

  Refusal arm() override { return refusal(alive().arm(now_ns_)); }
  void disarm() override { guard_.disarm(); }
  Refusal clear() override { return refusal(guard_.clear()); }
  audio::AmplifierState amplifier() const override { return guard_.state(); }
  Refusal open_amplifier() override {
    // Before each trial the force cells are read without a finger, which takes a moment.
    if (room_ && room_->capture().finger) {
      touchable_ = true;
      advance_to(now_ns_ + kQuiet_ns);
    }
    return refusal(alive().enable(now_ns_));
  }
  void close_amplifier() override { guard_.disable(); }

  Triggers& triggers() override {
    if (capture_) triggers_.captured(capture_->take());
    return triggers_;
  }

  const std::vector<std::string>& buttons() const override { return no_buttons_; }
  std::string missing() const override { return ""; }
  std::optional<CaptureSetup> capture() const override {
    return room_ ? std::optional(room_->capture()) : std::nullopt;
  }
  VibrationWatch* watch() override { return watch_ ? &*watch_ : nullptr; }
  std::optional<ClockFit> clock_fit() override { return fit_of(*stream_); }
  std::string realtime_rights() const override { return describe(stream_->rights()); }
  void finish() override {
    guard_.disarm();
    stream_->finish();
  }

 private:
  /// Reports the next interval that has been played completely, if it ends no later than `until_ns`. The
  /// input with the interval's measurement comes first.
  std::optional<Input> next_heard(std::int64_t until_ns) {
    if (unheard_.empty()) return std::nullopt;
    const auto interval = *interval_of(presented_, unheard_.front().burst);
    const auto index = static_cast<std::size_t>(interval);
    auto end_frame = unheard_.front().end_frame;
    if (watch_) end_frame = std::max(end_frame, watch_->known_at(index));
    const auto end_ns = stream_->time_of(end_frame).value();
    if (end_ns > until_ns) return std::nullopt;
    advance_to(end_ns);
    if (watch_ && !std::exchange(measured_, true)) {
      const auto forces = watch_->forces(index);
      if (forces) touchable_ = false;
      if (const auto result = watch_->result(index))
        return Input{now_ns_, input::Measured{interval, result, forces}, TimeQuality::simulated};
    }
    unheard_.erase(unheard_.begin());
    measured_ = false;
    return Input{now_ns_, input::Heard{interval}, TimeQuality::simulated};
  }

  /// A pulse of a simulated device, one each second.
  Input pulse() {
    const auto due_ns = std::exchange(sync_due_ns_, sync_due_ns_ + 1'000'000'000);
    return {due_ns, input::Sync{stream_->frame_at(due_ns).value()}, TimeQuality::simulated};
  }

  // time for which the simulated observer reads a page
  static constexpr std::int64_t kContinue_ns = 1'000'000'000;
  static constexpr std::int64_t kQuiet_ns = 700'000'000;

  void advance_to(std::int64_t time_ns) {
    now_ns_ = std::max(now_ns_, time_ns);
    const auto frames = stream_->frame_at(now_ns_).value() - stream_->frame();
    if (frames > 0) stream_->advance(frames);
    while (const auto event = stream_->poll())
      if (loop_) loop_->note(*event);
  }

  /// Returns the amplifier guard's state machine, which works here without GPIO lines. All threads are
  /// reported as alive, because on the virtual clock none of them can hang.
  io::Guard& alive() {
    guard_.audio_alive(now_ns_);
    guard_.session_alive(now_ns_);
    return guard_;
  }
  static Refusal refusal(const std::optional<io::Guard::Refusal>& why) {
    return why ? Refusal(Fault{why->kind, ""}) : std::nullopt;
  }

  const std::vector<std::string> no_buttons_;
  io::Guard guard_;
  std::unique_ptr<audio::SynchronousStream> stream_;
  Triggers triggers_;
  std::optional<TriggerCapture> capture_;
  const bool simulated_sync_;
  std::int64_t sync_due_ns_ = 0;
  SimulatedParticipant& participant_;
  Inputs& inputs_;
  std::int64_t now_ns_ = 0;
  std::int64_t quiet_ns_ = 0;  ///< time at which the surface will be silent
  std::vector<Presented> presented_, unheard_;
  // The plate goes on moving for some time after the drive stops, so simulate it from this many frames before
  // the measurement, and for as many frames after it.
  static constexpr std::int64_t kLead_frames = 9600;
  std::unique_ptr<SimulatedRoom> room_;  ///< the simulated surface and finger; null if nothing is captured
  std::optional<VibrationWatch> watch_;
  std::optional<FollowLoop> loop_;  ///< empty if nothing is captured
  /// true while the simulated participant touches the surface or may soon touch it; every frame must then be
  /// simulated
  bool touchable_ = false;
  bool measured_ = false;  ///< the measurement of the first interval in unheard_ has been reported
};

}  // namespace

void Stage::follow(const FollowPlans& plans, std::span<const audio::PreparedBurst>) {
  if (std::any_of(plans.begin(), plans.end(), [](const auto& plan) { return plan != nullptr; }))
    throw audio::BurstRefused("the surface cannot follow the finger: nothing is captured here");
}

std::unique_ptr<Stage> virtual_stage(const audio::StreamConfig& stream, SimulatedParticipant& participant,
                                     Inputs& inputs, std::unique_ptr<SimulatedRoom> room,
                                     const TriggerSetup& triggers) {
  return std::make_unique<VirtualStage>(stream, participant, inputs, std::move(room), triggers);
}

}  // namespace turnpoint::session

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "station/audio/recovery.hpp"
#include "station/session/presented.hpp"
#include "station/session/trial_capture.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::session {

namespace {

constexpr std::int64_t kPoll_ns = 5'000'000;        // time between two polls of drive and amplifier guard
constexpr std::int64_t kClocks_ns = 1'000'000'000;  // interval between two comparisons of the clocks
// time from switching the amplifier on to the first stimulus
constexpr std::int64_t kSettle_ns = 50'000'000;
constexpr std::int64_t kFirstBlocks_ns = 500'000'000;
// longest wait until a restarted sound device reports its position
constexpr std::int64_t kFirstPosition_ns = 500'000'000;
// longest wait for the report that an interval was played completely
constexpr std::int64_t kHeard_ns = 1'000'000'000;
// time from the end of the last stimulus to switching the amplifier off
constexpr std::int64_t kTail_ns = 20'000'000;

class RealStage : public Stage {
 public:
  RealStage(audio::StreamConfig config, Devices devices, Inputs& inputs,
            const std::optional<CardCapture>& capture, const TriggerSetup& triggers)
      : devices_(std::move(devices)), inputs_(inputs), clocks_(devices_.clocks()) {
    config.amplifier = devices_.amplifier.get();
    stream_ = devices_.open_stream(config);
    triggers_.emplace(triggers, *stream_, devices_.triggers.get());
    if (capture) {
      loop_.emplace(*stream_, capture->device.channels);
      finger_ = capture->setup.finger;
      capture_ =
          std::make_unique<TrialCapture>(*capture, devices_, *stream_, inputs_,
                                         [this](const std::function<bool()>& ready) { wait_for(ready); });
      capture_->feed().set_listener(*loop_);
    }
  }

  std::int64_t now_ns() override { return system::monotonic_ns(); }

  std::optional<Input> wait_until(std::int64_t deadline_ns) override {
    for (;;) {
      attend();
      const auto now = now_ns();
      const auto until = std::min(deadline_ns, now + kPoll_ns);
      if (auto input = inputs_.wait_until(until)) return with_frame(std::move(*input));
      if (until == deadline_ns) return std::nullopt;
    }
  }

  std::vector<Input> drain() override {
    attend();
    // Forget the stimuli of the previous trial, so that late reports about them cannot reach the next trial.
    presented_.clear();
    unheard_ = 0;
    if (capture_) capture_->forget();
    if (loop_) loop_->end();
    lost_ns_.reset();
    std::vector<Input> gathered;
    for (auto& input : inputs_.drain()) gathered.push_back(with_frame(std::move(input)));
    return gathered;
  }

  void wait_for(const std::function<bool()>& ready) override {
    while (!ready()) {
      attend();
      system::sleep_until_ns(now_ns() + kPoll_ns / 5);
    }
  }

  std::vector<Onset> present(std::span<const audio::PreparedBurst> intervals,
                             std::int64_t earliest_ns) override {
    // The bursts of an aborted trial may still be ramping down. They occupy the drive until they are silent.
    wait_for([&] { return now_ns() >= quiet_ns_; });
    const auto until_ns = now_ns() + kFirstPosition_ns;
    wait_for([&] { return stream_->clock().pairs > 0 || now_ns() > until_ns; });
    earliest_ns = std::max(earliest_ns, opened_ns_ + kSettle_ns);
    if (capture_) earliest_ns = std::max(earliest_ns, now_ns() + kExpected_ns);
    if (triggers_->active())
      earliest_ns = std::max(earliest_ns, stream_->time_of(triggers_->free_from()).value_or(earliest_ns));
    auto onsets = schedule(*stream_, intervals, earliest_ns, presented_);
    if (capture_ && !onsets.empty()) {
      auto& watch = capture_->feed().watch();
      watch.expect(scheduled(intervals, presented_), stream_->frame_at(now_ns()).value_or(0),
                   [this](std::size_t i) { return loop_->commanded(i); });
      if (loop_->prepared()) {
        const auto alignment = capture_->feed().alignment();
        const auto zero = alignment ? watch.zero() : std::nullopt;
        if (alignment) compare_delay(*alignment);
        loop_->begin(followed_of(presented_), zero, alignment.value_or(Alignment{}));
        if (!zero)
          inputs_.push({now_ns(), Fault{FaultKind::capture,
                                        "the surface cannot follow the finger: the force cells were not read "
                                        "without a finger"}});
      }
    }
    if (onsets.empty())
      miss(now_ns(), "the converter does not report which frame it is playing");
    else
      quiet_ns_ = std::max(quiet_ns_, later(onsets.back(), intervals.back().length_frames));
    if (!onsets.empty()) first_onset_ = onsets.front();
    unheard_ = onsets.size();
    return onsets;
  }

  void follow(const FollowPlans& plans, std::span<const audio::PreparedBurst> intervals) override {
    if (!loop_) return Stage::follow(plans, intervals);
    loop_->prepare(plans, intervals, finger_);
    if (!loop_->not_locked().empty() && !std::exchange(lock_told_, true))
      inputs_.push({now_ns(), input::Notice{"the memory that follows the finger is not locked: " +
                                            loop_->not_locked()}});
  }
  Followed followed() override { return loop_ ? loop_->take() : Followed{}; }

  std::optional<std::int64_t> glide(const audio::ToneSet& to, double seconds) override {
    const auto change = glide_to(*stream_, presented_, to, seconds);
    if (!change) return std::nullopt;
    if (capture_)
      capture_->feed().watch().changed(presented_.size() - 1, *change,
                                       audio::format_of(stream_->config().output));
    return presented_.back().start_frame + change->at_frame;
  }

  std::int64_t silence(bool awaits_heard) override {
    // If the last burst has not begun, it is cancelled and never reported as heard, so do not wait for that
    // report.
    const auto from = stream_->earliest_frame();
    if (!presented_.empty() && presented_.back().start_frame >= from) {
      unheard_ = 0;
      // Somebody has answered at a time when the stimulus should have been playing, so the drive is stalled.
      if (awaits_heard) miss(now_ns(), "the trial was answered before the drive had begun the stimulus");
    }
    if (capture_) capture_->feed().watch().cut(stream_->counters().frames);
    if (loop_) loop_->cut(from);
    const auto silent_ns = ramp_down(*stream_, presented_, now_ns());
    triggers_->cut(from, stream_->frame_at(silent_ns).value_or(from), now_ns());
    return quiet_ns_ = lost_ns_.value_or(silent_ns);
  }

  Refusal arm() override {
    // The amplifier can be armed only while the audio thread reports to the guard. It reports with its first
    // blocks, so wait for these when a session starts.
    const auto until_ns = now_ns() + kFirstBlocks_ns;
    const auto begun = 2 * stream_->config().output.period_frames;
    wait_for([&] { return stream_->counters().frames > begun || now_ns() > until_ns; });
    if (wrong_rate_) return wrong_rate_;
    show_life();
    return amplifier_().arm();
  }
  void disarm() override { amplifier_().disarm(); }
  Refusal clear() override {
    auto refusal = amplifier_().clear();
    if (!refusal) fault_told_ = false;
    return refusal;
  }
  audio::AmplifierState amplifier() const override { return devices_.amplifier->state(); }

  Refusal open_amplifier() override {
    if (const auto refusal = align()) return refusal;
    if (const auto refusal = await_cells()) return refusal;
    closing_ = false;
    if (amplifier() == audio::AmplifierState::enabled) return std::nullopt;
    if (capture_ && std::exchange(off_, false)) capture_->feed().amplifier_goes_on();
    opened_ns_ = now_ns();
    show_life();
    return amplifier_().enable();
  }
  void close_amplifier() override { closing_ = true; }

  Triggers& triggers() override {
    if (capture_) take_captured();
    return *triggers_;
  }

  const std::vector<std::string>& buttons() const override {
    return devices_.buttons ? devices_.buttons->names() : no_buttons_;
  }
  std::string missing() const override { return devices_.buttons ? devices_.buttons->missing() : ""; }
  audio::Amplifier* guarded_amplifier() override { return devices_.amplifier.get(); }
  VibrationWatch* watch() override { return capture_ ? &capture_->feed().watch() : nullptr; }
  std::optional<ClockFit> clock_fit() override { return fit_of(*stream_); }
  std::string realtime_rights() const override {
    const auto playback = describe(stream_->rights());
    return capture_ ? playback + "; capture: " + describe(capture_->feed().rights()) : playback;
  }

  void finish() override {
    closing_ = true;
    wait_for([this] { return amplifier() != audio::AmplifierState::enabled; });
    amplifier_().disarm();
  }

 private:
  audio::Amplifier& amplifier_() { return *devices_.amplifier; }

  /// Measures the delay from playback to capture if it is not known. The amplifier is off meanwhile.
  Refusal align() {
    if (!capture_ || capture_->aligned()) return std::nullopt;
    closing_ = true;
    wait_for([this] { return amplifier() != audio::AmplifierState::enabled; });
    return capture_->align();
  }

  /// Waits for the converter of the force cells, if it has one of its own and was disconnected.
  Refusal await_cells() {
    if (!capture_ || !capture_->misses_cells()) return std::nullopt;
    closing_ = true;
    return capture_->await_cells();
  }

  /// Reports to the guard that the session thread is alive, and passes on when the participant's page last
  /// reported.
  void show_life() {
    amplifier_().session_alive();
    if (const auto page_ns = inputs_.page_alive_ns(); page_ns >= 0) amplifier_().page_alive(page_ns);
  }

  /// Reports to the guard that the session is alive, and processes what drive, guard and clocks have
  /// reported.
  void attend() {
    const auto now = now_ns();
    show_life();
    if (closing_ && now >= quiet_ns_ + kTail_ns) {
      amplifier_().disable();
      closing_ = false;
    }
    while (const auto event = stream_->poll()) hear(*event, now);
    if (loop_) loop_->gather();
    if (capture_) {
      capture_->attend(now);
      take_captured();
      listen_while_off();
    }
    look_at_samples();
    if (unheard_ > 0 && now > quiet_ns_ + kHeard_ns) {
      unheard_ = 0;
      miss(now, "the converter does not report whether a stimulus was played");
    }
    if (amplifier() == audio::AmplifierState::faulted && !std::exchange(fault_told_, true))
      tell_amplifier_fault();
    if (now >= clocks_due_ns_) look_at_clocks(now);
  }

  /// If the stated delay of the converters is so short that the surface could only rest, the trial is void.
  /// Otherwise it is noted once if it could be better.
  void compare_delay(const Alignment& alignment) {
    const auto check = loop_->check_delay(alignment);
    if (!check) return;
    if (check->too_short()) return inputs_.push({now_ns(), Fault{FaultKind::capture, check->sentence()}});
    if ((check->tight() || check->too_long()) && !std::exchange(delay_told_, true))
      inputs_.push({now_ns(), input::Notice{check->sentence()}});
  }

  /// Passes on the trigger codes that were found in the captured signal, and reports the captured pulses of
  /// other devices.
  void take_captured() {
    const auto news = capture_->feed().triggers().take();
    triggers_->captured(news);
    for (const auto frame : news.edges) {
      const auto time_ns = stream_->time_of(frame);
      if (time_ns) inputs_.push({*time_ns, input::Sync{frame}});
    }
  }

  /// Adds the playback frame to a pulse on a GPIO line, for which only the time is known.
  Input with_frame(Input input) {
    if (auto* sync = std::get_if<input::Sync>(&input.content); sync && !sync->frame)
      sync->frame = stream_->frame_at(input.time_ns);
    return input;
  }

  void tell_amplifier_fault() {
    auto fault = amplifier_().fault();
    const auto reaction_ns = amplifier_().reaction_ns();
    const bool by_edge = fault.kind == FaultKind::amplifier || fault.kind == FaultKind::stop_pressed;
    if (by_edge && reaction_ns >= 0)
      fault.detail = fmt::format("the amplifier was switched off after {:.0f} us",
                                 1e-3 * static_cast<double>(reaction_ns));
    inputs_.push({fault.time_ns, Fault{fault.kind, fault.detail}});
  }

  void miss(std::int64_t time_ns, const char* what) {
    inputs_.push({time_ns, Fault{FaultKind::stimulus_missed, what}});
  }

  /// Trips the guard if the pick-up hears a vibration while the amplifier is off: the amplifier does not
  /// obey, or something else drives the surface.
  void listen_while_off() {
    auto& feed = capture_->feed();
    const bool off = amplifier() != audio::AmplifierState::enabled;
    if (off && !off_) feed.amplifier_is_off();
    if (!off && off_) feed.amplifier_goes_on();
    off_ = off;
    if (const auto found = feed.disturbance())
      amplifier_().trip(FaultKind::sounding, fmt::format("a tone of {:.1f} kHz at {:.0f} dB of full drive",
                                                         1e-3 * found->frequency_Hz, found->level_dB));
  }

  void look_at_samples() {
    const auto saturated = stream_->counters().saturated;
    if (saturated > saturated_)
      amplifier_().trip(FaultKind::converter_saturated,
                        fmt::format("{} samples clipped", saturated - saturated_));
    saturated_ = saturated;
  }

  /// Returns the time of the frame that comes `frames` after an onset.
  std::int64_t later(const Onset& onset, std::int64_t frames) const {
    return onset.time_ns + frames * 1'000'000'000 / stream_->config().output.rate_Hz;
  }

  void hear(const audio::Event& event, std::int64_t now) {
    const auto interval = interval_of(presented_, event.burst);
    switch (event.kind) {
      case audio::EventKind::underrun:
        if (capture_ && event.retimed) capture_->feed().misalign();
        inputs_.push({now, input::Xrun{interval.has_value(), fmt::format("{} frames lost from frame {}",
                                                                         event.frames, event.frame)}});
        if (underruns_.exceeded_by(now))
          inputs_.push({now, input::Failure{"more than three underruns within a minute; run `turnpoint "
                                            "doctor`, then resume the session"}});
        return;
      case audio::EventKind::burst_missed:
        if (triggers_->owns(event.burst)) return triggers_->missed(event.burst);
        return miss(now, "a stimulus came too late to be played");
      case audio::EventKind::device_lost:
        if (capture_) capture_->feed().misalign();
        unheard_ = 0;  // the trial is void, so do not wait for reports about its intervals
        if (!presented_.empty()) lost_ns_ = later(first_onset_, event.frame - first_onset_.frame);
        amplifier_().trip(FaultKind::converter_gone,
                          event.error == 0 ? "" : std::strerror(std::abs(event.error)));
        return;  // attend() will report the fault that the amplifier has latched
      case audio::EventKind::device_back:
        wrong_rate_.reset();  // this may be another device, with the right rate
        return inputs_.push({now, input::Notice{"the sound device is back"}});
      case audio::EventKind::rate_wrong:
        wrong_rate_ = Fault{FaultKind::converter_rate, fmt::format("{:.1f} Hz instead of {} Hz",
                                                                   1e-3 * static_cast<double>(event.frames),
                                                                   stream_->config().output.rate_Hz)};
        return amplifier_().trip(wrong_rate_->kind, wrong_rate_->detail);
      case audio::EventKind::burst_started:
      case audio::EventKind::burst_ended:
        return;
      case audio::EventKind::burst_unfollowed:
      case audio::EventKind::burst_follows:
        if (loop_) loop_->note(event);
        return;
      case audio::EventKind::burst_heard:
        if (!interval) return;
        if (unheard_ > 0) --unheard_;
        if (!capture_) return inputs_.push({now, input::Heard{*interval}});
        return capture_->played(*interval, now);
    }
  }

  void look_at_clocks(std::int64_t now) {
    clocks_due_ns_ = now + kClocks_ns;
    const auto news = clocks_.look(devices_.clocks());
    if (news.jump_s)
      inputs_.push({now, input::Notice{fmt::format("the wall clock was set by {:+.3f} s", *news.jump_s)}});
    if (!news.suspended_s) return;
    const auto slept = fmt::format("the computer was suspended for {:.1f} s", *news.suspended_s);
    inputs_.push({now, input::Notice{slept}});
    amplifier_().trip(FaultKind::suspended, slept);
  }

  const std::vector<std::string> no_buttons_;
  // Keep this member before the stream. The stream is then destroyed first and goes silent before the
  // amplifier is switched off.
  Devices devices_;
  Inputs& inputs_;
  std::unique_ptr<audio::Stream> stream_;
  std::optional<Triggers> triggers_;
  bool lock_told_ = false;          ///< that the loop's memory is not locked
  bool delay_told_ = false;         ///< that the stated delay of the converters could be better
  std::optional<FollowLoop> loop_;  ///< empty if nothing is captured; outlives the capture, which calls it
  std::optional<sensing::FingerSetup> finger_;
  std::unique_ptr<TrialCapture> capture_;  ///< null if nothing is captured
  std::vector<Presented> presented_;
  Onset first_onset_;        ///< onset of the trial's first interval
  std::size_t unheard_ = 0;  ///< number of intervals not yet reported as played
  /// time at which the converter was lost during a trial; the surface has been silent since then
  std::optional<std::int64_t> lost_ns_;
  audio::UnderrunLimit underruns_;
  system::ClockWatch clocks_;
  std::int64_t clocks_due_ns_ = 0;
  std::int64_t quiet_ns_ = 0;   ///< time from which the surface no longer vibrates
  std::int64_t opened_ns_ = 0;  ///< time at which the amplifier was enabled
  bool closing_ = false, fault_told_ = false;
  bool off_ = false;            ///< the capture knows that the amplifier is off
  std::int64_t saturated_ = 0;  ///< number of samples clipped so far
  /// set if the converter runs at the wrong rate, until the device has been reopened
  Refusal wrong_rate_;
};

}  // namespace

std::string describe(const system::Rights& rights) {
  if (!rights.asked) return "none asked (synchronous)";
  return fmt::format("fifo {}, memory {}{}{}", rights.fifo_priority,
                     rights.memory_locked ? "locked" : "not locked", rights.note.empty() ? "" : "; ",
                     rights.note);
}

std::unique_ptr<Stage> real_stage(const audio::StreamConfig& stream, Devices devices, Inputs& inputs,
                                  const std::optional<CardCapture>& capture, const TriggerSetup& triggers) {
  return std::make_unique<RealStage>(stream, std::move(devices), inputs, capture, triggers);
}

}  // namespace turnpoint::session

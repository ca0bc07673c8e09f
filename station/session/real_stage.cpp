#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "station/drive/monotonic.hpp"
#include "station/drive/recovery.hpp"
#include "station/session/clock_watch.hpp"
#include "station/session/schedule.hpp"

namespace turnpoint::session {

namespace {

constexpr std::int64_t kPoll_ns = 5'000'000;        // how often drive and guard are asked for news
constexpr std::int64_t kClocks_ns = 1'000'000'000;  // how often the clocks are compared
constexpr std::int64_t kSettle_ns = 50'000'000;     // an amplifier comes up in silence
constexpr std::int64_t kFirstBlocks_ns = 500'000'000;
constexpr std::int64_t kTail_ns = 20'000'000;  // and goes down after it

class RealStage : public Stage {
 public:
  RealStage(drive::StreamConfig config, Devices devices, Inputs& inputs)
      : devices_(std::move(devices)), inputs_(inputs), clocks_(read_clocks()) {
    config.amplifier = devices_.amplifier.get();
    stream_ = drive::open_realtime(config);
  }

  std::int64_t now_ns() override { return drive::monotonic_ns(); }

  std::optional<Input> wait_until(std::int64_t deadline_ns) override {
    for (;;) {
      attend();
      const auto now = now_ns();
      const auto until = std::min(deadline_ns, now + kPoll_ns);
      if (auto input = inputs_.wait_until(until)) return input;
      if (until == deadline_ns) return std::nullopt;
    }
  }

  std::vector<Input> drain() override {
    const auto gathered = inputs_.drain();
    return {gathered.begin(), gathered.end()};
  }

  void wait_for(const std::function<bool()>& ready) override {
    while (!ready()) {
      attend();
      drive::sleep_until_ns(now_ns() + kPoll_ns / 5);
    }
  }

  Onset present(drive::Burst burst, std::int64_t earliest_ns) override {
    const auto onset = schedule(*stream_, burst, std::max(earliest_ns, opened_ns_ + kSettle_ns), sounding_);
    quiet_ns_ = std::max(quiet_ns_, stream_->time_of(onset.frame + burst.length_frames));
    return onset;
  }

  std::optional<std::int64_t> glide(const drive::ToneSet& to, double seconds) override {
    return glide_to(*stream_, sounding_, to, seconds);
  }

  std::int64_t silence() override { return quiet_ns_ = ramp_down(*stream_, sounding_.ramp); }

  std::string arm() override {
    // The audio thread proves its life by its first blocks, which at a session's start are yet to come.
    const auto until_ns = now_ns() + kFirstBlocks_ns;
    const auto begun = 2 * stream_->config().output.period_frames;
    wait_for([&] { return stream_->counters().frames > begun || now_ns() > until_ns; });
    return attempt([this] { amplifier_().arm(); });
  }
  std::string disarm() override {
    amplifier_().disarm();
    return "";
  }
  std::string clear() override {
    const auto why_not = attempt([this] { amplifier_().clear(); });
    if (why_not.empty()) fault_told_ = false;
    return why_not;
  }
  drive::AmplifierState amplifier() const override { return devices_.amplifier->state(); }

  std::string open_amplifier() override {
    closing_ = false;
    if (amplifier() == drive::AmplifierState::enabled) return "";
    opened_ns_ = now_ns();
    return attempt([this] { amplifier_().enable(); });
  }
  void close_amplifier() override { closing_ = true; }

  const std::vector<std::string>& buttons() const override {
    return devices_.panel ? devices_.panel->buttons() : no_buttons_;
  }
  std::string missing() const override { return devices_.panel ? devices_.panel->missing() : ""; }
  void question(const observer::Question&, std::int64_t) override {}
  void adjustment(const observer::Adjustment&, std::int64_t) override {}
  std::optional<ClockFit> clock_fit() override { return fit_of(*stream_); }
  std::string realtime_rights() const override { return describe(stream_->rights()); }

  void finish() override {
    closing_ = true;
    wait_for([this] { return amplifier() != drive::AmplifierState::enabled; });
    amplifier_().disarm();
  }

 private:
  drive::Amplifier& amplifier_() { return *devices_.amplifier; }

  std::string attempt(const std::function<void()>& step) {
    amplifier_().session_alive();
    try {
      step();
      return "";
    } catch (const std::exception& error) {
      return error.what();
    }
  }

  /// Hears what drive, guard and clocks have to say, and tells the guard that the session lives.
  void attend() {
    const auto now = now_ns();
    amplifier_().session_alive();
    if (closing_ && now >= quiet_ns_ + kTail_ns) {
      amplifier_().disable();
      closing_ = false;
    }
    while (const auto event = stream_->poll()) hear(*event, now);
    if (amplifier() == drive::AmplifierState::faulted && !std::exchange(fault_told_, true))
      push_fault(amplifier_().fault_time_ns(), fault_of_amplifier(amplifier_().fault()), amplifier_fault());
    if (now >= clocks_due_ns_) look_at_clocks(now);
  }

  std::string amplifier_fault() const {
    const auto reaction_ns = devices_.amplifier->reaction_ns();
    const auto& what = devices_.amplifier->fault();
    return reaction_ns < 0 ? what
                           : fmt::format("{} (amplifier off after {:.0f} us)", what,
                                         1e-3 * static_cast<double>(reaction_ns));
  }

  void hear(const drive::Event& event, std::int64_t now) {
    switch (event.kind) {
      case drive::EventKind::underrun:
        push(InputKind::xrun, now, fmt::format("{} frames lost", event.frames));
        if (underruns_.exceeded_by(now))
          push(InputKind::failure, now,
               "more than three underruns within a minute; see `turnpoint doctor`, then resume");
        return;
      case drive::EventKind::burst_missed:
        return push_fault(now, FaultKind::stimulus_missed, "a stimulus came too late to be played");
      case drive::EventKind::device_lost:
        amplifier_().trip(kConverterGone);
        return;  // the latched fault tells it
      case drive::EventKind::device_back:
        return push(InputKind::notice, now, "the converter is back");
      case drive::EventKind::rate_wrong:
        amplifier_().trip("the converter's rate is wrong");
        return push(InputKind::failure, now,
                    fmt::format("the converter runs at {:.1f} Hz: what is felt would be wrong",
                                1e-3 * static_cast<double>(event.frames)));
      case drive::EventKind::burst_started:
      case drive::EventKind::burst_ended:
        return;
    }
  }

  void look_at_clocks(std::int64_t now) {
    clocks_due_ns_ = now + kClocks_ns;
    const auto news = clocks_.look(read_clocks());
    if (news.jump_s)
      push(InputKind::notice, now, fmt::format("the wall clock was set by {:+.3f} s", *news.jump_s));
    if (!news.suspended_s) return;
    push(InputKind::notice, now, fmt::format("the machine slept for {:.1f} s", *news.suspended_s));
    amplifier_().trip("the machine was suspended");
  }

  void push_fault(std::int64_t time_ns, FaultKind kind, std::string detail) {
    Input input;
    input.time_ns = time_ns;
    input.kind = InputKind::fault;
    input.fault = kind;
    input.text = std::move(detail);
    inputs_.push(std::move(input));
  }

  void push(InputKind kind, std::int64_t time_ns, std::string text) {
    Input input;
    input.time_ns = time_ns;
    input.kind = kind;
    input.text = std::move(text);
    inputs_.push(std::move(input));
  }

  const std::vector<std::string> no_buttons_;
  Devices devices_;  // before the stream: it goes silent first, then the amplifier's line goes low
  Inputs& inputs_;
  std::unique_ptr<drive::Stream> stream_;
  Sounding sounding_;
  drive::UnderrunLimit underruns_;
  ClockWatch clocks_;
  std::int64_t clocks_due_ns_ = 0;
  std::int64_t quiet_ns_ = 0;   ///< when the surface will be silent
  std::int64_t opened_ns_ = 0;  ///< when the amplifier was enabled
  bool closing_ = false, fault_told_ = false;
};

}  // namespace

std::string describe(const drive::Rights& rights) {
  if (!rights.asked) return "none asked (synchronous)";
  return fmt::format("fifo {}, memory {}{}{}", rights.fifo_priority,
                     rights.memory_locked ? "locked" : "not locked", rights.note.empty() ? "" : "; ",
                     rights.note);
}

std::unique_ptr<Stage> real_stage(const drive::StreamConfig& stream, Devices devices, Inputs& inputs) {
  return std::make_unique<RealStage>(stream, std::move(devices), inputs);
}

}  // namespace turnpoint::session

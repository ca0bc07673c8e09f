#include "station/session/stage.hpp"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace turnpoint::session {

namespace {

constexpr std::int64_t kForever = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t kPoll_ns = 5'000'000;  // how often the drive is asked for news while waiting

std::int64_t monotonic_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

/// What a drive event means to the session; none for mere confirmations.
std::optional<Input> input_of(const drive::Event& event, std::int64_t time_ns) {
  Input input;
  input.time_ns = time_ns;
  switch (event.kind) {
    case drive::EventKind::underrun:
      input.kind = InputKind::xrun;
      input.text = fmt::format("{} frames lost", event.frames);
      return input;
    case drive::EventKind::burst_missed:
      input.kind = InputKind::fault;
      input.fault = FaultKind::stimulus_missed;
      input.text = "a stimulus came too late to be played";
      return input;
    case drive::EventKind::device_lost:
      input.kind = InputKind::fault;
      input.fault = FaultKind::converter_gone;
      input.text = "the converter is gone; check its cable, then arm the amplifier again";
      return input;
    case drive::EventKind::rate_wrong:
      input.kind = InputKind::fault;
      input.fault = FaultKind::converter_rate;
      input.text = "the converter does not run at the rate that it reports: what is felt would be wrong";
      return input;
    case drive::EventKind::burst_started:
    case drive::EventKind::burst_ended:
    case drive::EventKind::device_back:
      break;
  }
  return std::nullopt;
}

std::string describe(const drive::Rights& rights) {
  if (!rights.asked) return "none asked (synchronous)";
  return fmt::format("fifo {}, memory {}{}{}", rights.fifo_priority,
                     rights.memory_locked ? "locked" : "not locked", rights.note.empty() ? "" : "; ",
                     rights.note);
}

/// What both stages do alike with a stream.
Onset schedule(drive::Stream& stream, drive::Burst burst, std::int64_t earliest_ns) {
  burst.start_frame = std::max(stream.earliest_frame(), stream.frame_at(earliest_ns));
  stream.schedule(burst);
  return {burst.start_frame, stream.time_of(burst.start_frame)};
}

std::optional<ClockFit> fit_of(drive::Stream& stream) {
  const auto fit = stream.clock();
  return ClockFit{fit.ns_per_frame, fit.residual_ns};
}

class RealStage : public Stage {
 public:
  RealStage(const drive::StreamConfig& config, Inputs& inputs)
      : stream_(drive::open_realtime(config)), inputs_(inputs) {}

  std::int64_t now_ns() override { return monotonic_ns(); }

  std::optional<Input> wait_until(std::int64_t deadline_ns) override {
    for (;;) {
      hear_drive();
      const auto now = monotonic_ns();
      const auto until = std::min(deadline_ns, now + kPoll_ns);
      if (auto input = inputs_.wait_until(until)) return input;
      if (until == deadline_ns) return std::nullopt;
    }
  }

  std::vector<Input> drain() override {
    const auto gathered = inputs_.drain();
    return {gathered.begin(), gathered.end()};
  }

  Onset present(drive::Burst burst, std::int64_t earliest_ns) override {
    ramp_ = burst.ramp;
    return schedule(*stream_, burst, earliest_ns);
  }

  void silence() override { stream_->stop(0, ramp_); }
  void question(const observer::Question&, std::int64_t) override {}
  std::optional<ClockFit> clock_fit() override { return fit_of(*stream_); }
  std::string realtime_rights() const override { return describe(stream_->rights()); }
  void finish() override {}

 private:
  void hear_drive() {
    while (const auto event = stream_->poll())
      if (auto input = input_of(*event, monotonic_ns())) inputs_.push(std::move(*input));
  }

  std::unique_ptr<drive::Stream> stream_;
  Inputs& inputs_;
  drive::Ramp ramp_;
};

class VirtualStage : public Stage {
 public:
  VirtualStage(const drive::StreamConfig& config, observer::Observer observer)
      : stream_(drive::open_synchronous(config)), observer_(std::move(observer)) {}

  std::int64_t now_ns() override { return now_ns_; }

  std::optional<Input> wait_until(std::int64_t deadline_ns) override {
    if (answer_ && answer_->time_ns <= deadline_ns) {
      advance_to(answer_->time_ns);
      return std::exchange(answer_, std::nullopt);
    }
    if (deadline_ns != kForever) {
      advance_to(deadline_ns);
      return std::nullopt;
    }
    advance_to(now_ns_ + kContinue_ns);
    Input input;
    input.time_ns = now_ns_;
    input.kind = InputKind::next;
    input.quality = TimeQuality::simulated;
    return input;
  }

  std::vector<Input> drain() override {
    answer_.reset();
    return {};
  }

  Onset present(drive::Burst burst, std::int64_t earliest_ns) override {
    ramp_ = burst.ramp;
    return schedule(*stream_, burst, earliest_ns);
  }

  void silence() override { stream_->stop(0, ramp_); }

  void question(const observer::Question& question, std::int64_t zero_ns) override {
    const auto reply = observer_.answer(question);
    if (!reply.choice) return;
    Input input;
    input.time_ns = std::max(now_ns_, zero_ns + static_cast<std::int64_t>(reply.response_time_s * 1e9));
    input.kind = InputKind::answer;
    input.value = *reply.choice;
    input.quality = TimeQuality::simulated;
    answer_ = input;
  }

  std::optional<ClockFit> clock_fit() override { return fit_of(*stream_); }
  std::string realtime_rights() const override { return describe(stream_->rights()); }
  void finish() override { stream_->finish(); }

 private:
  static constexpr std::int64_t kContinue_ns = 1'000'000'000;  // a page is read for so long

  void advance_to(std::int64_t time_ns) {
    now_ns_ = std::max(now_ns_, time_ns);
    const auto frames = stream_->frame_at(now_ns_) - stream_->frame();
    if (frames > 0) stream_->advance(frames);
    while (stream_->poll()) {
    }
  }

  std::unique_ptr<drive::SynchronousStream> stream_;
  observer::Observer observer_;
  std::int64_t now_ns_ = 0;
  std::optional<Input> answer_;
  drive::Ramp ramp_;
};

}  // namespace

std::unique_ptr<Stage> real_stage(const drive::StreamConfig& stream, Inputs& inputs) {
  return std::make_unique<RealStage>(stream, inputs);
}

std::unique_ptr<Stage> virtual_stage(const drive::StreamConfig& stream, observer::Observer observer) {
  return std::make_unique<VirtualStage>(stream, std::move(observer));
}

}  // namespace turnpoint::session

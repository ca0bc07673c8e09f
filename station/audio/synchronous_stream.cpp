#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "station/audio/engine_core.hpp"
#include "station/core/usage_error.hpp"

namespace turnpoint::audio {
namespace {

class Synchronous final : public SynchronousStream {
 public:
  Synchronous(const StreamConfig& config, std::int64_t origin_ns)
      : config_(config),
        origin_ns_(origin_ns),
        core_(config),
        output_(open_output(config.output)),
        block_(static_cast<std::size_t>(config.output.channels) *
               static_cast<std::size_t>(config.output.period_frames)) {
    if (config.samples == Samples::passed && config.output.uri != "null:")
      throw core::UsageError(config.output.uri +
                             " needs computed samples; they can be left out only with the output null:");
  }

  std::uint32_t schedule(const Burst& burst) override {
    return core_.schedule(burst, [this] { return earliest_frame(); });
  }
  std::vector<Scheduled> schedule_together(std::span<const PreparedBurst> bursts) override {
    return core_.schedule_together(bursts, [this] { return earliest_frame(); });
  }
  void change(std::uint32_t burst, const Change& change) override { core_.change(burst, change); }
  void stop(std::uint32_t burst, const Ramp& ramp, std::optional<std::int64_t> frame) override {
    core_.stop(burst, ramp, std::max(earliest_frame(), frame.value_or(0)));
  }
  [[nodiscard]] bool follow(const GainPeriod& gains) noexcept override { return core_.follow(gains); }
  std::optional<Event> poll() override { return core_.poll(); }
  std::int64_t earliest_frame() const override { return frame_ + config_.virtual_lead_frames; }
  Counters counters() const override { return core_.counters(); }
  system::Rights rights() const override { return {}; }
  std::optional<MeasuredRate> measured_rate() override { return std::nullopt; }
  const StreamConfig& config() const override { return config_; }
  std::int64_t frame() const override { return frame_; }
  std::int64_t now_ns() const override { return exact_time(frame_); }
  void finish() override { output_->finish(); }

  ClockFit clock() override { return {frame_, exact_time(frame_), 1e9 / config_.output.rate_Hz, 0, 1}; }
  std::optional<std::int64_t> time_of(std::int64_t frame) override { return exact_time(frame) + delay_ns(); }
  std::optional<std::int64_t> frame_at(std::int64_t time_ns) override {
    const std::int64_t since = time_ns - delay_ns() - origin_ns_, rate = config_.output.rate_Hz;
    const std::int64_t seconds = since / 1'000'000'000, rest = since % 1'000'000'000;
    return seconds * rate + std::llround(static_cast<double>(rest * rate) / 1e9);
  }

  void advance(std::int64_t frames) override {
    while (frames > 0) {
      const std::int64_t count = std::min<std::int64_t>(frames, config_.output.period_frames);
      if (config_.samples == Samples::passed) {
        core_.pass(frame_, count);
        frame_ += count, frames -= count;
        core_.heard(frame_);
        continue;
      }
      const auto samples = std::span(block_).first(static_cast<std::size_t>(count) *
                                                   static_cast<std::size_t>(config_.output.channels));
      core_.process(frame_, samples);
      for (const std::int32_t sample : samples) largest_ = std::max(largest_, std::abs(std::int64_t{sample}));
      const WriteResult result = output_->write(samples);
      if (result.status != WriteStatus::ok)
        throw std::system_error(-result.error, std::generic_category(), config_.output.uri);
      if (listener_) listener_(frame_, samples);
      frame_ += count;
      frames -= count;
      core_.heard(frame_);
    }
  }
  void listen(std::function<void(std::int64_t, std::span<const std::int32_t>)> listener) override {
    listener_ = std::move(listener);
  }

  double largest_sample() const override { return static_cast<double>(largest_) * 0x1p-31; }

 private:
  std::int64_t exact_time(std::int64_t frame) const noexcept {
    const std::int64_t rate = config_.output.rate_Hz;
    return origin_ns_ + frame / rate * 1'000'000'000 + frame % rate * 1'000'000'000 / rate;
  }
  std::int64_t delay_ns() const noexcept { return std::llround(config_.converter_delay_s * 1e9); }

  StreamConfig config_;
  std::int64_t origin_ns_;
  std::int64_t frame_ = 0;
  std::int64_t largest_ = 0;
  EngineCore core_;
  std::unique_ptr<Output> output_;
  std::vector<std::int32_t> block_;
  std::function<void(std::int64_t, std::span<const std::int32_t>)> listener_;
};

}  // namespace

std::unique_ptr<SynchronousStream> open_synchronous(const StreamConfig& config, std::int64_t origin_ns) {
  return std::make_unique<Synchronous>(config, origin_ns);
}

}  // namespace turnpoint::audio

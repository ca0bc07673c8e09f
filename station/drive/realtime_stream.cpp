#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <latch>
#include <thread>

#include "station/drive/engine_core.hpp"
#include "station/drive/monotonic.hpp"
#include "station/drive/rights.hpp"

namespace turnpoint::drive {
namespace {

// Stands in the ring of positions where the device was started anew.
constexpr Position new_relation{-1'000'000'000'000, 0};

class Realtime final : public Stream {
 public:
  explicit Realtime(const StreamConfig& config)
      : config_(config),
        core_(config),
        output_(open_output(config.output)),
        block_(static_cast<std::size_t>(config.output.channels) *
               static_cast<std::size_t>(config.output.period_frames)),
        clock_(config.output.rate_Hz, 1024),
        rate_check_(config.output.rate_Hz) {
    rights_ = lock_memory();
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
    started_.wait();
    const int denied = granted_.load();
    rights_.fifo_priority = denied == 0 ? config_.fifo_priority : 0;
    if (denied != 0)
      rights_.note += fmt::format("{}SCHED_FIFO {}: {} (raise LimitRTPRIO)", rights_.note.empty() ? "" : "; ",
                                  config_.fifo_priority, std::strerror(denied));
  }

  // What sounds is ramped down, then the thread stops.
  ~Realtime() override {
    try {
      const Ramp ramp;
      core_.stop(0, ramp, std::nullopt);
      const std::int64_t tail =
          ramp.frames + std::int64_t{config_.output.period_frames} * (config_.output.periods + 1);
      sleep_until_ns(monotonic_ns() + tail * 1'000'000'000 / config_.output.rate_Hz);
    } catch (const std::exception&) {  // the audio thread takes no commands: nothing sounds either
    }
    thread_.request_stop();
  }

  std::uint32_t schedule(const Burst& burst) override {
    return core_.schedule(burst, [this] { return earliest_frame(); });
  }
  Scheduled schedule_soon(const Burst& burst) override {
    return core_.schedule_soon(burst, [this] { return earliest_frame(); });
  }
  void change(std::uint32_t burst, const Change& change) override { core_.change(burst, change); }
  void stop(std::uint32_t burst, const Ramp& ramp, std::optional<std::int64_t> frame) override {
    core_.stop(burst, ramp, frame);
  }
  std::optional<Event> poll() override {
    gather_positions();
    return core_.poll();
  }

  // Two periods beyond what has been rendered: one is being rendered now.
  std::int64_t earliest_frame() const override {
    return core_.counters().frames + 2 * std::int64_t{config_.output.period_frames};
  }

  ClockFit clock() override {
    gather_positions();
    return clock_.fit();
  }
  std::int64_t time_of(std::int64_t frame) override { return clock().time_of(frame) + delay_ns(); }
  std::int64_t frame_at(std::int64_t time_ns) override { return clock().frame_at(time_ns - delay_ns()); }

  std::optional<MeasuredRate> measured_rate() override {
    MeasuredRate rate;
    if (rates_->pop(rate)) measured_rate_ = rate;
    return measured_rate_;
  }
  Counters counters() const override { return core_.counters(); }
  Rights rights() const override { return rights_; }
  const StreamConfig& config() const override { return config_; }

 private:
  std::int64_t delay_ns() const noexcept { return std::llround(config_.converter_delay_s * 1e9); }

  void gather_positions() {
    Position pair;
    while (positions_->pop(pair))
      pair.frame == new_relation.frame ? clock_.reset() : clock_.add(pair.frame, pair.time_ns);
  }

  void run(const std::stop_token& stop) noexcept {
    granted_.store(become_realtime(config_.fifo_priority));
    started_.count_down();
    const std::int64_t origin_ns = monotonic_ns();
    std::int64_t frame = 0;
    while (!stop.stop_requested()) {
      core_.process(frame, block_);
      const WriteResult result = output_->write(block_);
      frame += config_.output.period_frames + result.lost_frames;
      report(result, frame);
      if (config_.amplifier && result.status != WriteStatus::lost) config_.amplifier->audio_alive();
      output_->paced() ? follow_device() : follow_clock(origin_ns, frame);
    }
  }

  // A loss is reported once, however long it lasts.
  void report(const WriteResult& result, std::int64_t frame) noexcept {
    if (result.status == WriteStatus::skipped || result.status == WriteStatus::restarted)
      core_.report({EventKind::underrun, 0, frame, result.lost_frames, result.error});
    else if (result.status == WriteStatus::lost && !lost_)
      core_.report({EventKind::device_lost, 0, frame, 0, result.error});
    else if (result.status == WriteStatus::reopened)
      core_.report({EventKind::device_back, 0, frame, result.lost_frames, 0});
    lost_ = result.status == WriteStatus::lost;
    if (result.status == WriteStatus::ok || result.status == WriteStatus::skipped) return;
    rate_check_.restart();
    static_cast<void>(positions_->push(new_relation));
  }

  void follow_device() noexcept {
    const auto position = output_->position();
    if (!position) return;
    // When nobody asks for the clock the ring is full of older pairs, which do as well.
    static_cast<void>(positions_->push(*position));
    if (rate_told_) return;
    rate_check_.add(position->frame, position->time_ns + raw_minus_monotonic_ns());
    const auto rate = rate_check_.result();
    if (!rate) return;
    rate_told_ = true;
    static_cast<void>(rates_->push(*rate));
    if (std::abs(rate->deviation_ppm) > RateCheck::tolerance_ppm)
      core_.report({EventKind::rate_wrong, 0, position->frame, std::llround(rate->rate_Hz * 1000), 0});
  }

  // Files and null take frames at once; the clock stands in for a converter one period behind.
  void follow_clock(std::int64_t origin_ns, std::int64_t frame) noexcept {
    const std::int64_t rate = config_.output.rate_Hz, heard = frame - config_.output.period_frames;
    const std::int64_t due_ns =
        origin_ns + heard / rate * 1'000'000'000 + heard % rate * 1'000'000'000 / rate;
    sleep_until_ns(due_ns);
    static_cast<void>(positions_->push({heard, due_ns}));
  }

  StreamConfig config_;
  EngineCore core_;
  std::unique_ptr<Output> output_;
  std::vector<std::int32_t> block_;
  FrameClock clock_;
  std::unique_ptr<Ring<Position, 2048>> positions_ = std::make_unique<Ring<Position, 2048>>();
  std::unique_ptr<Ring<MeasuredRate, 2>> rates_ = std::make_unique<Ring<MeasuredRate, 2>>();
  std::optional<MeasuredRate> measured_rate_;
  Rights rights_;
  RateCheck rate_check_;  // this and the next two: audio thread only
  bool rate_told_ = false;
  bool lost_ = false;
  std::atomic<int> granted_{0};
  std::latch started_{1};
  std::jthread thread_;  // last: joined before what it uses goes
};

}  // namespace

std::unique_ptr<Stream> open_realtime(const StreamConfig& config) {
  return std::make_unique<Realtime>(config);
}

}  // namespace turnpoint::drive

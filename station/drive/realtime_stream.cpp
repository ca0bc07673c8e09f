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

class Realtime final : public Stream {
 public:
  explicit Realtime(const StreamConfig& config)
      : config_(config),
        core_(config),
        output_(open_output(config.output)),
        block_(static_cast<std::size_t>(config.output.channels) *
               static_cast<std::size_t>(config.output.period_frames)),
        clock_(config.output.rate_Hz, 1024) {
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

  std::uint32_t schedule(const Burst& burst) override { return core_.schedule(burst, earliest_frame()); }
  void change(std::uint32_t burst, const Change& change) override { core_.change(burst, change); }
  void stop(std::uint32_t burst, const Ramp& ramp, std::optional<std::int64_t> frame) override {
    core_.stop(burst, ramp, frame);
  }
  std::optional<Event> poll() override { return core_.poll(); }

  // Two periods beyond what has been rendered: one is being rendered now.
  std::int64_t earliest_frame() const override {
    return core_.counters().frames + 2 * std::int64_t{config_.output.period_frames};
  }

  ClockFit clock() override {
    Position pair;
    while (positions_->pop(pair)) clock_.add(pair.frame, pair.time_ns);
    return clock_.fit();
  }
  std::int64_t time_of(std::int64_t frame) override { return clock().time_of(frame) + delay_ns(); }
  std::int64_t frame_at(std::int64_t time_ns) override { return clock().frame_at(time_ns - delay_ns()); }

  Counters counters() const override { return core_.counters(); }
  Rights rights() const override { return rights_; }
  const StreamConfig& config() const override { return config_; }

 private:
  std::int64_t delay_ns() const noexcept { return std::llround(config_.converter_delay_s * 1e9); }

  void run(const std::stop_token& stop) noexcept {
    granted_.store(become_realtime(config_.fifo_priority));
    const std::int64_t rate = config_.output.rate_Hz;
    const std::int64_t origin_ns = monotonic_ns();
    std::int64_t frame = 0;
    bool announced = false;
    while (!stop.stop_requested()) {
      core_.process(frame, block_);
      const WriteResult result = output_->write(block_);
      frame += config_.output.period_frames;
      if (result.status == WriteStatus::recovered) {
        core_.report({EventKind::underrun, 0, frame, result.lost_frames, result.error});
        frame += result.lost_frames;
      } else if (result.status == WriteStatus::lost) {
        core_.report({EventKind::device_lost, 0, frame, 0, result.error});
      } else if (result.status == WriteStatus::reopened) {
        core_.report({EventKind::device_back, 0, frame, result.lost_frames, 0});
        frame += result.lost_frames;
      }
      if (!output_->paced()) {
        sleep_until_ns(origin_ns + (frame - config_.output.period_frames) * 1'000'000'000 / rate);
        static_cast<void>(positions_->push({frame, origin_ns + frame * 1'000'000'000 / rate}));
      } else if (const auto position = output_->position()) {
        static_cast<void>(positions_->push(*position));
      }
      if (!announced) started_.count_down();
      announced = true;
    }
    if (!announced) started_.count_down();
  }

  StreamConfig config_;
  EngineCore core_;
  std::unique_ptr<Output> output_;
  std::vector<std::int32_t> block_;
  FrameClock clock_;
  std::unique_ptr<Ring<Position, 2048>> positions_ = std::make_unique<Ring<Position, 2048>>();
  Rights rights_;
  std::atomic<int> granted_{0};
  std::latch started_{1};
  std::jthread thread_;  // last: joined before what it uses goes
};

}  // namespace

std::unique_ptr<Stream> open_realtime(const StreamConfig& config) {
  return std::make_unique<Realtime>(config);
}

}  // namespace turnpoint::drive

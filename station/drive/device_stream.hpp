#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "station/drive/engine.hpp"
#include "station/drive/engine_core.hpp"
#include "station/drive/rights.hpp"
#include "station/drive/ring.hpp"

namespace turnpoint::drive {

/// A stream on an output that plays in its own time, one block a step. Whoever steps it is the audio side:
/// open_realtime() does so on a thread of its own, a test wherever it likes. Everything else is for one
/// control thread.
class DeviceStream : public Stream {
 public:
  /// Throws as open_output.
  explicit DeviceStream(const StreamConfig& config);

  /// Audio side: renders the next block and writes it, which takes as long as the device does. After lost
  /// frames the block is not played later instead: the next step renders the frames whose time it then is.
  void step() noexcept;

  /// What the audio side uses beside this object itself, and what of it is not in the list, in words.
  std::vector<MemoryRange> memory() const;
  std::string memory_left_out() const { return output_->memory_left_out(); }

  std::uint32_t schedule(const Burst& burst) override {
    return core_.schedule(burst, [this] { return earliest_frame(); });
  }
  std::vector<Scheduled> schedule_together(std::span<const PreparedBurst> bursts) override {
    return core_.schedule_together(bursts, [this] { return earliest_frame(); });
  }
  void change(std::uint32_t burst, const Change& change) override { core_.change(burst, change); }
  void stop(std::uint32_t burst, const Ramp& ramp, std::optional<std::int64_t> frame) override {
    core_.stop(burst, ramp, frame);
  }
  std::optional<Event> poll() override;
  /// Two periods beyond what has been rendered: one is being rendered now.
  std::int64_t earliest_frame() const override {
    return core_.counters().frames + 2 * std::int64_t{config_.output.period_frames};
  }
  ClockFit clock() override;
  std::optional<std::int64_t> time_of(std::int64_t frame) override;
  std::optional<std::int64_t> frame_at(std::int64_t time_ns) override;
  std::optional<MeasuredRate> measured_rate() override;
  Counters counters() const override { return core_.counters(); }
  Rights rights() const override { return {}; }
  const StreamConfig& config() const override { return config_; }

 private:
  /// Positions and rates cross the threads with the number of the relation between frames and time, or of the
  /// device, that they hold for: what was measured before is never taken for what holds now.
  struct StampedPosition {
    std::uint32_t relation = 0;
    Position position;
  };
  struct StampedRate {
    std::uint32_t device = 0;
    MeasuredRate rate;
  };

  std::int64_t delay_ns() const noexcept;
  void gather_positions();
  void note_loss(const WriteResult& result) noexcept;
  void follow_device() noexcept;
  void follow_clock() noexcept;
  void check_rate(const Position& position) noexcept;

  StreamConfig config_;
  EngineCore core_;
  std::unique_ptr<Output> output_;
  std::unique_ptr<Ring<StampedPosition, 2048>> positions_ = std::make_unique<Ring<StampedPosition, 2048>>();
  std::unique_ptr<Ring<StampedRate, 4>> rates_ = std::make_unique<Ring<StampedRate, 4>>();
  std::atomic<std::uint32_t> relation_{0};  ///< grows whenever the device was started anew
  std::atomic<std::uint32_t> device_{0};    ///< grows whenever one was lost
  // Control side.
  FrameClock clock_;
  std::uint32_t clock_relation_ = 0;
  std::optional<StampedRate> rate_;
  // Audio side.
  std::vector<std::int32_t> block_;
  std::int64_t frame_ = 0;  ///< the next one to be rendered
  std::int64_t origin_ns_ = 0;
  RateCheck rate_check_;
  bool rate_told_ = false;
  bool lost_ = false;
};

}  // namespace turnpoint::drive

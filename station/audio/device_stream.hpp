#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "station/audio/engine.hpp"
#include "station/audio/engine_core.hpp"
#include "station/audio/ring.hpp"
#include "station/system/rights.hpp"

namespace turnpoint::audio {

/// A stream on an output that plays in real time, one block per step. step() belongs to the audio thread,
/// which open_realtime() starts; a test may call it from any thread. All other functions must be called from
/// one and the same control thread.
class DeviceStream : public Stream {
 public:
  /// Opens the output of `config`. Throws the same errors as open_output.
  explicit DeviceStream(const StreamConfig& config);

  /// For the audio thread. Renders the next block and writes it, which takes as long as the device takes to
  /// play it. A block that was lost is not played later: the next step renders the frames that are due by
  /// then.
  void step() noexcept;

  /// Memory that the audio side uses in addition to this object, so that it can be locked, and a note about
  /// memory that is missing from the list.
  std::vector<system::MemoryRange> memory() const;
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
  [[nodiscard]] bool follow(const GainPeriod& gains) noexcept override { return core_.follow(gains); }
  std::optional<Event> poll() override;
  /// Two periods after the last rendered frame, because one period is being rendered now.
  std::int64_t earliest_frame() const override {
    return core_.counters().frames + 2 * std::int64_t{config_.output.period_frames};
  }
  ClockFit clock() override;
  std::optional<std::int64_t> time_of(std::int64_t frame) override;
  std::optional<std::int64_t> frame_at(std::int64_t time_ns) override;
  std::optional<MeasuredRate> measured_rate() override;
  Counters counters() const override { return core_.counters(); }
  system::Rights rights() const override { return {}; }
  const StreamConfig& config() const override { return config_; }

 private:
  /// A position or rate that the audio thread sends to the control thread, with the number of restarts or
  /// losses at that time. By this number, the control thread recognises and ignores measurements from before
  /// the latest restart.
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
  std::atomic<std::uint32_t> relation_{0};  ///< number of restarts of the device so far
  std::atomic<std::uint32_t> device_{0};    ///< number of losses of a device so far
  // the members from here on are used by the control side only
  FrameClock clock_;
  std::uint32_t clock_relation_ = 0;
  std::optional<StampedRate> rate_;
  // the members from here on are used by the audio side only
  std::vector<std::int32_t> block_;
  std::int64_t frame_ = 0;  ///< the next frame to render
  std::int64_t origin_ns_ = 0;
  RateCheck rate_check_;
  bool rate_told_ = false;
  bool lost_ = false;
};

}  // namespace turnpoint::audio

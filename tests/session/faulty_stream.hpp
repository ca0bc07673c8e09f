#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "station/audio/engine.hpp"

/// Faults that a FaultyStream reports in addition to those of the real stream.
struct Misfortunes {
  std::mutex mutex;
  std::optional<turnpoint::audio::Event> event;
  std::atomic<std::int64_t> clipped{0};
  /// The audio thread has not rendered anything since the session started, so the drive has begun no
  /// stimulus.
  std::atomic<bool> stalled{false};

  void happen(turnpoint::audio::Event what) {
    const std::lock_guard lock(mutex);
    event = what;
  }
};

class FaultyStream : public turnpoint::audio::Stream {
 public:
  using Burst = turnpoint::audio::Burst;
  FaultyStream(std::unique_ptr<Stream> real, Misfortunes& misfortunes)
      : real_(std::move(real)), misfortunes_(misfortunes) {}

  std::optional<turnpoint::audio::Event> poll() override {
    const std::lock_guard lock(misfortunes_.mutex);
    if (auto event = std::exchange(misfortunes_.event, std::nullopt)) return event;
    auto event = real_->poll();
    while (event && event->kind == turnpoint::audio::EventKind::burst_heard && misfortunes_.stalled)
      event = real_->poll();
    return event;
  }
  turnpoint::audio::Counters counters() const override {
    auto counters = real_->counters();
    counters.saturated += misfortunes_.clipped;
    return counters;
  }

  std::uint32_t schedule(const Burst& burst) override { return real_->schedule(burst); }
  std::vector<turnpoint::audio::Scheduled> schedule_together(
      std::span<const turnpoint::audio::PreparedBurst> bursts) override {
    return real_->schedule_together(bursts);
  }
  void change(std::uint32_t burst, const turnpoint::audio::Change& change) override {
    real_->change(burst, change);
  }
  bool follow(const turnpoint::audio::GainPeriod& gains) noexcept override { return real_->follow(gains); }
  void stop(std::uint32_t burst, const turnpoint::audio::Ramp& ramp,
            std::optional<std::int64_t> frame) override {
    real_->stop(burst, ramp, frame);
  }
  std::int64_t earliest_frame() const override { return misfortunes_.stalled ? 0 : real_->earliest_frame(); }
  turnpoint::audio::ClockFit clock() override { return real_->clock(); }
  std::optional<std::int64_t> time_of(std::int64_t frame) override { return real_->time_of(frame); }
  std::optional<std::int64_t> frame_at(std::int64_t time_ns) override { return real_->frame_at(time_ns); }
  std::optional<turnpoint::audio::MeasuredRate> measured_rate() override { return real_->measured_rate(); }
  turnpoint::system::Rights rights() const override { return real_->rights(); }
  const turnpoint::audio::StreamConfig& config() const override { return real_->config(); }

 private:
  std::unique_ptr<Stream> real_;
  Misfortunes& misfortunes_;
};

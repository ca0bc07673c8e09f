#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <optional>

#include "station/audio/frame_clock.hpp"
#include "station/sensing/carrier.hpp"
#include "station/sensing/force_calibration.hpp"

namespace turnpoint::sensing {

/// Puts the samples of force cells whose converter has a clock of its own on the grid of points in playback
/// frames. Pure: no clock, no device.
///
/// The time stamps of a sample may be a tenth of a sample early or late. A straight line through the newest
/// 256 stamps gives the times of the samples, and shows where samples are missing: a stamp that is late by
/// more than half a sample counts as a gap. A point is interpolated by the cubic through four samples in a
/// row, so that points within two samples of a gap are missing too.
class OwnClock {
 public:
  struct Options {
    double rate_Hz = 1000;  ///< expected rate of the samples
    int frames_per_point = 192;
    std::array<double, bridge_count> full_scale{1, 1, 1};  ///< reading of each cell at its rated load
    std::int64_t delay_ns = 0;  ///< the filter of the converter delays the samples by this time
  };
  struct Sample {
    std::int64_t time_ns = 0;
    Readings readings{};
    std::array<bool, bridge_count> at_limit{};  ///< the converter cannot read more: a wire is off
  };
  struct Counters {
    std::int64_t samples = 0;
    std::int64_t lost = 0;      ///< samples that were missing
    std::int64_t gaps = 0;      ///< how often samples were missing
    std::int64_t disorder = 0;  ///< stamps that came too early to belong to the next sample
  };

  explicit OwnClock(const Options& options);

  /// Takes the next sample, and calls `take(const BridgePoint&)` for each point that it completes. `playback`
  /// gives the times at which frames leave the converter of the output; without pairs, no point is made.
  template <typename Take>
  void push(const Sample& sample, const audio::ClockFit& playback, Take&& take) {
    add(sample);
    for (std::int64_t index = first_point(playback); complete(index, playback); ++index) {
      next_point_ = index + 1;
      take(point_);
    }
  }

  const Counters& counters() const { return counters_; }
  /// The measured rate of the samples; empty until there are enough stamps since the last disorder.
  std::optional<double> rate_Hz() const;
  /// The first cell whose newest samples do not change at all (WireFault::silent); empty if there is none.
  std::optional<std::size_t> silent_cell() const;

 private:
  void add(const Sample& sample);
  /// Number of the sample, with a fraction, that belongs to this time, counted from the newest one.
  double position(std::int64_t time_ns) const;
  std::int64_t first_point(const audio::ClockFit& playback) const;
  bool complete(std::int64_t index, const audio::ClockFit& playback);

  Options options_;
  audio::FrameClock stamps_;
  audio::ClockFit line_;  ///< fitted to the stamps
  std::int64_t number_ = 0;
  std::deque<Sample> newest_;  ///< up to four samples in a row
  std::int64_t next_point_ = 0;
  std::array<Unchanged, bridge_count> unchanged_;
  std::array<bool, bridge_count> silent_{};
  BridgePoint point_;
  Counters counters_;
};

}  // namespace turnpoint::sensing

#include "station/audio/frame_clock.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace turnpoint::audio {

std::int64_t ClockFit::time_of(std::int64_t at_frame) const noexcept {
  return time_ns + std::llround(static_cast<double>(at_frame - frame) * ns_per_frame);
}

std::int64_t ClockFit::frame_at(std::int64_t at_ns) const noexcept {
  return frame + std::llround(static_cast<double>(at_ns - time_ns) / ns_per_frame);
}

FrameClock::FrameClock(double nominal_rate_Hz, int window)
    : nominal_ns_per_frame_(1e9 / nominal_rate_Hz), window_(static_cast<std::size_t>(window)) {
  if (!(nominal_rate_Hz > 0) || window < 2)
    throw std::invalid_argument(
        fmt::format("a frame clock needs a rate above 0 Hz and at least 2 pairs, not {} Hz and {} pairs",
                    nominal_rate_Hz, window));
  pairs_.reserve(window_);
}

void FrameClock::reset() {
  pairs_.clear();
  oldest_ = 0;
}

void FrameClock::add(std::int64_t frame, std::int64_t time_ns) {
  if (!pairs_.empty()) {
    const Pair& newest = pairs_[(oldest_ + pairs_.size() - 1) % pairs_.size()];
    if (frame == newest.frame && time_ns == newest.time_ns) return;
    if (frame <= newest.frame || time_ns <= newest.time_ns) reset();
  }
  if (pairs_.size() < window_) {
    pairs_.push_back({frame, time_ns});
    return;
  }
  pairs_[oldest_] = {frame, time_ns};
  oldest_ = (oldest_ + 1) % window_;
}

ClockFit FrameClock::fit() const {
  ClockFit line;
  line.ns_per_frame = nominal_ns_per_frame_;
  line.pairs = static_cast<int>(pairs_.size());
  if (pairs_.empty()) return line;
  const Pair& newest = pairs_[(oldest_ + pairs_.size() - 1) % pairs_.size()];
  line.frame = newest.frame;
  line.time_ns = newest.time_ns;
  if (pairs_.size() < 8) return line;
  // Times and frames are relative to the newest pair, so that the sums stay small.
  const auto count = static_cast<double>(pairs_.size());
  double mean_x = 0, mean_y = 0;
  for (const Pair& pair : pairs_) {
    mean_x += static_cast<double>(pair.frame - newest.frame) / count;
    mean_y += static_cast<double>(pair.time_ns - newest.time_ns) / count;
  }
  double xx = 0, xy = 0, yy = 0;
  for (const Pair& pair : pairs_) {
    const double x = static_cast<double>(pair.frame - newest.frame) - mean_x;
    const double y = static_cast<double>(pair.time_ns - newest.time_ns) - mean_y;
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  line.ns_per_frame = xy / xx;
  line.time_ns = newest.time_ns + std::llround(mean_y - line.ns_per_frame * mean_x);
  line.residual_ns = std::sqrt(std::max(0.0, yy - line.ns_per_frame * xy) / count);
  return line;
}

}  // namespace turnpoint::audio

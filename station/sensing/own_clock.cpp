#include "station/sensing/own_clock.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace turnpoint::sensing {
namespace {

constexpr int stamps_in_line = 256;
constexpr std::size_t nodes = 4;
/// A cell is silent once this many samples in a row, and those of this length of time, are equal: a converter for
/// force cells has noise in its last digits.
constexpr double silent_samples = 20, silent_time_s = 0.1;

/// Weights of four samples at 0, 1, 2, 3 for the value at x of the cubic through them.
std::array<double, nodes> cubic_weights(double x) {
  return {-(x - 1) * (x - 2) * (x - 3) / 6, x * (x - 2) * (x - 3) / 2, -x * (x - 1) * (x - 3) / 2,
          x * (x - 1) * (x - 2) / 6};
}

}  // namespace

OwnClock::OwnClock(const Options& options) : options_(options), stamps_(options.rate_Hz, stamps_in_line) {}

std::optional<double> OwnClock::rate_Hz() const {
  if (line_.pairs < stamps_in_line) return std::nullopt;
  return line_.rate_Hz();
}

std::optional<std::size_t> OwnClock::silent_cell() const {
  const auto found = std::find(silent_.begin(), silent_.end(), true);
  if (found == silent_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - silent_.begin());
}

void OwnClock::add(const Sample& sample) {
  const std::int64_t time_ns = sample.time_ns - options_.delay_ns;
  std::int64_t steps = 1;
  if (line_.pairs > 0) {
    steps = std::llround(static_cast<double>(time_ns - line_.time_of(number_)) / line_.ns_per_frame);
    if (steps < 1) {
      ++counters_.disorder;
      stamps_.reset();
      steps = 2;  // not in a row with the samples before
    } else if (steps > 1) {
      counters_.lost += steps - 1;
      ++counters_.gaps;
      // After a long gap, the line is no longer exact enough to count on with it.
      if (static_cast<double>(steps) > options_.rate_Hz) stamps_.reset();
    }
  }
  ++counters_.samples;
  number_ += steps;
  stamps_.add(number_, time_ns);
  line_ = stamps_.fit();
  if (steps != 1) newest_.clear();
  newest_.push_back(sample);
  if (newest_.size() > nodes) newest_.pop_front();
  const double enough = std::max(silent_samples, silent_time_s * options_.rate_Hz);
  for (std::size_t cell = 0; cell < bridge_count; ++cell)
    silent_[cell] = static_cast<double>(unchanged_[cell].add(sample.readings[cell])) >= enough;
}

double OwnClock::position(std::int64_t time_ns) const {
  return static_cast<double>(line_.frame - number_) +
         static_cast<double>(time_ns - line_.time_ns) / line_.ns_per_frame;
}

/// The first point that is not before the oldest of the newest four samples, and was not given out yet.
std::int64_t OwnClock::first_point(const audio::ClockFit& playback) const {
  if (playback.pairs == 0 || newest_.size() < nodes) return next_point_;
  const std::int64_t frame = playback.frame_at(line_.time_of(number_ - static_cast<std::int64_t>(nodes - 1)));
  const std::int64_t per_point = options_.frames_per_point;
  const std::int64_t index = frame >= 0 ? (frame + per_point - 1) / per_point : 0;
  return std::max(index, next_point_);
}

bool OwnClock::complete(std::int64_t index, const audio::ClockFit& playback) {
  if (playback.pairs == 0 || newest_.size() < nodes) return false;
  const double at = position(playback.time_of(index * options_.frames_per_point));
  if (at > -1) return false;  // a later sample will have this point in the middle of the four
  const auto weights = cubic_weights(at + static_cast<double>(nodes - 1));
  point_ = {.index = index, .reference = 1};
  for (std::size_t cell = 0; cell < bridge_count; ++cell) {
    bool at_limit = false;
    for (std::size_t k = 0; k < nodes; ++k) {
      point_.ratio[cell] += weights[k] * newest_[k].readings[cell];
      at_limit = at_limit || newest_[k].at_limit[cell];
    }
    const bool over = std::abs(point_.ratio[cell]) > overload_share * options_.full_scale[cell];
    if (point_.fault != WireFault::none || !(at_limit || over || silent_[cell])) continue;
    point_.fault = at_limit || over ? WireFault::overload : WireFault::silent;
    point_.bridge = cell;
  }
  return true;
}

}  // namespace turnpoint::sensing
